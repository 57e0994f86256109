// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "mesh/procedural.hpp"
#include "metrics/edge_span.hpp"
#include "ordering/method.hpp"
#include "slices.hpp"
#include <meshorder/distributed.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace meshorder {
namespace {

using distributed::Communicator;
using distributed::GlobalIndex;
using distributed::MeshSlice;

/// A rank of a solver, with its ranges of a mesh's vertices and cells.
struct Solver {
  Communicator communicator;
  Mesh mesh;
  MeshSlice slice;

  explicit Solver(Mesh whole) : mesh(std::move(whole)), slice(scattered(communicator, mesh)) {}

  [[nodiscard]] RankMesh view() const {
    return {slice.vertices.size(communicator.rank()), slice.cell_vertices.offsets,
            slice.cell_vertices.entries,
            std::span(slice.points.empty() ? nullptr : slice.points.front().data(), 3 * slice.points.size())};
  }
  /// Returns the values of all ranks, on each rank.
  [[nodiscard]] std::vector<Index> all(const std::vector<std::int64_t>& own) const {
    const std::vector<std::int64_t> values = communicator.broadcast(communicator.gathered_at_root(own));
    return {values.begin(), values.end()};
  }
};

/// EXPECTs that all ranks get an error of this code with these words.
template <class Work>
void expect_error(const Work& work, Code code, const std::string& words) {
  try {
    work();
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), code);
    EXPECT_THAT(error.what(), testing::HasSubstr(words));
  }
}

TEST(OrderRanks, KeepsVerticesWithTheirOwnersAndBringsNeighboursTogether) {
  const Solver solver(make_ball({.size = 12}));
  const RankOrder order = order_ranks(MPI_COMM_WORLD, solver.view());
  const int rank = solver.communicator.rank();
  std::vector<std::int64_t> sorted = order.new_numbers;
  std::sort(sorted.begin(), sorted.end());
  for (std::size_t v = 0; v < sorted.size(); ++v)
    ASSERT_EQ(sorted[v], solver.slice.vertices.begin(rank) + static_cast<GlobalIndex>(v));

  const CsrGraph graph = vertex_graph(solver.mesh);
  const Permutation whole = Permutation::from_old_to_new(solver.all(order.new_numbers));
  EXPECT_LT(edge_span(graph, whole).mean_log2,
            0.95 * edge_span(graph, Permutation::identity(graph.size())).mean_log2);
  if (solver.communicator.size() == 1) {
    EXPECT_EQ(whole, order_graph("spectral", {.graph = graph}).permutation);
  }
}

TEST(OrderRanks, OrdersElementsByTheirNewNumbers) {
  const Solver solver(make_ball({.size = 5}));
  const RankOrder order = order_ranks(MPI_COMM_WORLD, solver.view());
  const std::vector<Index> numbers = solver.all(order.new_numbers);
  std::vector<std::vector<Index>> words;
  for (const std::int64_t c : order.cell_order) {
    std::vector<Index>& word = words.emplace_back();
    for (const GlobalIndex vertex : solver.slice.cell_vertices[c])
      word.push_back(numbers[static_cast<std::size_t>(vertex)]);
    std::sort(word.rbegin(), word.rend());
  }
  EXPECT_TRUE(std::is_sorted(words.begin(), words.end()));
  EXPECT_EQ(std::ssize(words), solver.slice.cell_vertices.size());
}

TEST(OrderRanks, TakesElementsThatSeveralRanksHave) {
  const Solver solver(make_ball({.size = 5}));
  const RankOrder order = order_ranks(MPI_COMM_WORLD, solver.view());
  Solver with_ghosts = Solver(make_ball({.size = 5}));
  distributed::Rows& cells = with_ghosts.slice.cell_vertices;
  for (Index c = 0; c < with_ghosts.mesh.cell_count(); c += 3) {
    const auto vertices = with_ghosts.mesh.cells[c];
    cells.entries.insert(cells.entries.end(), vertices.begin(), vertices.end());
    cells.end_row();
  }
  EXPECT_EQ(order_ranks(MPI_COMM_WORLD, with_ghosts.view()).new_numbers, order.new_numbers);
}

TEST(OrderRanks, NeedsNoCoordinatesButForGeometricOrders) {
  const Solver solver(make_torus({.size = 4}));
  RankMesh mesh = solver.view();
  const RankOrder placed = order_ranks(MPI_COMM_WORLD, mesh);
  mesh.points = {};
  EXPECT_EQ(order_ranks(MPI_COMM_WORLD, mesh).new_numbers, placed.new_numbers);
  expect_error([&] { (void)order_ranks(MPI_COMM_WORLD, mesh, {.method = "hilbert"}); },
               Code::invalid_argument, "needs coordinates");
  EXPECT_EQ(order_ranks(MPI_COMM_WORLD, solver.view(), {.method = "hilbert"}).new_numbers.size(),
            placed.new_numbers.size());
}

TEST(OrderParts, AreThoseOfTheCommand) {
  const Solver solver(make_ball({.size = 10}));
  const PartOrder parts = order_parts(MPI_COMM_WORLD, solver.view(), {.parts = 6});
  const distributed::DistributedOrder expected =
      order_slices(solver.communicator, solver.slice, {.parts = 6});
  EXPECT_EQ(parts.new_numbers, expected.new_vertices);
  EXPECT_EQ(parts.part_starts, expected.report.part_starts);
  const std::vector<Index> numbers = solver.all(parts.new_numbers);
  for (Offset c = 0; c < solver.slice.cell_vertices.size(); ++c) {
    Index last = 0;
    for (const GlobalIndex vertex : solver.slice.cell_vertices[c])
      last = std::max(last, numbers[static_cast<std::size_t>(vertex)]);
    const std::int64_t part = parts.cell_parts[static_cast<std::size_t>(c)];
    EXPECT_LE(parts.part_starts[static_cast<std::size_t>(part)], last);
    EXPECT_LT(last, parts.part_starts[static_cast<std::size_t>(part) + 1]);
  }
}

TEST(OrderRanks, PutsVerticesOfInterfacesLastWhereThatIsWanted) {
  const Solver solver(make_ball({.size = 6}));
  const RankOrder order = order_ranks(MPI_COMM_WORLD, solver.view(), {.interface_last = true});
  const std::vector<Index> numbers = solver.all(order.new_numbers);
  const int rank = solver.communicator.rank();
  const CsrGraph graph = vertex_graph(solver.mesh);
  std::int64_t first_shared = solver.slice.vertices.end(rank);
  std::int64_t last_own = -1;
  for (GlobalIndex v = solver.slice.vertices.begin(rank); v < solver.slice.vertices.end(rank); ++v) {
    const auto neighbours = graph[static_cast<Index>(v)];
    const bool is_shared = std::any_of(neighbours.begin(), neighbours.end(), [&](Index other) {
      return solver.slice.vertices.owner(other) != rank;
    });
    const std::int64_t number = numbers[static_cast<std::size_t>(v)];
    if (is_shared) first_shared = std::min(first_shared, number);
    if (!is_shared) last_own = std::max(last_own, number);
  }
  EXPECT_LT(last_own, first_shared);
}

TEST(OrderParts, NeedCoordinates) {
  const Solver solver(make_ball({.size = 4}));
  RankMesh mesh = solver.view();
  mesh.points = {};
  expect_error([&] { (void)order_parts(MPI_COMM_WORLD, mesh); }, Code::invalid_argument, "coordinates");
}

TEST(RankMeshes, WithoutVerticesOrElementsAreFine) {
  const Communicator communicator;
  const bool is_root = communicator.is_root();
  const std::vector<double> points{0, 0, 0, 1, 0, 0, 0, 1, 0};
  const std::vector<std::int64_t> offsets{0, 3};
  const std::vector<std::int64_t> vertices{0, 1, 2};
  const RankMesh at_root{3, offsets, vertices, points};
  EXPECT_EQ(order_ranks(MPI_COMM_WORLD, is_root ? at_root : RankMesh{}).new_numbers.size(),
            is_root ? 3U : 0U);
  EXPECT_EQ(order_ranks(MPI_COMM_WORLD, RankMesh{}).cell_order.size(), 0U);
  EXPECT_EQ(order_parts(MPI_COMM_WORLD, RankMesh{}).part_starts.back(), 0);
}

TEST(RankMeshes, AFaultOfOneRankIsReportedOnAll) {
  const Solver solver(make_ball({.size = 4}));
  const int last = solver.communicator.size() - 1;
  const bool is_last = solver.communicator.rank() == last;
  const auto expect_fault = [&](const RankMesh& faulty, const std::string& words) {
    expect_error([&] { (void)order_ranks(MPI_COMM_WORLD, is_last ? faulty : solver.view()); },
                 Code::invalid_argument, words);
    expect_error([&] { (void)order_parts(MPI_COMM_WORLD, is_last ? faulty : solver.view()); },
                 Code::invalid_argument, words);
  };
  std::vector<std::int64_t> vertices = solver.slice.cell_vertices.entries;
  std::vector<std::int64_t> offsets = solver.slice.cell_vertices.offsets;
  RankMesh mesh = solver.view();
  ASSERT_FALSE(vertices.empty());
  vertices.front() = solver.slice.vertices.size();
  mesh.cell_vertices = vertices;
  expect_fault(mesh, "cell_vertices: element 0 has the vertex");
  mesh = solver.view();
  offsets[1] = 0;
  mesh.cell_offsets = offsets;
  expect_fault(mesh, "element 0 has no vertices");
  offsets[1] = std::int64_t{1} << 40;
  mesh.cell_offsets = offsets;
  expect_fault(mesh, "element 1 has no vertices");
  mesh = solver.view();
  mesh.vertex_count = -1;
  expect_fault(mesh, "vertex_count: -1");
  mesh.vertex_count = std::numeric_limits<std::int64_t>::max();
  // the C++ functions cannot allocate the result, and say so on all ranks
  expect_error([&] { (void)order_ranks(MPI_COMM_WORLD, is_last ? mesh : solver.view()); }, Code::internal,
               "a rank lacks memory");
  expect_error([&] { (void)order_parts(MPI_COMM_WORLD, is_last ? mesh : solver.view()); }, Code::internal,
               "a rank lacks memory");
  expect_error(
      [&] {
        const mo_mpi_mesh given = detail::to_c(is_last ? mesh : solver.view());
        detail::throw_unless_ok(
            mo_mpi_order_ranks(MPI_Comm_c2f(MPI_COMM_WORLD), &given, nullptr, nullptr, nullptr));
      },
      Code::invalid_argument, "vertex_count: 9223372036854775807");
  mesh = solver.view();
  mesh.cell_vertices = mesh.cell_vertices.first(mesh.cell_vertices.size() - 1);
  expect_fault(mesh, "and cell_offsets end at");
  mesh = solver.view();
  mesh.points = mesh.points.first(mesh.points.size() - 1);
  expect_fault(mesh, "each vertex needs x y z");
  mesh = solver.view();
  std::vector<double> points(mesh.points.begin(), mesh.points.end());
  points.back() = std::numeric_limits<double>::quiet_NaN();
  mesh.points = points;
  expect_fault(mesh, "is not finite");
  expect_error(
      [&] {
        (void)order_ranks(MPI_COMM_WORLD, solver.view(), {.method = is_last ? "nonsense" : "spectral"});
      },
      Code::invalid_argument, "nonsense");
  expect_error([&] { (void)order_parts(MPI_COMM_WORLD, solver.view(), {.partition = "rcb"}); },
               Code::invalid_argument, "rcb");
  const Index n = solver.mesh.vertex_count();
  expect_error([&] { (void)order_parts(MPI_COMM_WORLD, solver.view(), {.parts = n + 1}); },
               Code::invalid_argument, "too few for " + std::to_string(n + 1) + " parts");
  // a table of so many parts would not fit in memory
  const auto most = std::numeric_limits<std::int32_t>::max();
  expect_error([&] { (void)order_parts(MPI_COMM_WORLD, solver.view(), {.parts = most}); },
               Code::invalid_argument, "too few for 2147483647 parts");
  EXPECT_EQ(order_parts(MPI_COMM_WORLD, solver.view(), {.parts = n}).part_starts.back(), n);
  if (last > 0) {
    mesh = solver.view();
    mesh.points = {};
    expect_fault(mesh, "some ranks have coordinates");
  }
}

TEST(StructuresOfC, OfAnOlderHeaderAreTakenWithoutTheFieldsThatItLacks) {
  const Solver solver(make_ball({.size = 6}));
  const std::int32_t communicator = MPI_Comm_c2f(MPI_COMM_WORLD);
  mo_mpi_mesh mesh = detail::to_c(solver.view());
  const std::string method = "rcm";
  mo_mpi_options options = detail::to_c(RankOptions{.method = method, .interface_last = true});
  std::vector<std::int64_t> numbers(static_cast<std::size_t>(mesh.vertex_count));
  const auto order = [&] {
    return mo_mpi_order_ranks(communicator, &mesh, &options, numbers.data(), nullptr);
  };

  // what lies beyond a structure is not read
  mesh.struct_size = offsetof(mo_mpi_mesh, cell_vertex_count);
  mesh.cell_vertex_count = mesh.coordinate_count = -1;
  options.struct_size = offsetof(mo_mpi_options, interface_last);
  options.reserved = -1;
  ASSERT_EQ(order(), MO_OK) << mo_mpi_last_error();
  EXPECT_EQ(numbers, order_ranks(MPI_COMM_WORLD, solver.view(), {.method = method}).new_numbers);

  const auto expect_refusal = [&](const std::string& words) {
    EXPECT_EQ(order(), MO_INVALID_ARGUMENT);
    EXPECT_THAT(mo_mpi_last_error(), testing::HasSubstr(words));
  };
  for (const std::size_t size : {std::size_t{0}, offsetof(mo_mpi_mesh, points), std::size_t{1} << 40}) {
    mesh.struct_size = size;
    expect_refusal("mesh: struct_size is " + std::to_string(size));
  }
  mesh.struct_size = offsetof(mo_mpi_mesh, cell_vertex_count);
  options.struct_size = 0;
  expect_refusal("options: struct_size is 0");
}

TEST(StructuresOfC, AreFilledInUpToTheirSize) {
  mo_mpi_options options{};
  options.threads = options.interface_last = 7;
  mo_mpi_options_init(&options, offsetof(mo_mpi_options, interface_last));
  EXPECT_EQ(options.struct_size, offsetof(mo_mpi_options, interface_last));
  EXPECT_EQ(options.threads, 1);
  EXPECT_EQ(options.interface_last, 7);
}

TEST(RankOptions, ThatDifferBetweenRanksAreRefusedOnAll) {
  const Solver solver(make_ball({.size = 4}));
  if (solver.communicator.size() == 1) return;
  const bool is_last = solver.communicator.rank() == solver.communicator.size() - 1;
  const auto expect_refusal = [&](const RankOptions& others, const std::string& words) {
    const RankOptions own = is_last ? others : RankOptions{};
    expect_error([&] { (void)order_parts(MPI_COMM_WORLD, solver.view(), own); }, Code::invalid_argument,
                 words);
    expect_error([&] { (void)order_ranks(MPI_COMM_WORLD, solver.view(), own); }, Code::invalid_argument,
                 words);
  };
  expect_refusal({.method = "rcm"}, "method is 'rcm', and on rank 0 'spectral'");
  expect_refusal({.partition = "rsb"}, "partition is 'rsb'");
  expect_refusal({.balance = "cells"}, "balance is 'cells'");
  expect_refusal({.seed = 7}, "seed is '7', and on rank 0 '0'");
  expect_refusal({.parts = 3}, "parts is '3'");
  expect_refusal({.interface_last = true}, "interface_last is 'true'");
  EXPECT_NO_THROW((void)order_parts(MPI_COMM_WORLD, solver.view(), {.threads = is_last ? 2 : 1}));
}

}  // namespace
}  // namespace meshorder
