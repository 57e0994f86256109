// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/files/exodus_slices.hpp"

#include "distributed/files/grid_rows.hpp"
#include "distributed/files/moved_part.hpp"
#include "distributed/files/pieces.hpp"
#include "io/format.hpp"
#include "mesh/graphs.hpp"
#include "ordering/order_cells.hpp"
#include "support/files.hpp"
#include "support/sample_meshes.hpp"
#include <meshorder/error.hpp>
#include <meshorder/io.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <limits>
#include <numeric>

#ifdef MESHORDER_HAS_NETCDF
#include "io/exodus/exodus.hpp"

namespace meshorder::distributed {
namespace {

/// A file that the root writes, removed at the end of the test.
class SharedMesh {
 public:
  SharedMesh(const Communicator& communicator, const Mesh& mesh, const std::string& name = "a.e")
      : communicator_(communicator) {
    path_ = communicator
                .broadcast(communicator.at_root([&] {
                  const std::filesystem::path path = folder_.path() / name;
                  (void)write_mesh(mesh, path);
                  return std::vector{path.string()};
                }))
                .front();
  }
  ~SharedMesh() { (void)communicator_.gathered(0); }  // waits until all ranks have read the file
  SharedMesh(const SharedMesh&) = delete;
  SharedMesh(SharedMesh&&) = delete;
  SharedMesh& operator=(const SharedMesh&) = delete;
  SharedMesh& operator=(SharedMesh&&) = delete;

  [[nodiscard]] const std::string& path() const noexcept { return path_; }

 private:
  const Communicator& communicator_;
  test::TemporaryFolder folder_;
  std::string path_;
};

/// Reads a mesh as rank 0 does if it will write .vtu files.
Mesh read_for_vtu(const std::string& path) {
  Mesh mesh = read_mesh(path);
  (void)arrange_cells(mesh, format_named("vtu"));
  return mesh;
}

/// Puts the root's mesh into an order.
void move(const Communicator& communicator, Mesh& mesh, const DistributedOrder& order) {
  const std::vector<GlobalIndex> vertices = communicator.gathered_at_root(order.new_vertices);
  const std::vector<GlobalIndex> cells = communicator.gathered_at_root(order.cells);
  if (!communicator.is_root()) return;
  const Permutation places = permutation_within_classes(slot_classes(cell_arrays(mesh)),
                                                        std::vector<Index>(cells.begin(), cells.end()));
  apply_reordering(mesh, Permutation::from_old_to_new({vertices.begin(), vertices.end()}), places);
}

void expect_equal(const MeshSlice& actual, const MeshSlice& expected) {
  EXPECT_EQ(actual.vertices.starts(), expected.vertices.starts());
  EXPECT_EQ(actual.cells.starts(), expected.cells.starts());
  EXPECT_EQ(actual.points, expected.points);
  EXPECT_EQ(actual.cell_vertices, expected.cell_vertices);
  EXPECT_EQ(actual.shapes, expected.shapes);
}

/// The properties of an array in pieces.
using ArrayRow = std::tuple<std::string, int, int, Offset, std::string, std::string>;

std::vector<ArrayRow> table_of(const PieceSchema& schema) {
  std::vector<ArrayRow> table;
  for (const PieceArray& array : schema.arrays()) {
    table.emplace_back(array.name, static_cast<int>(array.source), array.type, array.row_size(),
                       array.attributes, array.inside);
  }
  return table;
}

void expect_equal(const Communicator& communicator, const GridRows& actual, const GridRows& expected) {
  EXPECT_EQ(actual.vertices.starts(), expected.vertices.starts());
  EXPECT_EQ(actual.cells.starts(), expected.cells.starts());
  EXPECT_EQ(actual.cell_vertices, expected.cell_vertices);
  EXPECT_EQ(actual.fields, expected.fields);
  EXPECT_EQ(actual.texts, expected.texts);
  const PieceSchema schema = schema_of_pieces(communicator, actual, 1);
  const PieceSchema other = schema_of_pieces(communicator, expected, 1);
  ASSERT_EQ(table_of(schema), table_of(other));
  EXPECT_EQ(schema.has_order_of_vtk_9(), other.has_order_of_vtk_9());
  for (const PieceArray& array : schema.arrays()) {
    if (array.source != PieceArray::Source::rows) continue;
    EXPECT_EQ(actual.rows(array.number), expected.rows(array.number)) << array.name;
  }
}

/// Reads a file by all ranks and by rank 0, and orders it.
void expect_alike(const Communicator& communicator, const std::string& path,
                  const DistributedOptions& options = {.partitioner = Partitioner::hilbert, .parts = 3}) {
  Mesh whole;
  communicator.at_root([&] { whole = read_for_vtu(path); });
  const std::optional<ExodusSlices> slices = ExodusSlices::open(communicator, path);
  ASSERT_TRUE(slices);
  MeshSlice slice = slices->read(communicator);
  expect_equal(slice, scattered(communicator, whole));

  const DistributedOrder order = order_slices(communicator, std::move(slice), options);
  Notes notes;
  Notes of_grid;
  MovedPart moved(communicator, slices->read_part(communicator, notes), order, {}, notes);
  const std::vector<std::int64_t> vertex_ids = whole.vertex_ids;
  const std::vector<std::int64_t> cell_ids = whole.cell_ids;
  const auto ids_at_root = [&](Association of) {
    const std::vector<std::int64_t>* const own = moved.ids(of);
    return communicator.gathered_at_root(own == nullptr ? std::vector<std::int64_t>() : *own);
  };
  EXPECT_EQ(ids_at_root(Association::vertices), vertex_ids);
  EXPECT_EQ(ids_at_root(Association::cells), cell_ids);
  move(communicator, whole, order);
  expect_equal(moved.slice(), scattered(communicator, whole));
  Notes expected_notes;
  const GridRows expected = scattered_grid(communicator, whole, expected_notes);
  expect_equal(communicator, moved_grid(communicator, moved, of_grid), expected);
  EXPECT_EQ(of_grid, expected_notes);
}

/// A mesh of all types of cells in several blocks, with unsorted ids, labels beyond 32 bits, unsorted sets,
/// sides with factors, and arrays of some cells and at two steps.
Mesh with_everything() {
  Mesh mesh = test::mixed_mesh();
  const Index vertices = mesh.vertex_count();
  const Index cells = mesh.cell_count();
  for (Index v = 0; v < vertices; ++v) mesh.vertex_ids.push_back(10 * ((v * 7) % vertices) + 3);
  for (Index c = 0; c < cells; ++c) mesh.cell_ids.push_back((std::int64_t{1} << 40) - 5 * c);
  std::vector<std::int64_t> owners(static_cast<std::size_t>(vertices), 4);
  owners.back() = std::int64_t{1} << 33;  // only the last rank needs 64 bits
  mesh.data.push_back({.name = "map owner", .values = owners});
  for (const char* const name : {"heat step 1", "heat step 2"}) {
    std::vector<double> values(static_cast<std::size_t>(cells / 2));
    std::iota(values.begin(), values.end(), 0.5);
    std::vector<Index> rows(values.size());
    std::iota(rows.begin(), rows.end(), cells / 3);
    mesh.data.push_back({.name = name, .association = Association::cells, .values = values, .indices = rows});
  }
  std::vector<Index> falling(static_cast<std::size_t>(vertices / 2));
  std::iota(falling.rbegin(), falling.rend(), Index{1});
  mesh.sets.push_back({"falling", Association::vertices, falling});
  mesh.sets.push_back({"one", Association::vertices, {vertices - 1}});
  mesh.sets.push_back({"none", Association::vertices, {}});
  return mesh;
}

/// The mesh, which will be written to a compressed netCDF-4 file.
Mesh compressed(const Mesh& mesh) {
  const test::TemporaryFolder folder;
  (void)write_mesh(mesh, folder.path() / "a.e");
  Mesh result = read_mesh(folder.path() / "a.e");
  auto metadata = std::make_shared<exodus::ExodusMetadata>(
      dynamic_cast<const exodus::ExodusMetadata&>(*result.format_metadata));
  constexpr int kNetcdf4 = 3;
  metadata->storage = {kNetcdf4, 5, true};
  result.format_metadata = metadata;
  return result;
}

TEST(ExodusSlices, AreWhatRank0DealsOut) {
  const Communicator communicator;
  expect_alike(communicator, SharedMesh(communicator, test::tetrahedral_bar(40)).path());
}

TEST(ExodusSlices, HaveAllThatBelongsToPointsAndCells) {
  const Communicator communicator;
  const Mesh mesh = with_everything();
  const SharedMesh classic(communicator, mesh);
  expect_alike(communicator, classic.path());
  const SharedMesh netcdf4(communicator, communicator.at_root([&] { return compressed(mesh); }));
  expect_alike(communicator, netcdf4.path());
}

TEST(ExodusSlices, HoldFewerCellsThanRanks) {
  const Communicator communicator;
  Mesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.cells.push_back(Shape::tetrahedron, std::array<Index, 4>{0, 1, 2, 3});
  mesh.cell_ids = {9};
  mesh.data = {{"side set foot", Association::cells, 1, std::vector<std::int32_t>{8}, {}, {}},
               {"t", Association::vertices, 1, std::vector<float>{1, 2, 3, 4}, {}, {}}};
  mesh.sets = {{"top", Association::vertices, {3, 1}}};
  expect_alike(communicator, SharedMesh(communicator, mesh).path());
}

TEST(ExodusSlices, IdsStayWhereNothingMoves) {
  const Communicator communicator;
  Mesh mesh = test::tetrahedral_bar(2);
  for (Index v = mesh.vertex_count(); v > 0; --v) mesh.vertex_ids.push_back(v + 1);
  const SharedMesh file(communicator, mesh);
  const std::optional<ExodusSlices> slices = ExodusSlices::open(communicator, file.path());
  ASSERT_TRUE(slices);
  MeshSlice slice = slices->read(communicator);
  const int rank = communicator.rank();
  DistributedOrder order;
  order.new_vertices.resize(static_cast<std::size_t>(slice.vertices.size(rank)));
  std::iota(order.new_vertices.begin(), order.new_vertices.end(), slice.vertices.begin(rank));
  order.cells.resize(slice.shapes.size());
  std::iota(order.cells.begin(), order.cells.end(), slice.cells.begin(rank));
  Notes notes;
  MovedPart moved(communicator, slices->read_part(communicator, notes), order, {}, notes);
  Mesh whole;
  communicator.at_root([&] { whole = read_for_vtu(file.path()); });
  move(communicator, whole, order);
  const GridRows expected = scattered_grid(communicator, whole, notes);
  expect_equal(communicator, moved_grid(communicator, moved, notes), expected);
}

TEST(ExodusSlices, LeaveOtherFilesToRank0) {
  const Communicator communicator;
  const Mesh bar = test::tetrahedral_bar(2);
  EXPECT_FALSE(ExodusSlices::open(communicator, SharedMesh(communicator, bar, "a.vtu").path()));
  // VTK has no separate type for triangles of seven nodes
  const Mesh bubbles = test::cells_of_type(Shape::triangle, 7, 2);
  const bool held = format_named("vtu").holds(bubbles, Shape::triangle, 7);
  EXPECT_EQ(ExodusSlices::open(communicator, SharedMesh(communicator, bubbles).path()).has_value(), held);
  Mesh typed = bar;
  typed.data.push_back({.name = "vtk:type",
                        .association = Association::cells,
                        .values = std::vector<double>(static_cast<std::size_t>(bar.cell_count()), 10)});
  EXPECT_FALSE(ExodusSlices::open(communicator, SharedMesh(communicator, typed).path()));
}

TEST(ExodusSlices, AFaultOfOneRankIsOneOfAll) {
  const Communicator communicator;
  const SharedMesh file(communicator, test::tetrahedral_bar(8));
  const std::optional<ExodusSlices> slices = ExodusSlices::open(communicator, file.path());
  ASSERT_TRUE(slices);
  communicator.at_root([&] { std::filesystem::resize_file(file.path(), 4000); });
  EXPECT_THROW((void)slices->read(communicator), SharedError);
  communicator.at_root([&] { (void)write_mesh(test::tetrahedral_bar(7), file.path()); });
  EXPECT_THAT(
      [&] { (void)slices->read(communicator); },
      testing::ThrowsMessage<SharedError>(testing::HasSubstr("fewer than where it was opened first")));
  communicator.at_root([&] { std::filesystem::remove(file.path()); });
  EXPECT_THROW((void)slices->read(communicator), SharedError);
}

}  // namespace
}  // namespace meshorder::distributed
#endif
