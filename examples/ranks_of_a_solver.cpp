// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// mpirun -n 4 ./ranks_of_a_solver
//
// Orders the vertices and elements of each rank of a solver that has distributed its mesh. Here the mesh is a
// rectangle of triangles, of which each rank owns some columns, numbered in a poor order.
#include <meshorder/distributed.hpp>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <numeric>
#include <vector>

namespace {

constexpr std::int64_t kRows = 60;     // rows of vertices
constexpr std::int64_t kColumns = 20;  // columns of vertices that a rank owns

/// Returns the global number of the vertex in row i and column j. The vertices of a rank are numbered in
/// steps of seven, modulo their count.
std::int64_t number_of(std::int64_t i, std::int64_t j) {
  const std::int64_t owner = j / kColumns;
  const std::int64_t place = j % kColumns * kRows + i;
  return owner * kRows * kColumns + 7 * place % (kRows * kColumns);
}

/// Returns the triangles that a rank computes, three vertices each: those to the left of its columns.
std::vector<std::int64_t> triangles_of(int rank) {
  std::vector<std::int64_t> vertices;
  const std::int64_t first = std::max<std::int64_t>(1, rank * kColumns);
  for (std::int64_t j = first; j < (rank + 1) * kColumns; ++j) {
    for (std::int64_t i = 1; i < kRows; ++i) {
      for (const std::int64_t vertex : {number_of(i - 1, j - 1), number_of(i, j - 1), number_of(i, j),
                                        number_of(i - 1, j - 1), number_of(i, j), number_of(i - 1, j)})
        vertices.push_back(vertex);
    }
  }
  return vertices;
}

/// Returns the mean difference between the numbers of an edge's ends, over the triangles' edges whose ends
/// are both own vertices.
double mean_span(const std::vector<std::int64_t>& vertices, std::int64_t first,
                 const std::vector<std::int64_t>& number) {
  double sum = 0;
  std::int64_t count = 0;
  const auto is_own = [&](std::int64_t v) { return v >= first && v < first + std::ssize(number); };
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    const std::int64_t a = vertices[k];
    const std::int64_t b = vertices[k % 3 == 2 ? k - 2 : k + 1];
    if (!is_own(a) || !is_own(b)) continue;
    sum += static_cast<double>(
        std::abs(number[static_cast<std::size_t>(a - first)] - number[static_cast<std::size_t>(b - first)]));
    ++count;
  }
  return count > 0 ? sum / static_cast<double>(count) : 0;
}

/// Orders this rank's vertices and elements. Returns whether the mean span shrinks.
bool improves(int rank) {
  const std::vector<std::int64_t> vertices = triangles_of(rank);
  std::vector<std::int64_t> offsets;
  for (std::size_t k = 0; k <= vertices.size(); k += 3) offsets.push_back(static_cast<std::int64_t>(k));
  const meshorder::RankMesh mesh{kRows * kColumns, offsets, vertices, {}};

  const meshorder::RankOrder order = meshorder::order_ranks(MPI_COMM_WORLD, mesh);

  const std::int64_t first = rank * kRows * kColumns;
  std::vector<std::int64_t> old_numbers(order.new_numbers.size());
  std::iota(old_numbers.begin(), old_numbers.end(), first);
  const double before = mean_span(vertices, first, old_numbers);
  const double after = mean_span(vertices, first, order.new_numbers);
  std::printf("rank %d: mean span %.1f -> %.1f\n", rank, before, after);
  return after < before;
}

}  // namespace

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  try {
    const bool better = improves(rank);
    MPI_Finalize();
    return better ? 0 : 1;
  } catch (const std::exception& error) {  // thrown on all ranks
    if (rank == 0) std::fprintf(stderr, "%s\n", error.what());
    MPI_Abort(MPI_COMM_WORLD, 2);
    return 2;
  }
}
