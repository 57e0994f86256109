// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/files/file_slices.hpp"

#include "base/checksum.hpp"
#include "cells/cell_arrays.hpp"
#include "distributed/comm/halo.hpp"
#include "distributed/comm/number_types.hpp"
#include "distributed/files/file_rows.hpp"
#include "distributed/files/shared_file.hpp"
#include "distributed/files/slice_reader.hpp"
#include "distributed/order/cell_order.hpp"
#include "io/vtk/vtk.hpp"
#include "io/vtk/vtu_compressor.hpp"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <span>
#include <system_error>
#include <utility>

namespace meshorder::distributed {
namespace {

constexpr Offset kChunk = Offset{1} << 24;  // bytes that are copied at a time

/// Copies bytes begin … end − 1 of a file to another; only the root copies.
void copy_bytes(const Communicator& communicator, const SharedFile& in, Offset begin, Offset end,
                const SharedFile& out, Offset to) {
  std::vector<std::byte> bytes;
  for (Offset at = begin; at < end; at += kChunk) {
    if (communicator.is_root()) bytes.resize(static_cast<std::size_t>(std::min(kChunk, end - at)));
    in.read(at, bytes);
    out.write(to + at - begin, bytes);
  }
}

/// Maps places in an old file to places in a new one.
class NewPlaces {
 public:
  /// Takes the first byte after the XML in each file.
  NewPlaces(Offset old_begin, Offset new_begin) : moves_{{old_begin, new_begin}} {}

  /// Adds a move: bytes of the old file from `old_begin` on, up to the next move, are in the new file from
  /// `new_begin` on. Calls must ascend.
  void add(Offset old_begin, Offset new_begin) { moves_.emplace_back(old_begin, new_begin); }

  /// Returns the first byte after the XML in the new file.
  [[nodiscard]] Offset first_byte() const { return moves_.front().second; }
  /// Returns the new offset for an old one. O(log arrays).
  [[nodiscard]] Offset of_offset(Offset old) const {
    const Offset at = moves_.front().first + old;
    const auto behind = std::upper_bound(moves_.begin(), moves_.end(), at,
                                         [](Offset byte, const auto& move) { return byte < move.first; });
    const auto& [old_begin, new_begin] = *(behind - 1);
    return new_begin + at - old_begin - first_byte();
  }

 private:
  std::vector<std::pair<Offset, Offset>> moves_;  ///< ascending
};

/// Returns, on all ranks, the checksum that both files of an XDMF mesh contain. It equals the checksum that
/// the writer of whole meshes computes.
std::uint64_t checksum_of_xdmf(const Communicator& communicator, GlobalIndex vertices, const FilePart& part,
                               const std::vector<std::byte>& points, const Rows& cells) {
  Checksum sum;
  sum.add(vertices);
  add_in_rank_order(communicator, sum, [&] {
    const std::vector<double> coordinates = numbers_of<double>(points, part.type);
    const auto width = static_cast<std::size_t>(part.components);
    for (std::size_t k = 0; k < coordinates.size(); k += width) {
      Point point{};
      for (std::size_t x = 0; x < width; ++x) point[x] = coordinates[k + x];
      sum.add(point);
    }
  });
  add_in_rank_order(communicator, sum, [&] {
    for (Offset c = 0; c < cells.size(); ++c) sum.add_all(cells[c]);
  });
  return sum.value();
}

}  // namespace

std::optional<FileSlices> FileSlices::open(const Communicator& communicator, const std::string& path) {
  std::optional<FileHead> at_root = communicator.at_root([&]() -> std::optional<FileHead> {
    std::error_code code;
    if (!std::filesystem::is_regular_file(path, code)) return std::nullopt;  // a pipe is read once
    return read_head(path, communicator.size());
  });
  const std::vector<FileFacts> facts =
      communicator.broadcast(at_root ? std::vector<FileFacts>{at_root->facts} : std::vector<FileFacts>{});
  if (facts.empty()) return std::nullopt;
  FileSlices slices;
  FileHead& head = slices.head_;
  if (at_root) head = *std::move(at_root);
  head.facts = facts.front();
  slices.path_ = communicator.broadcast(std::vector{head.data.empty() ? path : head.data}).front();
  head.parts = communicator.broadcast(std::move(head.parts));
  head.names = communicator.broadcast(head.names);
  head.blocks.resize(head.parts.size());
  return slices;
}

MeshSlice FileSlices::read(const Communicator& communicator) const {
  const SliceReader reader(communicator, path_, head_);
  MeshSlice slice = reader.empty_slice();
  reader.read_points(slice);
  reader.read_shapes(slice);
  reader.read_cells(slice);
  return slice;
}

bool FileSlices::has_nodes_as_a_mesh(const Communicator& communicator) const {
  if (head_.facts.kind == FileFacts::Kind::xdmf) return true;  // `open` refuses other .xdmf files
  const std::vector<int> numbers = SliceReader(communicator, path_, head_).types();
  const auto other = std::count_if(numbers.begin(), numbers.end(), [](int type) {
    return type >= 0 && type < 256 && vtk::may_be_reordered(static_cast<std::uint8_t>(type));
  });
  return communicator.sum(static_cast<GlobalIndex>(other)) == 0;
}

std::string FileSlices::new_data(const Communicator& communicator, const std::string& name) const {
  if (head_.facts.kind != FileFacts::Kind::xdmf) return {};
  return communicator.broadcast(communicator.at_root([&] { return std::vector{head_.files->data_of(name)}; }))
      .front();
}

std::vector<Offset> FileSlices::new_places(const Communicator& communicator, const SliceFile& file) const {
  return communicator.broadcast(communicator.at_root(
      [&] { return head_.files->places_in(file.data, head_.files->data_of(file.name)); }));
}

FileSlices FileSlices::written(const Communicator& communicator, const SliceFile& file) const {
  if (head_.facts.kind != FileFacts::Kind::xdmf) return *open(communicator, file.path);
  FileSlices result = *this;
  result.path_ = file.data;
  const std::vector<Offset> places = new_places(communicator, file);
  for (FilePart& part : result.head_.parts) part.at = places[part.number];
  return result;
}

std::vector<GlobalIndex> FileSlices::write(const Communicator& communicator, const SliceFile& file,
                                           const DistributedOrder& order) const {
  if (head_.facts.kind == FileFacts::Kind::xdmf) return write_xdmf(communicator, file, order);
  SharedFile out(communicator, file.path, file.name, SharedFile::Use::write);
  MovedFile moved(communicator, path_, head_, order);
  const SharedFile& in = moved.reader().file();

  // write the XML last: it has the offsets of arrays whose compressed sizes are not known yet
  const bool is_vtkhdf = head_.facts.kind == FileFacts::Kind::vtkhdf;
  const bool is_raw = head_.facts.encoding.compressor == VtuEncoding::Compressor::none;
  Offset from = head_.facts.first_byte;
  Offset to = communicator.broadcast(std::vector<Offset>{is_raw ? from : head_.xml.most_bytes()}).front();
  NewPlaces places(from, to);
  for (const FilePart& part : head_.parts) {
    copy_bytes(communicator, in, from, part.at, out, to);
    to += part.at - from;
    from = part.at + part.stored;
    std::vector<std::byte> values = moved.rows(part);
    places.add(part.at, to);
    to += is_vtkhdf ? write_raw(communicator, out, to, values)
                    : write_values(communicator, out, head_.facts.encoding, to, std::move(values),
                                   vtk::VtuCompressor::kBlock);
    places.add(from, to);
  }
  copy_bytes(communicator, in, from, head_.facts.bytes, out, to);
  const std::string xml = communicator.at_root([&] {
    if (is_vtkhdf) return std::string();
    return head_.xml.with_offsets([&](Offset offset) { return places.of_offset(offset); },
                                  places.first_byte());
  });
  out.write(0, std::as_bytes(std::span(xml)));
  out.close();
  return moved.new_cells();
}

std::vector<GlobalIndex> FileSlices::write_xdmf(const Communicator& communicator, const SliceFile& file,
                                                const DistributedOrder& order) const {
  MovedFile moved(communicator, path_, head_, order);
  // compute the checksum first, because both files begin with it
  const FilePart& points = moved.reader().part(FilePart::Role::points);
  const std::vector<std::byte> moved_points = moved.rows(points);
  const std::uint64_t checksum =
      checksum_of_xdmf(communicator, head_.facts.vertices, points, moved_points, moved.cells());
  const std::string xml =
      communicator.at_root([&] { return head_.files->write_without_values(file.name, file.data, checksum); });
  const std::vector<Offset> places = new_places(communicator, file);

  SharedFile data(communicator, file.data, new_data(communicator, file.name), SharedFile::Use::write);
  for (const FilePart& part : head_.parts) {
    const bool are_points = part.role == FilePart::Role::points;
    write_raw(communicator, data, places[part.number], are_points ? moved_points : moved.rows(part));
  }
  data.close();
  SharedFile document(communicator, file.path, file.name, SharedFile::Use::write);
  document.write(0, std::as_bytes(std::span(xml)));
  document.close();
  return moved.new_cells();
}

}  // namespace meshorder::distributed
