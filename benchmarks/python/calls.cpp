// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Makes the C++ calls that compare.py compares with calls from Python. `calls FOLDER` reads the arrays of a
// mesh and its graph from the folder's files offsets (64-bit integers), neighbours (32-bit), points (double)
// and cells (32-bit, four a tetrahedron). For every line on stdin, CALL TIME|MEMORY, it makes the call and
// prints the seconds it took, or by how many bytes the process grew.
#include "../peak_memory.hpp"
#include <meshorder/fiedler.hpp>
#include <meshorder/order.hpp>

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using namespace meshorder;

template <class Number>
std::vector<Number> read(const std::filesystem::path& path) {
  std::vector<Number> numbers(std::filesystem::file_size(path) / sizeof(Number));
  std::ifstream file(path, std::ios::binary);
  file.read(reinterpret_cast<char*>(numbers.data()),  // NOLINT: the file's bytes
            static_cast<std::streamsize>(numbers.size() * sizeof(Number)));
  if (!file) throw std::runtime_error(path.string() + ": cannot be read");
  return numbers;
}

struct Arrays {
  explicit Arrays(const std::filesystem::path& folder)
      : offsets(read<std::int64_t>(folder / "offsets")),
        neighbours(read<std::int32_t>(folder / "neighbours")),
        points(read<double>(folder / "points")),
        cells(read<std::int32_t>(folder / "cells")) {}

  void call(const std::string& name) const {
    const GraphView graph{.offsets = std::span(offsets), .neighbours = std::span(neighbours)};
    OrderOptions options;
    if (name == "fiedler") options.tolerance = 1e-8;  // as in Python
    if (name == "order_mesh") {
      const std::size_t count = points.size() / 3;
      (void)order_mesh({PointsView(points.data(), count),
                        CellsView::uniform(Shape::tetrahedron, 4, std::span(cells)), count});
    } else if (name == "fiedler") {
      (void)fiedler_vector(graph, options);
    } else {
      (void)order_vertices(graph, name, options);
    }
  }

  std::vector<std::int64_t> offsets;
  std::vector<std::int32_t> neighbours;
  std::vector<double> points;
  std::vector<std::int32_t> cells;
};

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 2) throw std::runtime_error("usage: calls FOLDER");
  const Arrays arrays(argv[1]);
  for (std::string name, what; std::cin >> name >> what;) {
    if (what == "MEMORY") {
      const PeakMemory peak;
      arrays.call(name);
      std::cout << peak.bytes() << std::endl;
    } else {
      const auto start = std::chrono::steady_clock::now();
      arrays.call(name);
      std::cout << std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()
                << std::endl;
    }
  }
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
