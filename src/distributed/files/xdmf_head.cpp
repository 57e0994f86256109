// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/files/xdmf_head.hpp"

#include "distributed/files/raw_arrays.hpp"
#include "io/stream/file_path.hpp"
#include "io/stream/read_limits.hpp"
#ifdef MESHORDER_HAS_XDMF
#include "io/xdmf/raw.hpp"
#endif

#include <filesystem>

namespace meshorder::distributed {

bool is_xdmf(const std::string& path) {
  const std::filesystem::path extension = std::filesystem::path(path).extension();
  return extension == ".xdmf" || extension == ".xmf";
}

#ifdef MESHORDER_HAS_XDMF
namespace {

FileArray::Role role_in_xdmf(xdmf::RawDataset::Role role) {
  switch (role) {
    case xdmf::RawDataset::Role::points:
      return FileArray::Role::points;
    case xdmf::RawDataset::Role::topology:
      return FileArray::Role::connectivity;
    default:
      return FileArray::Role::data;
  }
}

}  // namespace

std::optional<FileHead> read_xdmf_head(const std::string& path) {
  const FilePath file(path);
  const ReadScope scope(file);
  const std::optional<xdmf::RawGrid> grid = xdmf::find_raw(file);
  if (!grid) return std::nullopt;
  FileHead head;
  head.facts.kind = FileFacts::Kind::xdmf;
  head.facts.shape = grid->shape;
  head.facts.bytes = static_cast<Offset>(std::filesystem::file_size(grid->data));
  for (const xdmf::RawDataset& dataset : grid->datasets) {
    const bool is_topology = dataset.role == xdmf::RawDataset::Role::topology;
    // a row of the connectivity is one entry, as in other files
    const Offset row = is_topology ? 1 : dataset.components;
    const Offset rows = is_topology ? dataset.rows * dataset.components : dataset.rows;
    FileArray array = raw_array(dataset.name, role_in_xdmf(dataset.role), dataset.association, dataset.type,
                                row, rows, static_cast<Offset>(dataset.place));
    array.element = head.arrays.size();
    head.arrays.push_back(array);
    if (dataset.role == xdmf::RawDataset::Role::points) head.facts.vertices = dataset.rows;
    if (!is_topology) continue;
    head.facts.cells = dataset.rows;
    head.facts.entries = rows;
    head.facts.nodes = dataset.components;
  }
  if (!sort_by_bytes(head.arrays, head.facts.bytes)) return std::nullopt;
  head.blocks.resize(head.arrays.size());
  head.data = grid->data.string();
  head.layout = grid->layout;
  return head;
}

std::string new_data_of_xdmf(const FileHead& head, const std::string& path) {
  return FilePath(path).beside(xdmf::name_of_data(*head.layout, path)).string();
}

std::string write_xdmf_head(const FileHead& head, const std::string& name, const std::string& data,
                            std::uint64_t checksum) {
  return xdmf::write_without_values(*head.layout, name, data, xdmf::mark_of(checksum));
}

std::vector<Offset> places_in_xdmf(const FileHead& head, const std::string& name, const std::string& data) {
  const std::vector<std::uint64_t> places =
      xdmf::places_of_values(*head.layout, data, new_data_of_xdmf(head, name));
  return {places.begin(), places.end()};
}
#else
std::optional<FileHead> read_xdmf_head(const std::string& /*path*/) { return std::nullopt; }
std::string new_data_of_xdmf(const FileHead& /*head*/, const std::string& /*path*/) { return {}; }
std::string write_xdmf_head(const FileHead& /*head*/, const std::string& /*name*/,
                            const std::string& /*data*/, std::uint64_t /*checksum*/) {
  return {};
}
std::vector<Offset> places_in_xdmf(const FileHead& /*head*/, const std::string& /*name*/,
                                   const std::string& /*data*/) {
  return {};
}
#endif

}  // namespace meshorder::distributed
