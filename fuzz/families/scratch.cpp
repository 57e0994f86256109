// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "fuzz/families/scratch.hpp"

#include "support/files.hpp"

namespace meshorder::fuzz {

std::filesystem::path scratch_file(const std::string& name, std::string_view content) {
  static const test::TemporaryFolder folder;
  return folder.file(name, content);
}

}  // namespace meshorder::fuzz
