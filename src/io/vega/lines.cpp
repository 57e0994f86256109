// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/vega/lines.hpp"

#include "base/text.hpp"
#include "io/stream/read_limits.hpp"

namespace meshorder {

VegaLines::VegaLines(const FilePath& path) : main_(path) { open(path); }

void VegaLines::open(const FilePath& path) { files_.push_back({path, std::make_unique<Scanner>(path)}); }

bool VegaLines::peek(std::string_view& line) {
  while (true) {
    Scanner& file = at();
    if (file.bytes_left() == 0) {
      if (files_.size() == 1) return false;
      files_.pop_back();
      continue;
    }
    line = trimmed(file.peek_line());
    if (line.empty() || line.front() == '#') {
      if (!line.empty()) comments_ += std::string(line) + "\n";
      take();
      continue;
    }
    std::string_view rest = line;
    if (!same_but_for_case(next_word(rest), "*INCLUDE")) return true;
    include(std::string(trimmed(rest)));
  }
}

void VegaLines::include(const std::string& name) {
  if (name.empty()) at().fail("*INCLUDE names no file", "write *INCLUDE and a file name");
  // beside the file that includes it or, as Vega itself looks, beside the main file
  FilePath path = files_.back().path.beside(name);
  if (!path.exists()) path = main_.beside(name);
  if (!may_include(main_, path)) {
    at().fail("the included file '" + name + "' is not in the mesh's folder", kIncludeRemedy);
  }
  if (!path.is_file()) {
    at().fail("the included file '" + name + "' does not exist", "put it beside this file");
  }
  for (const OpenFile& file : files_) {
    if (file.path.is_same(path)) {
      at().fail("the included file '" + name + "' includes itself", "remove the circle");
    }
  }
  constexpr std::size_t kMostNested = 16;
  if (files_.size() > kMostNested) at().fail("files are included more than 16 deep", "join some of them");
  constexpr std::size_t kMost = 10000;
  if (included_.size() == kMost) at().fail("more than 10000 files are included", "join them");
  included_.push_back(name);
  take();
  if (!path.is_empty()) open(path);
}

}  // namespace meshorder
