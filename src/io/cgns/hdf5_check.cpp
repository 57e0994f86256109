// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/cgns/tree.hpp"
#include "io/hdf5/hdf5_file.hpp"
#include "io/hdf5/parts.hpp"
#include "io/hdf5/session.hpp"
#include "io/hdf5/visitor.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <array>
#include <set>
#include <utility>

// Checks an HDF5 file before libcgns reads it: libcgns trusts the file's sizes of names and data.

namespace meshorder::cgns {
namespace {

using hdf5::Handle;

constexpr int kMostLevels = 64;
constexpr std::size_t kMostLetters = 32;
constexpr std::string_view kDataSet = " data";
/// Bytes per value of each alternative of Values.
constexpr std::array<std::size_t, 10> kSizes{8, 4, 1, 1, 2, 2, 4, 4, 8, 8};

class Hdf5Check {
 public:
  Hdf5Check(const std::filesystem::path& path, std::string name)
      : name_(std::move(name)), file_(hdf5::File::open(path, name_)) {}

  void run() {
    const Handle root(H5Gopen2(file_.id(), "/", H5P_DEFAULT), H5Gclose);
    if (!root.is_open()) fail("has no root");
    check_group(root.id(), "", 0);
  }

 private:
  [[noreturn]] void fail(const std::string& what,
                         const std::string& remedy = "the file may be damaged") const {
    throw InputError(name_, what, remedy);
  }

  /// Returns an attribute's text; fails unless it is one text of at most `most` bytes, the room in
  /// libcgns.
  [[nodiscard]] std::string text_of(hid_t group, const std::string& path, const char* name,
                                    std::size_t most) const {
    const std::string what = fmt::format("{}: the attribute '{}'", path.empty() ? "/" : path, name);
    const Handle attribute(H5Aopen(group, name, H5P_DEFAULT), H5Aclose);
    if (!attribute.is_open()) {
      fail(what + " is missing", "it may be an HDF5 file other than CGNS");
    }
    const Handle type(H5Aget_type(attribute.id()), H5Tclose);
    const Handle space(H5Aget_space(attribute.id()), H5Sclose);
    const bool fits = H5Tget_class(type.id()) == H5T_STRING && H5Tis_variable_str(type.id()) == 0 &&
                      H5Tget_size(type.id()) <= most && H5Sget_simple_extent_npoints(space.id()) == 1;
    if (!fits) fail(fmt::format("{} is not a text of at most {} bytes", what, most));
    std::array<char, 34> text{};
    if (H5Aread(attribute.id(), type.id(), text.data()) < 0) fail(what + " cannot be read");
    if (std::string_view(text.data(), text.size()).find('\0') >= most) fail(what + " has no end");
    return text.data();
  }

  void check_group(hid_t group, const std::string& path, int level) {
    if (level > kMostLevels) fail(path + ": nodes are nested too deeply");
    H5O_info_t info;
    if (H5Oget_info(group, &info) < 0 || !seen_.insert(info.addr).second) {
      fail(path + " is in the file twice");
    }
    (void)text_of(group, path, "name", 33);
    (void)text_of(group, path, "label", 33);
    const std::string type = text_of(group, path, "type", 3);
    for (const std::string& name : names_in(group)) check_link(group, path, name, type, level);
  }

  [[nodiscard]] std::vector<std::string> names_in(hid_t group) const {
    std::vector<std::string> names;
    hdf5::Visitor<H5L_info_t> visitor(
        [&](hid_t /*group*/, const char* name, const H5L_info_t& /*info*/) { names.emplace_back(name); });
    const herr_t status =
        H5Literate(group, H5_INDEX_NAME, H5_ITER_INC, nullptr, decltype(visitor)::visit, &visitor);
    visitor.rethrow();
    if (status < 0) {
      fail(fmt::format("a group cannot be read ({})", hdf5::last_cause()));
    }
    return names;
  }

  void check_link(hid_t group, const std::string& parent, const std::string& name, const std::string& type,
                  int level) {
    const std::string path = parent + "/" + name;
    H5L_info_t link;
    if (H5Lget_info(group, name.c_str(), &link, H5P_DEFAULT) < 0) fail(path + " cannot be read");
    if (link.type != H5L_TYPE_HARD) {
      fail(parent + " is a link to another node", "copy all into one file with cgnsconvert -l -f IN OUT");
    }
    // H5Oget_info_by_name leaves an id open if the object is damaged
    const Handle object(H5Oopen(group, name.c_str(), H5P_DEFAULT), H5Oclose);
    if (!object.is_open()) fail(path + " cannot be read");
    const H5I_type_t kind = H5Iget_type(object.id());
    if (kind == H5I_GROUP) {
      if (name.size() > kMostLetters) fail(path + " has a name of more than 32 characters");
      check_group(object.id(), path, level + 1);
    } else if (kind == H5I_DATASET && hdf5::has_values_elsewhere(object.id())) {
      fail(path + " has its values in other files", "copy them into one file (h5repack)");
    } else if (kind == H5I_DATASET && level > 0) {
      // libcgns stores the targets of a link as datasets of characters
      const hdf5::DatasetInfo data = file_.info(path);
      if (data.shape.size() > 12) fail(path + " has more than 12 dimensions");
      if (name == kDataSet && size_of_type(type) != kSizes.at(data.alternative)) {
        fail(fmt::format("{} declares values of the type '{}' but has others", parent, type));
      }
    } else if (kind != H5I_DATASET) {
      fail(path + " is neither a group nor a dataset");
    }
  }

  std::string name_;
  hdf5::File file_;
  std::set<haddr_t> seen_;
};

}  // namespace

void check_hdf5(const std::filesystem::path& path, const std::string& name) {
  const hdf5::Session session;
  Hdf5Check(path, name).run();
}

}  // namespace meshorder::cgns
