// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// aliasing [--rounds N] [--orders a,b,…] [--offsets a,b,…] FILE…: measures the cost of address aliasing. A
// kernel reads one array and adds to another by the same index, and the addresses of the two differ by a
// multiple of 4096 bytes plus an offset. Kernels: springs, element forces and the product with the stiffness
// matrix. The first array starts at a page of 2 MiB, the second one an offset after the start of such a page.
// Prints the best ms of processor time on one thread; all orders and offsets run in turn.
#include "base/stopwatch.hpp"
#include "io/format.hpp"
#include "kernels/block_csr.hpp"
#include "kernels/elasticity.hpp"
#include "kernels/positions.hpp"
#include "kernels/springs.hpp"
#include "measuring.hpp"
#include "mesh/graphs.hpp"
#include "mesh/reorder.hpp"
#include "payoff/steadiness.hpp"
#include <meshorder/mesh.hpp>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>
#include <new>
#include <span>
#include <string>
#include <utility>
#include <vector>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace mo = meshorder;

namespace {

constexpr std::size_t kPage = std::size_t{2} << 20;
constexpr std::array<const char*, 3> kNames{"springs", "element", "SpMV"};

/// Whole pages of zeros, at an address that is a multiple of 2 MiB.
class Pages {
 public:
  explicit Pages(std::size_t bytes)
      : bytes_((bytes + kPage - 1) / kPage * kPage),
        start_(::operator new (bytes_, std::align_val_t{kPage})) {
#if defined(__linux__)
    (void)madvise(start_, bytes_, MADV_HUGEPAGE);
#endif
    std::fill_n(static_cast<char*>(start_), bytes_, char{0});
  }
  Pages(Pages&& other) noexcept : bytes_(other.bytes_), start_(std::exchange(other.start_, nullptr)) {}
  Pages& operator=(Pages&&) = delete;
  ~Pages() { ::operator delete (start_, std::align_val_t{kPage}); }

  [[nodiscard]] std::span<double> at(std::size_t offset, std::size_t count) const {
    return {reinterpret_cast<double*>(static_cast<char*>(start_) + offset), count};
  }

 private:
  std::size_t bytes_;
  void* start_;
};

/// The data of the kernels for a mesh in one order.
struct Problem {
  std::string order;
  mo::RestShapes rest;
  mo::Springs springs;
  mo::BlockCsr matrix;
  mo::Elasticity material;
  Pages read, written;
  std::size_t padded, entries;
  std::vector<std::array<double, kNames.size()>> best = {};

  Problem(std::string name, const mo::Mesh& mesh, std::size_t offsets)
      : order(std::move(name)),
        rest(mo::rest_shapes(mo::cut_into_simplices(mesh), mesh.points)),
        read(32 * mesh.points.size()),
        written(32 * mesh.points.size() + 4096),
        padded(4 * mesh.points.size()),
        entries(3 * mesh.points.size()),
        best(offsets) {
    const mo::CsrGraph graph = mo::vertex_graph(mesh);
    springs = mo::springs_on_edges(graph, mesh.points);
    matrix = mo::zero_block_csr(graph);
    std::fill(matrix.values.begin(), matrix.values.end(), 1e-3);
    material.model = mo::MaterialModel::stvk;
    material.lame = mo::Lame::from_young(1e6, 0.45);
    for (auto& of_kernel : best) of_kernel.fill(std::numeric_limits<double>::infinity());
    const mo::AlignedVector<double> points = mo::padded_positions(mesh.points);
    std::transform(points.begin(), points.end(), read.at(0, padded).begin(),
                   [](double x) { return 1.05 * x; });
  }

  void run(std::size_t kernel, std::size_t offset) const {
    const std::span<double> forces = written.at(offset, padded);
    switch (kernel) {
      case 0:
        std::fill(forces.begin(), forces.end(), 0.0);
        return mo::add_spring_forces(springs, 1e3, read.at(0, padded), forces);
      case 1:
        std::fill(forces.begin(), forces.end(), 0.0);
        return mo::add_elasticity(rest, material, read.at(0, padded), forces, nullptr);
      default:
        return mo::multiply(matrix, read.at(0, entries), written.at(offset, entries));
    }
  }
};

void measure(std::vector<Problem>& problems, const std::vector<std::size_t>& offsets, int rounds) {
  constexpr int kRepeats = 3;
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t kernel = 0; kernel < kNames.size(); ++kernel) {
      for (Problem& problem : problems) {
        problem.run(kernel, 0);
        for (std::size_t i = 0; i < offsets.size(); ++i) {
          const std::size_t k = (i + static_cast<std::size_t>(round)) % offsets.size();
          problem.run(kernel, offsets[k]);
          for (int repeat = 0; repeat < kRepeats; ++repeat) {
            const mo::ThreadStopwatch stopwatch;
            problem.run(kernel, offsets[k]);
            problem.best[k][kernel] = std::min(problem.best[k][kernel], 1e3 * stopwatch.seconds());
          }
        }
      }
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  int rounds = 25;
  std::string orders = "hilbert,spectral,fiedler,scrambled";
  std::string offset_list = "0,64,256,512,1088,1344,2048,2752,3136,3584,4032";
  std::vector<std::string> files;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const bool has_value = i + 1 < argc;
    if (argument == "--rounds" && has_value)
      rounds = std::atoi(argv[++i]);
    else if (argument == "--orders" && has_value)
      orders = argv[++i];
    else if (argument == "--offsets" && has_value)
      offset_list = argv[++i];
    else
      files.push_back(argument);
  }
  std::vector<std::size_t> offsets;
  for (const std::string& part : split(offset_list)) offsets.push_back(std::stoul(part));
  for (const std::string& file : files) {
    const mo::Mesh original = mo::read_mesh(file);
    std::vector<Problem> problems;
    for (const std::string& order : split(orders)) {
      mo::Mesh mesh = original;
      mo::reorder(mesh, {.methods = {order, order == "scrambled" ? "scrambled" : "lexmax"}});
      problems.emplace_back(order, mesh, offsets.size());
    }
    measure(problems, offsets, rounds);
    fmt::print("{}: {} vertices\n{:<10}{:<11}", file, original.vertex_count(), "kernel", "bytes on:");
    for (const std::size_t offset : offsets) fmt::print("{:>8}", offset);
    fmt::print("\n");
    for (std::size_t kernel = 0; kernel < kNames.size(); ++kernel) {
      for (const Problem& problem : problems) {
        fmt::print("{:<10}{:<11}", kNames[kernel], problem.order);
        for (const auto& of_kernel : problem.best) fmt::print("{:>8.3f}", of_kernel[kernel]);
        fmt::print("\n");
      }
    }
  }
}
