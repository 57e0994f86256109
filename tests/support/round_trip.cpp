// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "support/round_trip.hpp"

#include <algorithm>
#include <span>
#include <string>
#include <string_view>

namespace meshorder::test {

Written written_as(const Mesh& mesh, const Format& format) {
  Written result;
  result.files =
      write_mesh_to_memory(mesh, format.key(), "a" + std::string(format.extensions.front()), &result.notes)
          .files;
  return result;
}

Mesh read_back(const std::vector<MemoryFile>& files, const Format& format) {
  const auto companion = [&](std::string_view name) {
    const auto found =
        std::find_if(files.begin(), files.end(), [&](const MemoryFile& file) { return file.name == name; });
    return found == files.end() ? std::string() : found->bytes;
  };
  const MemoryFile& first = files.front();
  return read_mesh(std::as_bytes(std::span(first.bytes)),
                   {.format = format.key(), .name = first.name, .companion = companion});
}

}  // namespace meshorder::test
