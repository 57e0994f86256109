// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/files/file_head.hpp"

#include "base/input_file.hpp"
#include "distributed/comm/number_types.hpp"
#include "distributed/files/mold.hpp"
#include "io/stream/file_path.hpp"
#include "io/stream/read_limits.hpp"
#ifdef MESHORDER_HAS_HDF5
#include "io/vtkhdf/vtkhdf.hpp"
#endif
#ifdef MESHORDER_HAS_XDMF
#include "io/xdmf/raw.hpp"
#endif

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>
#include <utility>

namespace meshorder::distributed {
namespace {

bool is_hdf5(const std::string& path) {
  constexpr std::string_view kSignature = "\x89HDF\r\n\x1a\n";
  std::array<char, kSignature.size()> start{};
  (void)InputFile(path).read(start);
  return std::string_view(start.data(), start.size()) == kSignature;
}

#ifdef MESHORDER_HAS_HDF5
/// Returns the head of a file whose parts are in an HDF5 file; nothing if parts overlap or exceed that file.
std::optional<FileHead> head_of(FileFacts::Kind kind, FileLayout layout, const std::string& path) {
  FileHead head;
  head.path = path;
  static_cast<FileSizes&>(head.facts) = static_cast<const FileSizes&>(layout);
  head.facts.kind = kind;
  head.facts.bytes = static_cast<Offset>(std::filesystem::file_size(path));
  head.parts = std::move(layout.parts);
  head.names = std::move(layout.names);
  head.blocks.resize(head.parts.size());
  if (!sort_by_bytes(head.parts, head.facts.bytes)) return std::nullopt;
  return head;
}

/// Returns whether the first of a file's offsets is 0; the part `offsets` begins with the second offset.
bool begins_at_zero(const std::string& path, const FilePart& offsets) {
  std::vector<std::byte> first(static_cast<std::size_t>(offsets.row_size()));
  const std::size_t got = InputFile(path).read_at(static_cast<std::uint64_t>(offsets.at - offsets.row_size()),
                                                  {reinterpret_cast<char*>(first.data()), first.size()});
  return got == first.size() && numbers_of<Offset>(first, offsets.type).front() == 0;
}

std::optional<FileHead> read_vtkhdf_head(const std::string& path) {
  constexpr Index kMostOfRow = Index{1} << 24;
  const FilePath file(path);
  const ReadScope scope(file);
  std::optional<vtkhdf::RawGrid> grid = vtkhdf::find_raw(file);
  if (!grid) return std::nullopt;
  const FileLayout& layout = grid->layout;
  if (layout.vertices == 0 || layout.cells == 0 || layout.entries == 0) return std::nullopt;
  std::vector<DataArray> rows;
  for (const FilePart& part : layout.parts) {
    if (part.components > kMostOfRow) return std::nullopt;
    if (part.role == FilePart::Role::offsets && !begins_at_zero(path, part)) return std::nullopt;
    if (part.role == FilePart::Role::points) grid->metadata.float_points = part.type == 1;
    if (part.role == FilePart::Role::data)
      rows.push_back(blank_row(layout.names[part.number], part.association, part.type, part.components));
  }
  Notes ignored;  // notes on names that XML cannot hold
  std::string mold = mold_of(std::move(rows), grid->metadata, true, ignored);
  std::optional<FileHead> head = head_of(FileFacts::Kind::vtkhdf, std::move(grid->layout), path);
  if (head) head->mold = std::move(mold);
  return head;
}
#else
std::optional<FileHead> read_vtkhdf_head(const std::string& /*path*/) { return std::nullopt; }
#endif

#ifdef MESHORDER_HAS_XDMF
std::optional<FileHead> read_xdmf_head(const std::string& path) {
  const FilePath file(path);
  const ReadScope scope(file);
  std::optional<xdmf::RawGrid> grid = xdmf::find_raw(file);
  if (!grid) return std::nullopt;
  std::optional<FileHead> head = head_of(FileFacts::Kind::xdmf, std::move(grid->layout), grid->data);
  if (head) head->files = std::move(grid->files);
  return head;
}
#else
std::optional<FileHead> read_xdmf_head(const std::string& /*path*/) { return std::nullopt; }
#endif

}  // namespace

bool is_xdmf(const std::string& path) {
  const std::filesystem::path extension = std::filesystem::path(path).extension();
  return extension == ".xdmf" || extension == ".xmf";
}

std::optional<FileHead> read_head(const std::string& path, int ranks) {
  std::optional<FileHead> head = is_xdmf(path)   ? read_xdmf_head(path)
                                 : is_hdf5(path) ? read_vtkhdf_head(path)
                                                 : read_vtu_head(path, ranks);
  if (!head) return std::nullopt;
  for (std::string& name : head->names) {
    constexpr std::size_t kLongest = 40;
    name.resize(std::min(name.size(), kLongest));
    std::replace_if(
        name.begin(), name.end(), [](char c) { return static_cast<unsigned char>(c) < ' '; }, '?');
  }
  return head;
}

bool sort_by_bytes(std::vector<FilePart>& parts, Offset bytes) {
  std::sort(parts.begin(), parts.end(), [](const FilePart& a, const FilePart& b) { return a.at < b.at; });
  Offset before = 0;
  return std::all_of(parts.begin(), parts.end(), [&](const FilePart& part) {
    const bool is_free = part.at >= before && part.at <= bytes - part.stored;
    before = part.at + part.stored;
    return is_free;
  });
}

}  // namespace meshorder::distributed
