// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// HDF5 files: values, attributes and links are changed by libhdf5 itself, so that the file stays valid.
#include "fuzz/families/families.hpp"
#include "fuzz/families/scratch.hpp"
#include "fuzz/input_files.hpp"
#include "fuzz/mutators/choice.hpp"
#include "io/hdf5/hdf5_file.hpp"
#include "io/hdf5/session.hpp"
#include "support/files.hpp"
#include <meshorder/error.hpp>

#include <algorithm>
#include <cstring>
#include <type_traits>

namespace meshorder::fuzz {
namespace {

constexpr std::string_view kSignature = "\x89HDF\r\n\x1a\n";

/// Changes one number, or lets the engine change all bytes. The number of entries stays the same.
template <class Number>
void change(std::vector<Number>& numbers, Choice& choice) {
  if constexpr (std::is_arithmetic_v<Number>) {
    if (numbers.empty()) return;
    if (choice.below(2) == 0) {
      Number& number = numbers[choice.below(numbers.size())];
      number = choice.below(2) == 0 ? static_cast<Number>(number + 1) : static_cast<Number>(number - 1);
      return;
    }
    std::string bytes(numbers.size() * sizeof(Number), '\0');
    std::memcpy(bytes.data(), numbers.data(), bytes.size());
    const std::size_t size = bytes.size();
    bytes = mutated_bytes(std::move(bytes), size);
    bytes.resize(size);
    std::memcpy(numbers.data(), bytes.data(), size);
  }
}

/// Changes a dataset of numbers. Returns false if the file has no such dataset.
bool change_values(hdf5::File& file, Choice& choice) {
  const auto datasets = file.datasets();
  if (datasets.empty()) return false;
  const std::string& path = datasets[choice.below(datasets.size())].first;
  const std::string& source = choice.below(8) == 0 ? datasets[choice.below(datasets.size())].first : path;
  const hdf5::DatasetInfo info = file.info(source);
  Values values = file.read(source);
  std::vector<std::uint64_t> shape = info.shape;
  if (source == path) {
    std::visit([&](auto& numbers) { change(numbers, choice); }, values);
    if (choice.below(16) == 0 && shape.size() > 1) std::swap(shape.front(), shape.back());
  } else {  // two datasets have the same values
    file.remove(path);
  }
  file.write(path, values, shape);
  return true;
}

/// Adds the paths of a group's objects to `paths`; limits depth and number, since links may form cycles.
void add_objects(const hdf5::File& file, const std::string& group, int depth,
                 std::vector<std::string>& paths) {
  constexpr int kDeepest = 8;
  constexpr std::size_t kMostObjects = 1000;
  if (depth == kDeepest) return;
  for (const std::string& name : file.names(group)) {
    if (paths.size() == kMostObjects) return;
    std::string path = group;
    path += '/';
    path += name;
    paths.push_back(path);
    add_objects(file, path, depth + 1, paths);
  }
}

/// Returns the name of the attribute at a position in an object's list of attributes.
std::string name_of_attribute(hid_t object, std::size_t place) {
  const hdf5::Handle attribute(
      H5Aopen_by_idx(object, ".", H5_INDEX_NAME, H5_ITER_INC, place, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  std::string name(static_cast<std::size_t>(std::max<ssize_t>(H5Aget_name(attribute.id(), 0, nullptr), 0)),
                   '\0');
  H5Aget_name(attribute.id(), name.size() + 1, name.data());
  return name;
}

/// Gives one attribute of an object the type and values of the attribute of that name in `other`, removes it
/// if `other` has no such attribute, or changes its bytes.
void change_attribute(hid_t object, hid_t other, Choice& choice) {
  const auto count = static_cast<std::size_t>(std::max(H5Aget_num_attrs(object), 0));
  if (count == 0) return;
  const std::string name = name_of_attribute(object, choice.below(count));
  const bool copies = choice.below(2) == 0;
  if (copies && H5Aexists(other, name.c_str()) <= 0) {
    H5Adelete(object, name.c_str());
    return;
  }
  const hdf5::Handle source(H5Aopen(copies ? other : object, name.c_str(), H5P_DEFAULT), H5Aclose);
  const hdf5::Handle type(H5Aget_type(source.id()), H5Tclose);
  const hdf5::Handle space(H5Aget_space(source.id()), H5Sclose);
  const H5T_class_t kind = H5Tget_class(type.id());
  const bool is_plain =
      kind == H5T_INTEGER || kind == H5T_FLOAT || (kind == H5T_STRING && H5Tis_variable_str(type.id()) == 0);
  const hssize_t values = H5Sget_simple_extent_npoints(space.id());
  if (!is_plain || values < 1 || values > 1024) return;
  const std::size_t size = H5Tget_size(type.id()) * static_cast<std::size_t>(values);
  std::string bytes(size, '\0');
  if (H5Aread(source.id(), type.id(), bytes.data()) < 0) return;
  if (!copies) {
    bytes = mutated_bytes(std::move(bytes), size);
    bytes.resize(size);
  }
  H5Adelete(object, name.c_str());
  const hdf5::Handle made(H5Acreate2(object, name.c_str(), type.id(), space.id(), H5P_DEFAULT, H5P_DEFAULT),
                          H5Aclose);
  H5Awrite(made.id(), type.id(), bytes.data());
}

/// Moves, copies, links or removes a group or dataset, or changes an attribute. A call of libhdf5 that fails
/// changes nothing, which is a mutation, too. Returns false for an empty file.
bool change_objects(hdf5::File& file, Choice& choice) {
  std::vector<std::string> paths;
  add_objects(file, "", 0, paths);
  if (paths.empty()) return false;
  const std::string one = paths[choice.below(paths.size())];
  const std::string other = paths[choice.below(paths.size())];
  const hdf5::Session session;
  const hid_t id = file.id();
  const auto move = [&](const std::string& from, const std::string& to) {
    return H5Lmove(id, from.c_str(), id, to.c_str(), H5P_DEFAULT, H5P_DEFAULT) >= 0;
  };
  switch (choice.below(7)) {
    case 0:  // the two objects exchange their paths
      if (move(one, "/exchanged")) {
        move(other, one);
        move("/exchanged", other);
      }
      break;
    case 1:
      H5Ocopy(id, one.c_str(), id, near_name(other, choice).c_str(), H5P_DEFAULT, H5P_DEFAULT);
      break;
    case 2:  // the object gets a second path
      H5Ldelete(id, other.c_str(), H5P_DEFAULT);
      H5Lcreate_hard(id, one.c_str(), id, other.c_str(), H5P_DEFAULT, H5P_DEFAULT);
      break;
    case 3:
      H5Lcreate_soft(one.c_str(), id, near_name(other, choice).c_str(), H5P_DEFAULT, H5P_DEFAULT);
      break;
    case 4:
      move(one, near_name(one, choice));
      break;
    case 5:
      H5Ldelete(id, one.c_str(), H5P_DEFAULT);
      break;
    default: {
      const hdf5::Handle object(H5Oopen(id, one.c_str(), H5P_DEFAULT), H5Oclose);
      const hdf5::Handle another(H5Oopen(id, other.c_str(), H5P_DEFAULT), H5Oclose);
      change_attribute(object.id(), another.id(), choice);
    }
  }
  return true;
}

/// Returns the changed file; an empty text if there is nothing to change.
std::string changed_file(const std::string& bytes, Choice& choice) {
  // on disk: in memory, the library computes a wrong checksum for files of some versions
  const std::filesystem::path path = scratch_file("mutated.h5", bytes);
  hdf5::File file = hdf5::File::change(path, "input");
  const bool changed = choice.below(2) == 0 ? change_values(file, choice) : change_objects(file, choice);
  file.close();
  return changed ? test::content_of(path) : std::string();
}

}  // namespace

std::string mutate_hdf5(std::string input, std::uint32_t seed) {
  Choice choice(seed);
  std::vector<MemoryFile> files = input_files(input, "first");
  const auto found = std::find_if(files.begin(), files.end(),
                                  [](const MemoryFile& file) { return file.bytes.starts_with(kSignature); });
  if (found == files.end()) return {};
  try {
    found->bytes = changed_file(found->bytes, choice);
  } catch (const Error&) {  // the file is damaged
    return {};
  }
  return found->bytes.empty() ? std::string() : input_of(files);
}

}  // namespace meshorder::fuzz
