// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <functional>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

/// Shared by the measuring programs of the plugins: a mesh by TetGen, and fair timing.
namespace measuring {

struct Tetrahedra {
  std::vector<std::array<double, 3>> points;
  std::vector<std::array<int, 4>> cells;  ///< oriented as VTK's and TetGen's tetrahedra are
};

/// Reads PREFIX.node and PREFIX.ele, as `tetgen` writes them, numbered from 0.
///
/// @throws std::runtime_error if a file is missing or ends early
inline Tetrahedra read_tetgen(const std::string& prefix) {
  Tetrahedra mesh;
  std::ifstream nodes(prefix + ".node");
  std::ifstream elements(prefix + ".ele");
  std::size_t points = 0;
  std::size_t cells = 0;
  int skipped = 0;
  nodes >> points >> skipped >> skipped >> skipped;
  elements >> cells >> skipped >> skipped;
  for (std::size_t p = 0; p < points && nodes; ++p) {
    std::array<double, 3> point{};
    nodes >> skipped >> point[0] >> point[1] >> point[2];
    mesh.points.push_back(point);
  }
  for (std::size_t c = 0; c < cells && elements; ++c) {
    std::array<int, 4> cell{};
    elements >> skipped >> cell[0] >> cell[1] >> cell[2] >> cell[3];
    mesh.cells.push_back(cell);
  }
  if (points == 0 || cells == 0 || !nodes || !elements) {
    throw std::runtime_error(prefix + ": not .node and .ele files of TetGen, numbered from 0");
  }
  return mesh;
}

/// Returns the processor time in seconds that this process takes for the work.
template <class Work>
double processor_seconds(const Work& work) {
  const std::clock_t begin = std::clock();
  work();
  return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

inline double median(std::vector<double> values) {
  std::ranges::sort(values);
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
}

/// An order and the work to be timed in it.
struct Case {
  std::string name;
  std::string facts;  ///< cells of the table without timings, separated by bars
  std::vector<std::function<void()>> work;
};

/// Runs every work of all cases once a round, in a random sequence of the cases. Prints a table in Markdown:
/// the median of each work's processor time, and the median, over the rounds, of how many times faster the
/// work is than in the first case.
///
/// @param titles  of the works
/// @param facts   titles of the cells in `Case::facts`, separated by bars
inline void measure(const std::vector<Case>& cases, const std::vector<std::string>& titles,
                    const std::string& facts, int rounds) {
  std::vector times(cases.size(), std::vector<std::vector<double>>(titles.size()));
  std::vector<std::size_t> sequence(cases.size());
  std::mt19937 random(1);
  for (std::size_t k = 0; k < cases.size(); ++k) sequence[k] = k;
  for (int round = 0; round < rounds; ++round) {
    std::shuffle(sequence.begin(), sequence.end(), random);
    for (const std::size_t k : sequence) {
      for (std::size_t w = 0; w < titles.size(); ++w) {
        times[k][w].push_back(processor_seconds(cases[k].work[w]));
      }
    }
  }
  std::printf("| order | %s |", facts.c_str());
  for (const std::string& title : titles) std::printf(" %s | gain |", title.c_str());
  std::printf("\n| --- |");
  for (auto columns = 1 + std::ranges::count(facts, '|') + 2 * std::ssize(titles); columns > 0; --columns) {
    std::printf(" ---: |");
  }
  std::printf("\n");
  for (std::size_t k = 0; k < cases.size(); ++k) {
    std::printf("| %s | %s |", cases[k].name.c_str(), cases[k].facts.c_str());
    for (std::size_t w = 0; w < titles.size(); ++w) {
      std::vector<double> gains;
      for (std::size_t round = 0; round < times[k][w].size(); ++round) {
        gains.push_back(times[0][w][round] / times[k][w][round]);
      }
      std::printf(" %.3f s | %.2f |", median(times[k][w]), median(std::move(gains)));
    }
    std::printf("\n");
  }
}

}  // namespace measuring
