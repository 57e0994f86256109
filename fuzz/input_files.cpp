// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "fuzz/input_files.hpp"

#include <algorithm>

namespace meshorder::fuzz {
namespace {

constexpr std::string_view kMark = "\n%%file ";

}  // namespace

std::vector<MemoryFile> input_files(std::string_view input, const std::string& first) {
  std::vector<MemoryFile> files;
  std::string name = first;
  while (true) {
    const auto end = input.find(kMark);
    files.push_back({name, std::string(input.substr(0, end))});
    if (end == std::string_view::npos) return files;
    input.remove_prefix(end + kMark.size());
    const auto line_end = std::min(input.find('\n'), input.size());
    name = input.substr(0, line_end);
    input.remove_prefix(std::min(line_end + 1, input.size()));
  }
}

std::string input_of(const std::vector<MemoryFile>& files) {
  std::string input;
  for (const MemoryFile& file : files) {
    if (&file != &files.front()) input.append(kMark).append(file.name).append("\n");
    input += file.bytes;
  }
  return input;
}

std::string bytes_of(const std::vector<MemoryFile>& files, std::string_view name) {
  const auto found =
      std::find_if(files.begin(), files.end(), [&](const MemoryFile& file) { return file.name == name; });
  return found == files.end() ? std::string() : found->bytes;
}

}  // namespace meshorder::fuzz
