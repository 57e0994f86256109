// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/files/file_slices.hpp"

#include "distributed/files/slice_reader.hpp"
#include "io/vtk/vtk.hpp"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <system_error>
#include <utility>

namespace meshorder::distributed {

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

}  // namespace meshorder::distributed
