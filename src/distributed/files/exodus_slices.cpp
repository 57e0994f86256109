// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/files/exodus_slices.hpp"

#include "io/cell_division.hpp"
#include "io/stream/file_path.hpp"
#include "io/stream/read_limits.hpp"
#include "io/vtk/vtk.hpp"
#include "mesh/cells.hpp"
#ifdef MESHORDER_HAS_NETCDF
#include "io/exodus/exodus.hpp"
#endif

#include <algorithm>
#include <filesystem>
#include <utility>

namespace meshorder::distributed {

#ifdef MESHORDER_HAS_NETCDF
namespace {

/// Returns the number of vertices of a file, whether pieces can keep its blocks (1 or 0), then 0 and the end
/// of each block; nothing for a file that the ranks cannot read together.
std::vector<GlobalIndex> counts_of(const std::string& path) {
  std::error_code code;
  if (format_of(path).key() != "exodus" || without_gz(path) != path ||
      !std::filesystem::is_regular_file(path, code)) {
    return {};
  }
  const FilePath file(path);
  const ReadScope scope(file);
  const exodus::Header header = exodus::read_header(file);
  const bool are_held =
      std::all_of(header.blocks.begin(), header.blocks.end(), [](const exodus::BlockRecord& block) {
        return block.nodes == 0 || vtk::holds(Mesh{}, block.shape, block.nodes);
      });
  // an array of VTK's cell types overrides the types that follow from shapes and node counts
  const bool have_types = std::find(header.element_variables.begin(), header.element_variables.end(),
                                    vtk::kCellTypes) != header.element_variables.end();
  if (!are_held || have_types || header.vertices == 0 || header.cells == 0) return {};
  const bool are_blocks_of_pieces = !header.is_piece && header.blocks.size() <= kMostBlocks;
  std::vector<GlobalIndex> counts{header.vertices, are_blocks_of_pieces ? 1 : 0};
  counts.insert(counts.end(), header.block_ends.begin(), header.block_ends.end());
  return counts;
}

/// Adds the notes of all ranks to `notes` at the root, each note once.
void gather_notes(const Communicator& communicator, const Notes& own, Notes& notes) {
  std::vector<char> text;
  for (const std::string& note : own) {
    text.insert(text.end(), note.begin(), note.end());
    text.push_back('\0');
  }
  const std::vector<char> all = communicator.gathered_at_root(text);
  communicator.at_root([&] {
    Notes found;
    for (auto at = all.begin(); at != all.end();) {
      const auto end = std::find(at, all.end(), '\0');
      const std::string note(at, end);
      if (std::find(found.begin(), found.end(), note) == found.end()) found.push_back(note);
      at = end + 1;
    }
    notes.insert(notes.end(), found.begin(), found.end());
  });
}

/// Adds a note on cells that have a vertex twice, as the reader of whole meshes does.
void note_degenerate(const Communicator& communicator, const MeshPart& part, Notes& notes) {
  struct DegenerateCells {
    GlobalIndex count = 0;
    GlobalIndex first = 0;
  };
  const DegenerateCells own = communicator.together([&] {
    const std::vector<Index> cells = degenerate_cells(part.mesh.cells);
    return DegenerateCells{std::ssize(cells), cells.empty() ? 0 : part.ranges.cells.first + cells.front()};
  });
  const std::vector<DegenerateCells> all = communicator.gathered(own);
  GlobalIndex count = 0;
  for (const DegenerateCells& found : all) count += found.count;
  if (count == 0 || !communicator.is_root()) return;
  const auto first =
      std::find_if(all.begin(), all.end(), [](const DegenerateCells& found) { return found.count > 0; });
  notes.push_back(note_of_degenerate(count, first->first));
}

}  // namespace

std::optional<ExodusSlices> ExodusSlices::open(const Communicator& communicator, const std::string& path) {
  const std::vector<GlobalIndex> counts =
      communicator.broadcast(communicator.at_root([&] { return counts_of(path); }));
  if (counts.empty()) return std::nullopt;
  ExodusSlices slices;
  slices.path_ = path;
  slices.vertices_ = Layout::even(counts[0], communicator.size());
  slices.cells_ = Layout::even(counts.back(), communicator.size());
  slices.has_blocks_of_pieces_ = counts[1] != 0;
  slices.block_ends_.assign(counts.begin() + 2, counts.end());
  return slices;
}

MeshPart ExodusSlices::own_part(const Communicator& communicator, bool with_data, Notes& notes) const {
  const auto range = [rank = communicator.rank()](const Layout& layout) {
    return MeshRange{static_cast<Index>(layout.begin(rank)), static_cast<Index>(layout.end(rank))};
  };
  const FilePath file(path_);
  const ReadScope scope(file);
  return exodus::read_part(file, {range(vertices_), range(cells_)},
                           with_data ? exodus::PartContent::all : exodus::PartContent::points_and_cells,
                           notes);
}

MeshSlice ExodusSlices::read(const Communicator& communicator) const {
  return communicator.together([&] {
    Notes ignored;
    Mesh mesh = own_part(communicator, false, ignored).mesh;
    MeshSlice slice;
    slice.vertices = vertices_;
    slice.cells = cells_;
    slice.points = std::move(mesh.points);
    slice.shapes = std::move(mesh.cells.shapes);
    slice.cell_vertices.offsets = std::move(mesh.cells.offsets);
    slice.cell_vertices.entries.assign(mesh.cells.vertices.begin(), mesh.cells.vertices.end());
    return slice;
  });
}

MeshPart ExodusSlices::read_part(const Communicator& communicator, Notes& notes) const {
  Notes own;
  MeshPart part = communicator.together([&] { return own_part(communicator, true, own); });
  gather_notes(communicator, own, notes);
  note_degenerate(communicator, part, notes);
  return part;
}
#else
std::optional<ExodusSlices> ExodusSlices::open(const Communicator& /*communicator*/,
                                               const std::string& /*path*/) {
  return std::nullopt;
}
MeshSlice ExodusSlices::read(const Communicator& /*communicator*/) const { return {}; }
MeshPart ExodusSlices::read_part(const Communicator& /*communicator*/, Notes& /*notes*/) const { return {}; }
#endif

}  // namespace meshorder::distributed
