// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/vtk/vtu_document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>

namespace meshorder::vtk {
namespace {

constexpr std::size_t kDeepest = 32;

bool is_name_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == ':' ||
         c == '-' || c == '.';
}

bool is_blank(std::string_view text) { return text.find_first_not_of(kXmlBlanks) == std::string_view::npos; }

std::string unescaped(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto semicolon = text[i] == '&' ? text.substr(i, 12).find(';') : std::string_view::npos;
    const std::string character =
        semicolon == std::string_view::npos ? "" : entity(text.substr(i + 1, semicolon - 1));
    if (character.empty()) {
      result += text[i] == '\n' || text[i] == '\r' || text[i] == '\t' ? ' ' : text[i];  // as XML requires
    } else {
      result += character;
      i += semicolon;
    }
  }
  return result;
}

}  // namespace

std::string entity(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, char>, 5> kNamed{
      {{"lt", '<'}, {"gt", '>'}, {"amp", '&'}, {"quot", '"'}, {"apos", '\''}}};
  for (const auto& [known, character] : kNamed) {
    if (known == name) return {character};
  }
  if (name.size() < 2 || name.front() != '#') return {};
  const bool hexadecimal = name[1] == 'x';
  const std::string_view digits = name.substr(hexadecimal ? 2 : 1);
  std::uint32_t code = 0;
  const auto [end, error] =
      std::from_chars(digits.data(), digits.data() + digits.size(), code, hexadecimal ? 16 : 10);
  if (digits.empty() || error != std::errc{} || end != digits.data() + digits.size() || code > 0x10FFFF)
    return {};
  // encode the character in UTF-8
  if (code < 0x80) return {static_cast<char>(code)};
  std::string bytes;
  const int following = code < 0x800 ? 1 : code < 0x10000 ? 2 : 3;
  constexpr std::array kFirst{0U, 0xC0U, 0xE0U, 0xF0U};
  bytes += static_cast<char>(kFirst[static_cast<std::size_t>(following)] |
                             (code >> (6U * static_cast<unsigned>(following))));
  for (int i = following - 1; i >= 0; --i)
    bytes += static_cast<char>(0x80U | ((code >> (6U * static_cast<unsigned>(i))) & 0x3FU));
  return bytes;
}

std::string vtu_words(const std::vector<std::uint64_t>& values, const VtuEncoding& encoding) {
  const std::size_t size = encoding.wide_headers ? 8 : 4;
  std::string result;
  for (const std::uint64_t value : values) {
    for (std::size_t i = 0; i < size; ++i) {
      const std::size_t place = encoding.order == std::endian::big ? size - 1 - i : i;
      result += static_cast<char>((value >> (8 * place)) & 0xFFU);
    }
  }
  return result;
}

const VtuAttribute* VtuElement::find(std::string_view wanted) const {
  const auto found = std::find_if(attributes.begin(), attributes.end(),
                                  [&](const VtuAttribute& attribute) { return attribute.name == wanted; });
  return found == attributes.end() ? nullptr : &*found;
}

const VtuElement* VtuElement::child(std::string_view wanted) const {
  const auto found = std::find_if(children.begin(), children.end(),
                                  [&](const VtuElement& element) { return element.name == wanted; });
  return found == children.end() ? nullptr : &*found;
}

VtuDocument::VtuDocument(const FilePath& path) : scanner_(path) {
  parse();
  read_root();
}

InputError VtuDocument::error_at(std::size_t byte, const std::string& what, const std::string& remedy) const {
  const std::string_view before = scanner_.all().substr(0, byte);
  // a name may hold line ends; the message stays on one line
  std::string line = what;
  std::replace_if(
      line.begin(), line.end(), [](char c) { return static_cast<unsigned char>(c) < ' '; }, '?');
  return {Location{scanner_.file(), 1 + std::count(before.begin(), before.end(), '\n'), -1}, line, remedy};
}

const std::string& VtuDocument::required(const VtuElement& element, std::string_view name) const {
  const std::string* value = element.attribute(name);
  if (value == nullptr)
    throw error(element, fmt::format("<{}> has no {}", element.name, name),
                fmt::format("{}=\"…\" is needed", name));
  return *value;
}

std::int64_t VtuDocument::count(const VtuElement& element, std::string_view name, std::int64_t most) const {
  const std::string& text = required(element, name);
  std::int64_t value = 0;
  if (!parse_xml_number(text, value) || value < 0 || value > most) {
    throw error(element, fmt::format("{} is '{}'", name, text.substr(0, 40)),
                most == kMaxIndex ? "a whole number from 0 to 2147483647 is needed"
                                  : "a whole number from 0 on is needed");
  }
  return value;
}

std::int64_t VtuDocument::components(const VtuElement& array) const {
  return array.text_of("NumberOfComponents").empty() ? 1 : count(array, "NumberOfComponents");
}

/// Parses a start tag at `at`; returns its end.
std::size_t VtuDocument::parse_tag(std::size_t at, VtuElement& element, bool& closed) const {
  const std::string_view all = scanner_.all();
  const auto broken = [&] { return error_at(at, "malformed tag", "the file is not XML or is cut short"); };
  element.at = at;
  std::size_t p = at + 1;
  const auto take_name = [&] {
    const std::size_t begin = p;
    while (p < all.size() && is_name_character(all[p])) ++p;
    if (p == begin) throw broken();
    return std::string(all.substr(begin, p - begin));
  };
  const auto skip_blanks = [&] {
    p = std::min(all.find_first_not_of(kXmlBlanks, p), all.size());
    if (p == all.size()) throw broken();
  };

  element.name = take_name();
  while (true) {
    skip_blanks();
    if (all[p] == '>') {
      closed = false;
      return p + 1;
    }
    if (all[p] == '/') {
      if (p + 1 >= all.size() || all[p + 1] != '>') throw broken();
      closed = true;
      return p + 2;
    }
    std::string name = take_name();
    skip_blanks();
    if (all[p] != '=') throw broken();
    ++p;
    skip_blanks();
    const char quote = all[p];
    const std::size_t end = quote == '"' || quote == '\'' ? all.find(quote, p + 1) : std::string_view::npos;
    if (end == std::string_view::npos) throw broken();
    const std::string_view value = all.substr(p + 1, end - p - 1);
    if (value.find('<') != std::string_view::npos) throw broken();
    element.attributes.push_back({std::move(name), unescaped(value), p + 1, value.size()});
    p = end + 1;
  }
}

void VtuDocument::parse() {
  const std::string_view all = scanner_.all();
  std::vector<VtuElement> open;
  bool finished = false;
  const auto take = [&](VtuElement element) {
    if (open.empty()) {
      root_ = std::move(element);
      finished = true;
    } else {
      open.back().children.push_back(std::move(element));
    }
  };

  std::size_t p = 0;
  while (!finished) {
    const std::size_t tag = all.find('<', p);
    if (tag == std::string_view::npos) {
      if (open.empty()) throw error_at(0, "is not XML", "a file of VTK begins with <VTKFile …>");
      throw error_at(all.size(), "unexpected end of file in <" + open.back().name + ">",
                     "it may be cut short");
    }
    // comments and children can precede the text
    if (!open.empty() && is_blank(open.back().text)) open.back().text = all.substr(p, tag - p);
    const std::string_view rest = all.substr(tag);
    const auto skip_to = [&](std::string_view end) {
      const std::size_t found = all.find(end, tag);
      if (found == std::string_view::npos)
        throw error_at(tag, "malformed tag", "the file is not XML or is cut short");
      p = found + end.size();
    };
    if (rest.starts_with("<?")) {
      skip_to("?>");
    } else if (rest.starts_with("<!--")) {
      skip_to("-->");
    } else if (rest.starts_with("<!")) {
      throw error_at(tag, "unexpected declaration", "only elements are supported");
    } else if (rest.starts_with("</")) {
      const std::size_t end = all.find('>', tag);
      const std::string_view name = end == std::string_view::npos ? "" : all.substr(tag + 2, end - tag - 2);
      if (open.empty() || name.substr(0, name.find_last_not_of(kXmlBlanks) + 1) != open.back().name) {
        throw error_at(tag, "an end tag has no start",
                       open.empty() ? "<VTKFile …> is needed" : "</" + open.back().name + "> is needed");
      }
      VtuElement element = std::move(open.back());
      open.pop_back();
      p = element.end = end + 1;
      take(std::move(element));
    } else {
      VtuElement element;
      bool closed = false;
      p = element.end = parse_tag(tag, element, closed);
      if (element.name == "AppendedData") {
        if (open.size() != 1)
          throw error_at(tag, "<AppendedData> is misplaced", "it must be the last in <VTKFile>");
        begin_appended(element, p);
        VtuElement root = std::move(open.back());
        open.pop_back();
        take(std::move(root));
      } else if (closed) {
        take(std::move(element));
      } else {
        if (open.size() == kDeepest)
          throw error_at(tag, "the elements are nested too deeply", "VTK nests six");
        open.push_back(std::move(element));
      }
    }
  }
}

void VtuDocument::begin_appended(const VtuElement& element, std::size_t end) {
  const std::string& encoding = required(element, "encoding");
  if (encoding != "raw" && encoding != "base64")
    throw error(element, "the encoding is '" + encoding + "'", "raw or base64 is needed");
  appended_base64_ = encoding == "base64";
  const std::size_t begin = scanner_.all().find_first_not_of(kXmlBlanks, end);
  if (begin == std::string_view::npos || scanner_.all()[begin] != '_')
    throw error(element, "<AppendedData> does not begin with _", "its bytes follow an underscore");
  appended_ = scanner_.all().substr(begin + 1);
}

void VtuDocument::read_root() {
  if (root_.name != "VTKFile")
    throw error(root_, "the file is a <" + root_.name + ">", "a file of VTK begins with <VTKFile …>");
  const std::string& type = required(root_, "type");
  if (type != "UnstructuredGrid" && type != "PUnstructuredGrid") {
    const bool structured = type == "ImageData" || type == "StructuredGrid" || type == "RectilinearGrid";
    throw error(root_,
                "the type of the file is " + type.substr(0, 40) +
                    (structured ? ", which is structured: its order is fixed by the grid" : ""),
                "a .vtu file holds an UnstructuredGrid");
  }
  if (const std::string* version = root_.attribute("version")) {
    const std::string_view text = without_xml_blanks(*version);
    int major = 0;
    int minor = 0;
    const char* const end = text.data() + text.size();
    const auto dot = std::from_chars(text.data(), end, major).ptr;
    if (dot != end && *dot == '.') std::from_chars(dot + 1, end, minor);
    if (major < 0 || major > 9 || minor < 0 || minor > 9)
      throw error(root_, "the version is '" + version->substr(0, 40) + "'", "0.1 to 2.3 are supported");
    version_ = 10 * major + minor;
  }
  encoding_.compressor = VtuEncoding::Compressor::none;
  if (const std::string* order = root_.attribute("byte_order")) {
    if (*order != "LittleEndian" && *order != "BigEndian")
      throw error(root_, "the byte_order is '" + order->substr(0, 40) + "'",
                  "LittleEndian or BigEndian is needed");
    encoding_.order = *order == "BigEndian" ? std::endian::big : std::endian::little;
  }
  const std::string* header = root_.attribute("header_type");
  if (header != nullptr && *header != "UInt32" && *header != "UInt64")
    throw error(root_, "the header_type is '" + header->substr(0, 40) + "'", "UInt32 or UInt64 is needed");
  encoding_.wide_headers = header != nullptr && *header == "UInt64";
  if (const std::string* compressor = root_.attribute("compressor");
      compressor != nullptr && !compressor->empty()) {
    const auto found = std::find(kCompressors.begin(), kCompressors.end(), *compressor);
    if (found == kCompressors.end())
      throw error(root_, "the compressor is '" + compressor->substr(0, 40) + "'",
                  "zlib, LZ4 and LZMA are supported");
    encoding_.compressor = static_cast<VtuEncoding::Compressor>(found - kCompressors.begin());
  }
}

}  // namespace meshorder::vtk
