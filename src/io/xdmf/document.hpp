// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/stream/file_path.hpp"
#include "io/xml.hpp"
#include <meshorder/error.hpp>

#include <pugixml.hpp>

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace meshorder::xdmf {

/// Name of the mark that an .xdmf file and its HDF5 files get when they are written together: a processing
/// instruction in the root element, and an attribute of the root group of each HDF5 file. All have the same
/// 16 digits; the reader refuses files with different digits.
inline constexpr const char* kMark = "meshorder";
/// A plain binary file has no room for a mark. Instead, the DataItem that names the file has a checksum of
/// the values, in an attribute of this name.
inline constexpr const char* kValueMark = "MeshorderChecksum";

/// Returns whether a child of the root element is the processing instruction `kMark`.
bool is_mark(pugi::xml_node node);

/// The XML of an XDMF file.
class Document {
 public:
  /// Throws InputError unless the file is XML with the root <Xdmf>, and as `with_entities_expanded`.
  explicit Document(const FilePath& path);

  [[nodiscard]] pugi::xml_node root() const { return xml_.document_element(); }
  [[nodiscard]] const std::string& file() const noexcept { return file_; }

  /// Returns an InputError at the line of an element.
  [[nodiscard]] InputError error(pugi::xml_node at, const std::string& what, const std::string& remedy) const;

  /// Returns the whole number in an attribute, `otherwise` if the attribute is missing or empty. Throws
  /// InputError for other text.
  template <class Number>
  [[nodiscard]] Number whole_number(pugi::xml_node element, const char* name, Number otherwise) const {
    const std::string_view text = element.attribute(name).value();
    Number number = otherwise;
    if (!text.empty() && !parse_xml_number(text, number)) {
      throw error(element, std::string(name) + " is '" + std::string(text.substr(0, 40)) + "'",
                  "a whole number is needed");
    }
    return number;
  }

  /// Returns the mark that the file shares with its HDF5 files, empty if it has no mark; see `kMark`.
  [[nodiscard]] std::string_view mark() const { return root().find_child(is_mark).value(); }

  /// Returns the element that `element` refers to by Reference="…", or `element` itself.
  [[nodiscard]] pugi::xml_node resolved(pugi::xml_node element) const;
  /// Returns the child elements of a Grid, with xi:include and references resolved.
  [[nodiscard]] std::vector<pugi::xml_node> children(pugi::xml_node grid) const;
  /// Returns the number, from 0, of a DataItem among the file's DataItems, or of a Grid among its Grids.
  [[nodiscard]] std::size_t number(pugi::xml_node element) const { return numbers_.at(element.hash_value()); }
  /// Returns the DataItem of that number.
  [[nodiscard]] pugi::xml_node item(std::size_t number) const { return items_[number]; }

  /// Removes the values from the given DataItems, which must not be read afterwards; returns the XML.
  [[nodiscard]] std::string take_values_out(std::vector<std::size_t> items);

 private:
  /// Returns the text before the root element; a plain declaration if the encoding in it is not UTF-8.
  [[nodiscard]] std::string_view prolog() const;
  [[nodiscard]] const std::vector<pugi::xml_node>& selected(pugi::xml_node from, std::string path) const;

  std::string file_;
  std::string source_;
  pugi::xml_document xml_;
  std::vector<pugi::xml_node> items_;
  std::unordered_map<std::size_t, std::size_t>
      numbers_;  // numbers of DataItems and Grids, by pugixml's hash of a node
  mutable std::map<std::string, std::vector<pugi::xml_node>, std::less<>> selected_;  // results, by path
};

/// Returns all elements of a name in the order of the file.
std::vector<pugi::xml_node> elements_named(const pugi::xml_document& xml, std::string_view name);

/// Parses the XML of a layout. Throws std::bad_alloc if there is no memory.
void parse(pugi::xml_document& xml, const std::string& text);

/// Sets the text of an element; sets or adds an attribute. Both throw std::bad_alloc if there is no memory,
/// or if `element` is null because there was no memory to add it.
void set_text(pugi::xml_node element, const std::string& text);
void set_attribute(pugi::xml_node element, const char* name, const std::string& value);

/// A function that receives the next part of a text.
using TakeText = std::function<void(std::string_view part)>;

/// `print` writes `prolog` (all before the root element), then the root element with the white space that was
/// parsed. `print_indented` indents the elements instead.
void print(const pugi::xml_document& xml, std::string_view prolog, const TakeText& take);
void print_indented(const pugi::xml_document& xml, const TakeText& take);

/// Returns the value of the attribute `name` or, if it is missing, of `other_name`; empty if both are
/// missing.
std::string attribute(pugi::xml_node element, const char* name, const char* other_name = "");

/// Returns an XML text without the declarations of its DOCTYPE, with each `&NAME;` replaced by the entity
/// that was declared under that name. Lines keep their numbers. A text that declares no entities is returned
/// unchanged. Opens no file. O(length of the result).
///
/// @param file  name for messages
/// @throws InputError for references to external, undeclared and circular entities, for parameter entities,
///         for attributes with defaults, and for entities that add more than 16 MiB
std::string with_entities_expanded(std::string text, const std::string& file);

}  // namespace meshorder::xdmf
