// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/input_file.hpp"
#include "distributed/comm/layout.hpp"
#include "io/file_layout.hpp"
#include "io/vtk/vtu_document.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace meshorder::distributed {

/// The XML of a .vtu file up to the underscore before its appended data, and the offsets of the arrays in
/// these data.
class VtuXml {
 public:
  VtuXml() = default;

  /// @param text  text of the file, up to and including the underscore
  /// @param file  the parsed file
  /// @throws InputError for an offset that is no integer ≥ 0
  VtuXml(std::string text, const vtk::VtuDocument& file);

  [[nodiscard]] const std::string& text() const noexcept { return text_; }

  /// Returns the offsets in the order in which they occur in the text.
  [[nodiscard]] std::vector<Offset> offsets() const;

  /// Returns the maximum size of the text with any other offsets, in bytes. The result is the same for a text
  /// that `with_offsets` has padded to this size.
  [[nodiscard]] Offset most_bytes() const;

  /// Returns the text with other offsets, padded with blanks before the underscore.
  ///
  /// @param moved  returns the new offset for an old one
  /// @param bytes  size of the result: that of the text if no offset changes, else `most_bytes`
  [[nodiscard]] std::string with_offsets(const std::function<Offset(Offset)>& moved, Offset bytes) const;

 private:
  struct Place {
    std::size_t at;    ///< position of the first digit in the text
    std::size_t size;  ///< number of digits
    Offset offset;
  };

  void add_places(const vtk::VtuDocument& file, const vtk::VtuElement& element);

  std::string text_;
  std::vector<Place> places_;
};

/// Finds arrays in the raw appended data of a .vtu file. Words before each array give its size.
class AppendedArrays {
 public:
  /// @param path        path of the file
  /// @param document    its XML; must outlive this object
  /// @param first_byte  first byte of the appended data in the file
  /// @param ranks       number of ranks that share the memory of uncompressed arrays
  /// @throws InputError if the file cannot be opened
  AppendedArrays(const std::string& path, const vtk::VtuDocument& document, Offset first_byte, int ranks);

  /// Finds the bytes and the blocks of the array that an XML element describes. Returns the uncompressed size
  /// of the array, in bytes. O(blocks) time.
  ///
  /// @param bounds  receives the first byte of each compressed block, then the end of the last
  /// @throws Error for a damaged or truncated array, and if the memory limit is exceeded
  Offset place(const vtk::VtuElement& element, FilePart& part, std::vector<Offset>& bounds);

 private:
  [[nodiscard]] std::vector<std::uint64_t> words(const vtk::VtuElement& element, const std::string& what,
                                                 std::uint64_t count);
  std::uint64_t place_bytes(const vtk::VtuElement& element, const std::string& what, FilePart& part);
  std::uint64_t place_blocks(const vtk::VtuElement& element, const std::string& what, FilePart& part,
                             std::vector<Offset>& bounds);

  InputFile file_;
  const vtk::VtuDocument& document_;
  Offset bytes_;  ///< size of the file
  Offset first_byte_;
  int ranks_;
  std::size_t word_;  ///< bytes of a word before an array
  Offset at_ = 0;     ///< position of the next byte to read
};

}  // namespace meshorder::distributed
