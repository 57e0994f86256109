// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "sliced_maps.hpp"

#include "base/checksum.hpp"
#include "distributed/comm/halo.hpp"
#include "distributed/files/shared_file.hpp"
#include "distributed/order/partition.hpp"
#include "io/npy.hpp"
#include "io/stream/byte_order.hpp"
#include "shared_output.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <numeric>
#include <span>

namespace meshorder::command {
namespace {

using distributed::add_in_rank_order;
using distributed::Communicator;
using distributed::GlobalIndex;
using distributed::Layout;
using distributed::MeshSlice;
using distributed::SharedFile;

/// Returns the checksum of a list whose parts the ranks hold in rank order.
std::uint64_t checksum_of(const Communicator& communicator, const Layout& layout,
                          const std::vector<GlobalIndex>& own) {
  Checksum checksum;
  checksum.add(layout.size());
  add_in_rank_order(communicator, checksum, [&] {
    for (const GlobalIndex number : own) checksum.add(number);
  });
  return checksum.value();
}

/// Returns the old number for each of this rank's new numbers.
std::vector<GlobalIndex> inverse(const Communicator& communicator, const Layout& layout,
                                 const std::vector<GlobalIndex>& new_numbers) {
  const std::vector<GlobalIndex> old_numbers = communicator.together([&] {
    std::vector<GlobalIndex> numbers(new_numbers.size());
    std::iota(numbers.begin(), numbers.end(), layout.begin(communicator.rank()));
    return numbers;
  });
  return distributed::delivered<GlobalIndex>(communicator, layout, new_numbers, old_numbers, GlobalIndex{-1});
}

/// Writes maps as files of a set.
class MapWriter {
 public:
  MapWriter(const Communicator& communicator, OutputSet& outputs)
      : communicator_(communicator), outputs_(outputs) {}

  /// Writes, in the format of `write_npy`, a list of positions that is distributed over the ranks.
  void write(const std::string& name, const Layout& layout, const std::vector<GlobalIndex>& own) {
    write(name, layout, own, layout.size() <= kMaxIndex);
  }

  /// Writes a list of numbers, in 32 bits if `is_narrow`, else in 64.
  void write(const std::string& name, const Layout& layout, const std::vector<GlobalIndex>& own,
             bool is_narrow) {
    const Offset width = is_narrow ? sizeof(std::int32_t) : sizeof(std::int64_t);
    const std::string header = npy_header(is_narrow ? "<i4" : "<i8", std::array{layout.size()});
    SharedOutput file(communicator_, outputs_, FilePath::derived(name), header);
    const std::vector<char> bytes = communicator_.together([&] {
      std::vector<char> result(own.size() * static_cast<std::size_t>(width));
      char* at = result.data();
      for (const GlobalIndex number : own) {
        at = is_narrow ? put_number(at, static_cast<std::int32_t>(number), std::endian::little)
                       : put_number(at, number, std::endian::little);
      }
      return result;
    });
    SharedFile out(communicator_, file.path(), name, SharedFile::Use::write);
    out.write(std::ssize(header) + layout.begin(communicator_.rank()) * width,
              std::as_bytes(std::span(bytes)));
    out.close();
    file.commit();
    written.push_back(name);
  }

  /// Writes a map and its inverse, and the old numbers if `ids` is not null.
  void write_all(const MapPaths& paths, const Layout& layout, const std::vector<GlobalIndex>& new_numbers,
                 const std::vector<std::int64_t>* ids) {
    write(paths.old_to_new, layout, new_numbers);
    write(paths.new_to_old, layout, inverse(communicator_, layout, new_numbers));
    if (ids != nullptr) write(paths.ids, layout, *ids, false);
  }

  std::vector<std::string> written;

 private:
  const Communicator& communicator_;
  OutputSet& outputs_;
};

}  // namespace

MeshChecksums checksums_of(const Communicator& communicator, const MeshSlice& slice) {
  Checksum points;
  points.add(slice.vertices.size());
  add_in_rank_order(communicator, points, [&] {
    for (const Point& point : slice.points) points.add(point);
  });

  const std::vector<GlobalIndex>& entries = slice.cell_vertices.entries;
  const Layout layout = Layout::of_sizes(communicator.gathered(std::ssize(entries)));
  const GlobalIndex first = layout.begin(communicator.rank());
  Checksum cells;
  cells.add(slice.cells.size() + 1);
  cells.add(GlobalIndex{0});
  add_in_rank_order(communicator, cells, [&] {
    for (std::size_t c = 1; c < slice.cell_vertices.offsets.size(); ++c)
      cells.add(first + slice.cell_vertices.offsets[c]);
  });
  cells.add(layout.size());
  add_in_rank_order(communicator, cells, [&] {
    for (const GlobalIndex vertex : entries) cells.add(vertex);
  });
  return {points.value(), cells.value()};
}

std::vector<std::string> write_sliced_maps(const Communicator& communicator, const SlicedOrder& order,
                                           const MeshChecksums& before, const MeshSlice& after,
                                           const std::string& prefix, OutputSet& outputs) {
  const MapPaths vertices = map_paths(prefix, "vertices");
  const MapPaths cells = map_paths(prefix, "cells");
  MapWriter maps(communicator, outputs);
  maps.write_all(vertices, after.vertices, order.new_vertices, order.vertex_ids);
  maps.write_all(cells, after.cells, order.new_cells, order.cell_ids);

  const int rank = communicator.rank();
  std::vector<GlobalIndex> parts;
  for (GlobalIndex v = after.vertices.begin(rank); v < after.vertices.end(rank); ++v)
    parts.push_back(distributed::part_of(v, order.part_starts));
  maps.write(vertices.parts, after.vertices, parts);
  parts.clear();
  for (Offset c = 0; c < after.cell_vertices.size(); ++c)
    parts.push_back(distributed::part_of_cell(after.cell_vertices[c], order.part_starts));
  maps.write(cells.parts, after.cells, parts);

  Checksum none;
  none.add(0);
  const auto checksum_of_ids = [&](const Layout& layout, const std::vector<std::int64_t>* ids) {
    return ids == nullptr ? none.value() : checksum_of(communicator, layout, *ids);
  };
  const MapChecksums of_maps{checksum_of(communicator, after.vertices, order.new_vertices),
                             checksum_of(communicator, after.cells, order.new_cells),
                             checksum_of_ids(after.vertices, order.vertex_ids),
                             checksum_of_ids(after.cells, order.cell_ids), none.value()};
  const MeshChecksums of_mesh = checksums_of(communicator, after);
  communicator.at_root([&] {
    remove_other_maps(prefix, outputs);
    maps.written.push_back(write_identity(before, of_mesh, of_maps, prefix, outputs));
  });
  return std::move(maps.written);
}

}  // namespace meshorder::command
