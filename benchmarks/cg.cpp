// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// cg [--solve | --half] [--rounds N] [--orders a,b,…] FILE…: conjugate gradients on the system of an implicit
// time step of each mesh, (1 + h α) M + h² K at rest, in several orders. Prints the best ms of an iteration
// in interleaved rounds, with the matrix in double and in float, on one and two threads, and the iteration's
// memory traffic in per cent of the measured bandwidth (over 100: caches keep data from pass to pass). "band"
// is the ideal order (see ideal_band). With --solve: iterations and seconds to 1e-6 with each preconditioner.
// With --half: the product and the iteration with the whole matrix and with half of it (see HalfBlockCsrOf),
// in double and in float, in turns; on one thread processor time.
#include "base/parallel.hpp"
#include "base/stopwatch.hpp"
#include "io/format.hpp"
#include "kernels/block_csr.hpp"
#include "kernels/half_block_csr.hpp"
#include "kernels/owned_batches.hpp"
#include "kernels/positions.hpp"
#include "lab/implicit/elastic_system.hpp"
#include "lab/linear/cg/solve.hpp"
#include "lab/linear/preconditioners/preconditioner.hpp"
#include "mesh/graphs.hpp"
#include "mesh/reorder.hpp"
#include "payoff/band.hpp"
#include "payoff/memory_probe.hpp"
#include "payoff/steadiness.hpp"

#include <fmt/core.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

namespace mo = meshorder;

namespace {

constexpr std::array kThreads{1, 2};
constexpr int kIterations = 24;

struct Settings {
  bool solve = false;
  bool half = false;
  int rounds = 9;
  std::string orders = "scrambled,original,fiedler,spectral,hilbert,rcm,band";
  std::vector<std::string> files;
};

/// The system in one order, in all forms that are solved.
struct System {
  std::string order;
  mo::BlockCsr matrix;
  mo::BlockCsrOf<float> rounded;
  mo::HalfBlockCsr half;
  mo::HalfBlockCsrOf<float> rounded_half;
  std::vector<double> b, x;
  std::vector<mo::Point> points;
  std::unique_ptr<mo::Preconditioner> jacobi;
};

/// Scales the mesh so that its longest side is 10.
void scale_to_ten(mo::Mesh& mesh) {
  mo::Point low = mesh.points.front();
  mo::Point high = low;
  for (const mo::Point& point : mesh.points) {
    for (int c = 0; c < 3; ++c) {
      low[c] = std::min(low[c], point[c]);
      high[c] = std::max(high[c], point[c]);
    }
  }
  const double side = std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
  for (mo::Point& point : mesh.points) {
    for (double& coordinate : point) coordinate *= 10.0 / side;
  }
}

System make_system(const std::string& order, const mo::Mesh& mesh) {
  constexpr double kStep = 0.01, kDamping = 1.0, kDensity = 1000.0, kForce = -50.0;
  mo::Body body;
  body.simplices = mo::cut_into_simplices(mesh);
  body.elasticity.lame = mo::Lame::from_young(1e6, 0.45);
  body.densities = {kDensity};
  mo::ElasticSystem elastic(mesh.points, body, mo::Mass::lumped);
  elastic.assemble(mo::padded_positions(mesh.points), mo::Tangent::exact, 1.0 + kStep * kDamping,
                   kStep * kStep);
  System system;
  system.order = order;
  system.points = mesh.points;
  system.matrix = std::move(elastic.matrix());
  mo::round_to_single(system.matrix, system.rounded);
  mo::store_half(system.matrix, system.half);
  mo::store_half(system.matrix, system.rounded_half);
  system.b.assign(3 * mesh.points.size(), kStep * kForce);
  system.x.assign(system.b.size(), 0.0);
  system.jacobi = mo::make_preconditioner(mo::PreconditionerKind::jacobi, system.matrix, mesh.points);
  system.jacobi->update(system.matrix);
  return system;
}

std::vector<System> make_systems(const std::string& file, const std::string& orders) {
  mo::Mesh original = mo::read_mesh(file);
  scale_to_ten(original);
  std::vector<System> systems;
  std::istringstream names(orders);
  for (std::string name; std::getline(names, name, ',');) {
    mo::Mesh mesh = original;
    if (name == "band") {
      mo::Band band = mo::ideal_band(mo::cut_into_simplices(mesh), mo::vertex_graph(mesh));
      scale_to_ten(band.mesh);
      systems.push_back(make_system(name, band.mesh));
      continue;
    }
    mo::reorder(mesh, {.methods = {name, "lexmax"}});
    systems.push_back(make_system(name, mesh));
  }
  return systems;
}

template <class Value>
double iteration_ms(System& system, const mo::BlockCsrOf<Value>& matrix) {
  std::fill(system.x.begin(), system.x.end(), 0.0);
  const mo::Stopwatch stopwatch;
  const mo::SolveReport report = mo::conjugate_gradients(matrix, *system.jacobi, system.b, system.x,
                                                         {.tolerance = 0.0, .max_iterations = kIterations});
  // the residual at the start takes another product
  return 1e3 * stopwatch.seconds() / (report.iterations + 1);
}

double product_ms(System& system) {
  constexpr int kRepeats = 10;
  std::vector<double> y(system.x.size());
  mo::multiply(system.matrix, system.b, y);
  const mo::Stopwatch stopwatch;
  for (int i = 0; i < kRepeats; ++i) mo::multiply(system.matrix, system.b, y);
  return 1e3 * stopwatch.seconds() / kRepeats;
}

/// Lowers `best` to the ms of a repeat, if less: processor time on one thread, wall-clock time on several.
template <class Work>
void take_best(double& best, int threads, int repeats, Work work) {
  const mo::ThreadStopwatch thread;
  const mo::Stopwatch wall;
  work();
  best = std::min(best, 1e3 * (threads == 1 ? thread.seconds() : wall.seconds()) / repeats);
}

/// Best times of the product and of an iteration, with the whole matrix and with half of it.
struct HalfTimes {
  double product = std::numeric_limits<double>::infinity();
  double half_product = product, iteration = product, half_iteration = product;
};

template <class Value>
void take_best_of_halves(HalfTimes& best, System& system, const mo::BlockCsrOf<Value>& matrix,
                         const mo::HalfBlockCsrOf<Value>& half, int threads) {
  constexpr int kRepeats = 10;
  std::vector<double> y(system.x.size());
  const std::vector<mo::Index> parts = mo::balanced_ranges(matrix.offsets, threads);
  const auto whole = [&] {
    mo::for_each_part(threads, [&](mo::Index part) {
      mo::multiply_rows(matrix, system.b, y, parts[part], parts[part + 1]);
    });
  };
  const auto repeated = [&](auto product) {
    product();
    return [product] {
      for (int k = 0; k < kRepeats; ++k) product();
    };
  };
  const auto iterations = [&](const auto& of) {
    return [&] {
      std::fill(system.x.begin(), system.x.end(), 0.0);
      (void)mo::conjugate_gradients(of, *system.jacobi, system.b, system.x,
                                    {.tolerance = 0.0, .max_iterations = kIterations});
    };
  };
  take_best(best.product, threads, kRepeats, repeated(whole));
  take_best(best.half_product, threads, kRepeats, repeated([&] { mo::multiply(half, system.b, y); }));
  // the residual at the start takes another product
  take_best(best.iteration, threads, kIterations + 1, iterations(matrix));
  take_best(best.half_iteration, threads, kIterations + 1, iterations(half));
}

void print_halves(std::vector<System>& systems, const Settings& settings) {
  fmt::print("{:<11}{:>8}{:>9}{:>8}{:>9}{:>9}{:>8}{:>11}{:>9}{:>8}\n", "order", "threads", "twice %", "",
             "product", "half", "", "iteration", "half", "");
  for (const int threads : kThreads) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    std::vector<HalfTimes> in_double(systems.size());
    std::vector<HalfTimes> in_float(systems.size());
    for (int round = 0; round < settings.rounds; ++round) {
      for (std::size_t i = 0; i < systems.size(); ++i) {
        System& system = systems[i];
        take_best_of_halves(in_double[i], system, system.matrix, system.half, threads);
        take_best_of_halves(in_float[i], system, system.rounded, system.rounded_half, threads);
      }
    }
    const auto print = [&](const System& system, const char* value, const HalfTimes& best) {
      fmt::print("{:<11}{:>8}{:>9.1f}{:>8}{:>9.3f}{:>9.3f}{:>7.2f}x{:>11.3f}{:>9.3f}{:>7.2f}x\n",
                 system.order, threads, 100 * mo::share_between_slabs(system.matrix), value, best.product,
                 best.half_product, best.product / best.half_product, best.iteration, best.half_iteration,
                 best.iteration / best.half_iteration);
    };
    for (std::size_t i = 0; i < systems.size(); ++i) {
      print(systems[i], "double", in_double[i]);
      print(systems[i], "float", in_float[i]);
    }
  }
}

/// Returns the bytes that an iteration moves if nothing stays in caches.
double iteration_bytes(const mo::BlockCsr& matrix, double value_bytes) {
  // vectors that an iteration reads or writes, loop by loop: p, q; r, q, r, z, diagonal; x, p, z, x, p
  constexpr double kVectors = 12;
  return static_cast<double>(matrix.block_count()) * (9 * value_bytes + sizeof(mo::Index)) +
         matrix.size() * (sizeof(mo::Offset) + kVectors * 3 * sizeof(double));
}

void print_iterations(std::vector<System>& systems, const Settings& settings) {
  constexpr std::size_t kColumns = 1 + 2 * kThreads.size();
  std::vector<std::array<double, kColumns>> best(systems.size());
  for (auto& row : best) row.fill(std::numeric_limits<double>::infinity());
  for (int round = 0; round < settings.rounds; ++round) {
    for (std::size_t i = 0; i < systems.size(); ++i) {
      best[i][0] = std::min(best[i][0], product_ms(systems[i]));
      for (std::size_t t = 0; t < kThreads.size(); ++t) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, kThreads[t]);
        best[i][1 + 2 * t] = std::min(best[i][1 + 2 * t], iteration_ms(systems[i], systems[i].matrix));
        best[i][2 + 2 * t] = std::min(best[i][2 + 2 * t], iteration_ms(systems[i], systems[i].rounded));
      }
    }
  }
  std::array<double, kThreads.size()> bandwidth{};
  for (std::size_t t = 0; t < kThreads.size(); ++t) {
    bandwidth[t] = mo::read_bandwidth(std::size_t{512} << 20, 8, kThreads[t]);
    fmt::print("{} thread{} read {:.1f} GB/s\n", kThreads[t], t == 0 ? "" : "s", bandwidth[t]);
  }
  fmt::print("{:<11}{:>9}", "order", "product");
  for (const int threads : kThreads)
    fmt::print("{:>9}{:>2}{:>7}{:>9}{:>2}{:>7}", "double", threads, "%", "float", threads, "%");
  fmt::print("\n");
  for (std::size_t i = 0; i < systems.size(); ++i) {
    fmt::print("{:<11}{:>9.3f}", systems[i].order, best[i][0]);
    for (std::size_t t = 0; t < kThreads.size(); ++t) {
      for (const std::size_t single : {0U, 1U}) {
        const double ms = best[i][1 + 2 * t + single];
        const double bytes = iteration_bytes(systems[i].matrix, single != 0 ? 4 : 8);
        fmt::print("{:>11.3f}{:>7.0f}", ms, 100e-6 * bytes / ms / bandwidth[t]);
      }
    }
    fmt::print("\n");
  }
}

void print_solves(std::vector<System>& systems) {
  constexpr std::array kKinds{mo::PreconditionerKind::jacobi, mo::PreconditionerKind::block_jacobi,
                              mo::PreconditionerKind::incomplete_cholesky, mo::PreconditionerKind::multigrid};
  fmt::print("{:<11}{:<21}{:>8}{:>9}{:>11}{:>10}{:>12}{:>12}\n", "order", "preconditioner", "threads",
             "update", "iterations", "seconds", "float: its", "seconds");
  for (System& system : systems) {
    for (const mo::PreconditionerKind kind : kKinds) {
      const auto preconditioner = mo::make_preconditioner(kind, system.matrix, system.points);
      for (const int threads : kThreads) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
        mo::Stopwatch stopwatch;
        preconditioner->update(system.matrix);
        const double update = stopwatch.seconds();
        fmt::print("{:<11}{:<21}{:>8}{:>9.4f}", system.order, mo::to_string(kind), threads, update);
        const auto solve = [&](const auto& matrix) {
          std::fill(system.x.begin(), system.x.end(), 0.0);
          const mo::Stopwatch clock;
          const mo::SolveReport report = mo::conjugate_gradients(matrix, *preconditioner, system.b, system.x);
          fmt::print("{:>11}{:>10.4f}", report.iterations, clock.seconds());
          if (report.status != mo::SolveStatus::converged) fmt::print(" {}", mo::to_string(report.status));
        };
        solve(system.matrix);
        solve(system.rounded);
        fmt::print("\n");
      }
    }
  }
}

}  // namespace

int main(int argc, char** argv) try {
  Settings settings;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--solve") {
      settings.solve = true;
    } else if (argument == "--half") {
      settings.half = true;
    } else if (argument == "--rounds" && i + 1 < argc) {
      settings.rounds = std::atoi(argv[++i]);
    } else if (argument == "--orders" && i + 1 < argc) {
      settings.orders = argv[++i];
    } else {
      settings.files.push_back(argument);
    }
  }
  for (const std::string& file : settings.files) {
    std::vector<System> systems = make_systems(file, settings.orders);
    fmt::print("{}: {} vertices, {:.1f} MB of matrix in double\n", file, systems.front().matrix.size(),
               76e-6 * static_cast<double>(systems.front().matrix.block_count()));
    if (settings.half) {
      print_halves(systems, settings);
    } else if (settings.solve) {
      print_solves(systems);
    } else {
      print_iterations(systems, settings);
    }
  }
  return 0;
} catch (const std::exception& error) {
  fmt::print(stderr, "cg: {}\n", error.what());
  return 2;
}
