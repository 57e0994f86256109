// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/stream/scanner.hpp"
#include "io/vtk/vtk.hpp"
#include "io/xml.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder::vtk {

/// Returns the text of an XML entity, such as "lt" or "#65"; empty if there is no such entity.
std::string entity(std::string_view name);

/// Returns the bytes of header words of an array, such as its size, in the file's byte order.
std::string vtu_words(const std::vector<std::uint64_t>& values, const VtuEncoding& encoding);

struct VtuAttribute {
  std::string name;
  std::string value;
  // position and size of the value in the file, in bytes
  std::size_t at = 0;
  std::size_t size = 0;
};

/// An element of a .vtu file.
struct VtuElement {
  std::string name;
  std::vector<VtuAttribute> attributes;
  std::size_t at = 0;     ///< position of its < in the file, in bytes
  std::size_t end = 0;    ///< end of its end tag, or of its start tag while the element is parsed
  std::string_view text;  ///< its first text that is not blank, up to the next child or comment
  std::vector<VtuElement> children;

  /// Returns an attribute, or nullptr.
  [[nodiscard]] const VtuAttribute* find(std::string_view wanted) const;
  /// Returns the value of an attribute, or nullptr.
  [[nodiscard]] const std::string* attribute(std::string_view wanted) const {
    const VtuAttribute* const found = find(wanted);
    return found == nullptr ? nullptr : &found->value;
  }
  /// Returns the value of an attribute; empty if it is missing.
  [[nodiscard]] std::string_view text_of(std::string_view wanted) const {
    const std::string* const value = attribute(wanted);
    return value == nullptr ? std::string_view() : *value;
  }
  /// Returns the index of the array's number type in Values; for an unknown type, the number of types.
  [[nodiscard]] std::size_t number_type() const {
    return static_cast<std::size_t>(std::find(kXmlTypeNames.begin(), kXmlTypeNames.end(), text_of("type")) -
                                    kXmlTypeNames.begin());
  }
  /// Returns the first child of that name, or nullptr.
  [[nodiscard]] const VtuElement* child(std::string_view wanted) const;
};

/// A parsed .vtu file: its elements and the bytes of its arrays.
class VtuDocument {
 public:
  /// Throws InputError unless the file is a sound and supported file of the type UnstructuredGrid or
  /// PUnstructuredGrid.
  explicit VtuDocument(const FilePath& path);

  /// Returns whether the file is a .pvtu file, which lists pieces.
  [[nodiscard]] bool lists_pieces() const { return *root_.attribute("type") == "PUnstructuredGrid"; }

  [[nodiscard]] const VtuElement& root() const noexcept { return root_; }
  [[nodiscard]] const VtuEncoding& encoding() const noexcept { return encoding_; }
  /// Returns ten times the file's version.
  [[nodiscard]] int version() const noexcept { return version_; }

  /// Returns an InputError at the line of an element.
  [[nodiscard]] InputError error(const VtuElement& at, const std::string& what,
                                 const std::string& remedy) const {
    return error_at(at.at, what, remedy);
  }

  /// Returns an element verbatim.
  [[nodiscard]] std::string source(const VtuElement& element) const {
    return std::string(scanner_.all().substr(element.at, element.end - element.at));
  }

  /// Returns the value of an attribute. Throws InputError if it is missing.
  [[nodiscard]] const std::string& required(const VtuElement& element, std::string_view name) const;
  /// Returns the count in an attribute, 0 … `most`; `most` is kMaxIndex or the highest 64-bit number.
  [[nodiscard]] std::int64_t count(const VtuElement& element, std::string_view name,
                                   std::int64_t most = kMaxIndex) const;
  /// Returns how many numbers a row of an array has.
  [[nodiscard]] std::int64_t components(const VtuElement& array) const;

  /// Throws Error if allocating `bytes` for an array would exceed the memory limit.
  void claim(const VtuElement& array, std::uint64_t bytes) const;
  /// Returns the `count` values of an array in its number type. Throws Error if the array is damaged or has
  /// more or fewer values; allocates no more than the size of the file allows.
  [[nodiscard]] Values values(const VtuElement& array, std::int64_t count) const;
  /// Returns the number of values that an array of numbers has. O(length of its text or base64).
  [[nodiscard]] std::int64_t value_count(const VtuElement& array) const;
  /// Returns how that array is stored.
  [[nodiscard]] VtuEncoding::Mode mode(const VtuElement& array) const;

 private:
  struct Stored;
  [[nodiscard]] InputError error_at(std::size_t byte, const std::string& what,
                                    const std::string& remedy) const;
  void parse();
  void read_root();
  std::size_t parse_tag(std::size_t at, VtuElement& element, bool& closed) const;
  void begin_appended(const VtuElement& element, std::size_t end);
  [[nodiscard]] Values no_values(const VtuElement& array) const;
  template <class Number>
  std::vector<Number> numbers(const VtuElement& array, std::int64_t count) const;
  template <class Number>
  std::vector<Number> words(const VtuElement& array, std::int64_t count) const;
  [[nodiscard]] std::vector<std::uint8_t> bits(const VtuElement& array, std::int64_t count) const;
  [[nodiscard]] std::vector<std::string> strings(const VtuElement& array, std::int64_t count) const;
  [[nodiscard]] Stored locate(const VtuElement& array) const;
  void locate_blocks(const VtuElement& array, std::string_view data, bool coded, Stored& stored) const;
  void copy(const VtuElement& array, const Stored& stored, char* target) const;
  [[nodiscard]] std::string base64(const VtuElement& array, std::string_view text, std::uint64_t bytes) const;
  [[nodiscard]] std::uint64_t header_word(std::string_view bytes, std::size_t index) const;
  [[nodiscard]] std::size_t header_size() const noexcept { return encoding_.wide_headers ? 8 : 4; }

  Scanner scanner_;
  VtuElement root_;
  VtuEncoding encoding_;
  int version_ = 0;
  std::optional<std::string_view> appended_;  // appended data after the underscore
  bool appended_base64_ = false;
};

}  // namespace meshorder::vtk
