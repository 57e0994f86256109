// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/stream/private_folder.hpp"

#include "io/stream/system_fault.hpp"

#include <stdlib.h>  // NOLINT(modernize-deprecated-headers): mkdtemp is POSIX's

#include <cerrno>
#include <string>
#include <system_error>

namespace meshorder {

namespace fs = std::filesystem;

PrivateFolder::PrivateFolder() {
  std::string name = (fs::temp_directory_path() / "meshorder-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) {
    throw_system_fault(name, "the folder for temporary files cannot be made", errno);
  }
  path_ = name;
}

PrivateFolder::~PrivateFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

}  // namespace meshorder
