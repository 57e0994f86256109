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

  /// @param text  of the file, the underscore at its end
  /// @param file  what was parsed from it
  /// @throws InputError for an offset that is no whole number from 0 on
  VtuXml(std::string text, const vtk::VtuDocument& file);

  [[nodiscard]] const std::string& text() const noexcept { return text_; }

  /// Returns the offsets, in the order of the text.
  [[nodiscard]] std::vector<Offset> offsets() const;

  /// Returns how many bytes the text may have with other offsets. No more than now, if it is itself such a
  /// text.
  [[nodiscard]] Offset most_bytes() const;

  /// Returns the text with other offsets, filled up with blanks before the underscore.
  ///
  /// @param moved  the new offset for an old one
  /// @param bytes  of the result: those of the text, if no offset changes, or `most_bytes`
  [[nodiscard]] std::string with_offsets(const std::function<Offset(Offset)>& moved, Offset bytes) const;

 private:
  struct Place {
    std::size_t at;    ///< first digit in the text
    std::size_t size;  ///< digits
    Offset offset;
  };

  void add_places(const vtk::VtuDocument& file, const vtk::VtuElement& element);

  std::string text_;
  std::vector<Place> places_;
};

/// Returns a count in an attribute; `otherwise`, unless it is negative, without the attribute.
///
/// @throws InputError for what is no whole number from 0 on, and without the attribute
[[nodiscard]] Offset whole_number(const vtk::VtuDocument& file, const vtk::VtuElement& element,
                                  std::string_view name, Offset otherwise = -1);

}  // namespace meshorder::distributed
