// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

// The nodes of a CGNS file, read and written by CGIO, the low-level interface of the CGNS library
// (https://cgns.github.io/CGNS_docs_current/cgio/). CGIO is the same for files of HDF5 and of ADF.

#include "base/input_file.hpp"
#include "io/stream/file_path.hpp"
#include <meshorder/io.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder::cgns {

/// A node with its data and children.
struct Node {
  std::string name = {};
  std::string label = {};
  std::string type = "MT";                    ///< "MT" (none), "C1", "I4", "I8", "R4", "R8" …
  std::vector<std::int64_t> dimensions = {};  ///< the first dimension varies fastest
  std::string bytes = {};                     ///< values in the machine's byte order
  std::vector<Node> children = {};
  int field = -1;  ///< index in `CgnsMetadata::fields` of the values' field; −1: `bytes` has the values

  /// Returns the number of values.
  [[nodiscard]] std::uint64_t size() const;
  /// Returns the characters of a C1 node without the padding at the end.
  [[nodiscard]] std::string text() const;
  /// Returns the first child of that label, null if there is none.
  [[nodiscard]] const Node* child_of_label(std::string_view wanted) const;
  [[nodiscard]] Node* child_of_label(std::string_view wanted);
  /// Returns the child of that name, null if there is none.
  [[nodiscard]] const Node* child(std::string_view wanted) const;
  [[nodiscard]] Node* child(std::string_view wanted);
};

/// Makes a node that holds text.
Node text_node(std::string name, std::string label, std::string_view text);
/// Makes a node that holds 32-bit integers in one dimension.
Node integer_node(std::string name, std::string label, const std::vector<std::int32_t>& values);

/// Returns the bytes per value of a type, 0 for an unknown type.
std::size_t size_of_type(std::string_view type);

/// Returns `work(zero)`, where `zero` has the C++ type for a CGNS type of numbers (double if unknown).
template <class Work>
auto with_number_of_type(std::string_view type, const Work& work) {
  if (type == "R4") return work(float{});
  if (type == "B1") return work(std::uint8_t{});
  if (type == "I4") return work(std::int32_t{});
  if (type == "U4") return work(std::uint32_t{});
  if (type == "I8") return work(std::int64_t{});
  if (type == "U8") return work(std::uint64_t{});
  return work(double{});
}

/// The kind of file that stores the nodes.
enum class Storage : std::uint8_t { hdf5, adf };

/// The nodes of a file. The root has no name.
struct Tree {
  Node root;
  Storage storage = Storage::hdf5;
};

/// Reads all nodes of a file. Throws InputError for a damaged file, for links to other nodes, and for values
/// of an unknown type.
Tree read_tree(const FilePath& path);

/// Writes a file, which appears complete or not at all. `fill` gets a copy, without children, of each node
/// that has a `field`. It sets the type, dimensions and bytes of the copy, and may change its name and label.
void write_tree(const Tree& tree, const FilePath& path, const std::function<void(Node&)>& fill);

/// Throws InputError unless libcgns can read an HDF5 file safely: each node is a group whose attributes have
/// the expected lengths, and its data are in the file. `path` is on disk, `name` is for messages.
void check_hdf5(const std::filesystem::path& path, const std::string& name);

/// Throws InputError unless libcgns can read an ADF file safely: all pointers lead to nodes, lists of
/// children and values within the file, and each node has one parent. O(nodes · log nodes).
void check_adf(const InputFile& file, const std::string& name);

}  // namespace meshorder::cgns
