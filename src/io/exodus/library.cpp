// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/exodus/library.hpp"

#include "io/exodus/netcdf_library.hpp"
#include <meshorder/error.hpp>

#include <unistd.h>

#ifdef MESHORDER_HAS_HDF5
#include "io/hdf5/hdf5_file.hpp"
#include "io/hdf5/parts.hpp"
#include "io/hdf5/session.hpp"

#include <fmt/format.h>
#endif

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>
#include <vector>

namespace meshorder::exodus {
namespace {

/// Starts libnetcdf with environment variables that keep the library from finding settings. Only the pointer
/// `environ` changes, and only during this call: other threads may read variables meanwhile.
void start_library() {
  static std::array settings{std::string("NCRCENV_IGNORE=1"), std::string("NC_TEST_AWS_DIR=/dev/null"),
                             std::string("HOME=/dev/null"), std::string("AWS_CONFIG_FILE=/dev/null"),
                             std::string("AWS_SHARED_CREDENTIALS_FILE=/dev/null")};
  static std::vector<char*> variables;
  variables.reserve(settings.size());
  for (std::string& setting : settings) variables.push_back(setting.data());
  for (char** variable = ::environ; variable != nullptr && *variable != nullptr; ++variable) {
    const std::string_view text(*variable);
    const std::string_view name = text.substr(0, text.find('='));
    const bool is_set = std::any_of(settings.begin(), settings.end(), [&](const std::string& setting) {
      return std::string_view(setting).substr(0, setting.find('=')) == name;
    });
    if (!is_set && name != "NCRCENV_RC" && name != "NCRCENV_HOME") variables.push_back(*variable);
  }
  variables.push_back(nullptr);
  char** const own = std::exchange(::environ, variables.data());
  (void)nc_initialize();
  ::environ = own;
}

}  // namespace

void load_library() {
#ifdef MESHORDER_NETCDF_FILE
  kNetcdf.load();
#endif
#ifdef MESHORDER_HAS_HDF5
  hdf5::load_library();
#endif
}

#ifdef MESHORDER_HAS_HDF5
Library::Library() : lock_(hdf5::enter_library()) {
  H5PLget_loading_state(&plugins_);
  H5PLset_loading_state(0);
  static const bool is_started = (start_library(), true);
  (void)is_started;
}

Library::~Library() { H5PLset_loading_state(plugins_); }

void require_whole_hdf5(const std::string& path, const std::string& bytes, const std::string& name) {
  const hdf5::Session session;
  const hdf5::File file = path.empty() ? hdf5::File::in_memory(bytes, name) : hdf5::File::open(path, name);
  const hdf5::Handle root(H5Gopen2(file.id(), "/", H5P_DEFAULT), H5Gclose);
  for (const std::string& entry : hdf5::names_in(root.id())) {
    const auto refuse = [&](std::string_view what, const char* remedy) {
      throw InputError(name, fmt::format("'{}' {}", entry, what), remedy);
    };
    H5L_info_t link;
    if (H5Lget_info(root.id(), entry.c_str(), &link, H5P_DEFAULT) < 0)
      refuse("cannot be read", "the file may be damaged");
    if (link.type != H5L_TYPE_HARD && link.type != H5L_TYPE_SOFT)
      refuse("is a link to another file, which is not followed", "copy all into one file (h5copy)");
    if (link.type != H5L_TYPE_HARD) continue;
    const hdf5::Handle object(H5Oopen(root.id(), entry.c_str(), H5P_DEFAULT), H5Oclose);
    const H5I_type_t kind = H5Iget_type(object.id());
    if (kind == H5I_GROUP) refuse("is a group", "a mesh is in the file itself; take the group out");
    if (kind == H5I_DATASET && hdf5::has_values_elsewhere(object.id()))
      refuse("has its values in other files", "copy them into one file (h5repack)");
  }
}
#else
Library::Library() : lock_(hdf5::enter_library()) {
  static const bool is_started = (start_library(), true);
  (void)is_started;
}

Library::~Library() = default;

void require_whole_hdf5(const std::string& /*path*/, const std::string& /*bytes*/, const std::string& name) {
  throw Unavailable(name +
                    ": is a file of HDF5, for which this build lacks the library; build with "
                    "-DMESHORDER_HDF5=ON");
}
#endif

}  // namespace meshorder::exodus
