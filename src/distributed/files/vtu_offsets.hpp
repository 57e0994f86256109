// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/layout.hpp"
#include "io/vtk/vtu_document.hpp"

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace meshorder::distributed {

/// The XML of a .vtu file up to the underscore before its appended data, with the offsets of the arrays
/// there.
class VtuXml {
 public:
  VtuXml() = default;

  /// @param text  of the file, up to and including the underscore
  /// @param file  the parsed file
  /// @throws InputError for an offset that is no integer ≥ 0
  VtuXml(std::string text, const vtk::VtuDocument& file);

  [[nodiscard]] const std::string& text() const noexcept { return text_; }

  /// Returns the offsets, in the sequence of the text.
  [[nodiscard]] std::vector<Offset> offsets() const;

  /// Returns the most bytes that the text can have with other offsets. The number stays the same for a text
  /// that `with_offsets` has padded to this size.
  [[nodiscard]] Offset most_bytes() const;

  /// Returns the text with other offsets, padded with blanks before the underscore.
  ///
  /// @param moved  returns the new offset for an old one
  /// @param bytes  size of the result: that of the text if no offset changes, else `most_bytes`
  [[nodiscard]] std::string with_offsets(const std::function<Offset(Offset)>& moved, Offset bytes) const;

 private:
  struct Place {
    std::size_t at;    ///< place of the first digit in the text
    std::size_t size;  ///< number of digits
    Offset offset;
  };

  void add_places(const vtk::VtuDocument& file, const vtk::VtuElement& element);

  std::string text_;
  std::vector<Place> places_;
};

/// Returns the count in an attribute, or `otherwise` if there is no such attribute and `otherwise` ≥ 0.
///
/// @throws InputError for a value that is no integer ≥ 0, and for a missing attribute if `otherwise` < 0
[[nodiscard]] Offset whole_number(const vtk::VtuDocument& file, const vtk::VtuElement& element,
                                  std::string_view name, Offset otherwise = -1);

}  // namespace meshorder::distributed
