// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/xdmf/document.hpp"

#include "base/memory.hpp"
#include "base/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <new>

namespace meshorder::xdmf {
namespace {

constexpr unsigned kParse = pugi::parse_full | pugi::parse_ws_pcdata;
constexpr int kMostReferences = 16;
constexpr std::size_t kMostVisits = 100'000'000;  // visits of elements, by all XPaths together
constexpr std::size_t kLongestPath = 1000;

class TextWriter : public pugi::xml_writer {
 public:
  explicit TextWriter(const TakeText& take) : take_(take) {}
  void write(const void* data, std::size_t size) override { take_({static_cast<const char*>(data), size}); }

 private:
  const TakeText& take_;
};

bool is_include(pugi::xml_node element) {
  const std::string_view name = element.name();
  return name == "include" || name.ends_with(":include");
}

/// Returns an XPath without its quoted texts.
std::string without_texts(std::string_view path) {
  std::string result;
  char quote = '\0';
  for (const char c : path) {
    if (quote == '\0') result += c;
    if (c == quote) {
      quote = '\0';
    } else if (quote == '\0' && (c == '"' || c == '\'')) {
      quote = c;
    }
  }
  return result;
}

/// Returns whether evaluating an XPath takes time linear in the file: one "//" at most, no axis but "self::",
/// and no path or predicate within a predicate.
bool is_linear(std::string_view xpath) {
  const std::string path = without_texts(xpath);
  const auto count = [&](std::string_view part) {
    std::size_t found = 0;
    for (std::size_t at = path.find(part); at != std::string::npos; at = path.find(part, at + 1)) ++found;
    return found;
  };
  if (count("//") > 1 || count("::") != count("self::") || count("-self::") > 0) return false;
  for (std::size_t at = path.find('['); at != std::string::npos; at = path.find('[', at + 1)) {
    const std::size_t next = path.find_first_of("[]/", at + 1);
    if (next != std::string::npos && path[next] != ']') return false;
  }
  return true;
}

}  // namespace

bool is_mark(pugi::xml_node node) {
  return node.type() == pugi::node_pi && std::string_view(node.name()) == kMark;
}

std::string attribute(pugi::xml_node element, const char* name, const char* other_name) {
  const pugi::xml_attribute own = element.attribute(name);
  return own ? own.value() : element.attribute(other_name).value();
}

std::vector<pugi::xml_node> elements_named(const pugi::xml_document& xml, std::string_view name) {
  struct Finder : pugi::xml_tree_walker {
    bool for_each(pugi::xml_node& node) override {
      if (node.name() == wanted) found.push_back(node);
      return true;
    }
    std::string_view wanted;
    std::vector<pugi::xml_node> found;
  } finder;
  finder.wanted = name;
  pugi::xml_node whole = xml.root();
  whole.traverse(finder);
  return std::move(finder.found);
}

void parse(pugi::xml_document& xml, const std::string& text) {
  if (!xml.load_buffer(text.data(), text.size(), kParse)) throw std::bad_alloc();
}

void set_text(pugi::xml_node element, const std::string& text) {
  if (!element.text().set(text.c_str())) throw std::bad_alloc();
}

void set_attribute(pugi::xml_node element, const char* name, const std::string& value) {
  pugi::xml_attribute own = element.attribute(name);
  if (!own) own = element.append_attribute(name);
  if (!own.set_value(value.c_str())) throw std::bad_alloc();
}

void print(const pugi::xml_document& xml, std::string_view prolog, const TakeText& take) {
  TextWriter writer(take);
  take(prolog);
  xml.document_element().print(writer, "", pugi::format_raw, pugi::encoding_utf8);
  take("\n");
}

void print_indented(const pugi::xml_document& xml, const TakeText& take) {
  TextWriter writer(take);
  xml.save(writer, "  ", pugi::format_indent, pugi::encoding_utf8);
}

Document::Document(const FilePath& path)
    : file_(path.string()), source_(with_entities_expanded(path.read(), file_)) {
  // parses a copy on large pages: error messages need `source_` for their lines
  auto* const text = static_cast<char*>(pugi::get_memory_allocation_function()(source_.size()));
  if (text == nullptr) throw std::bad_alloc();
  ask_for_large_pages(text, source_.size());
  source_.copy(text, source_.size());
  const pugi::xml_parse_result result = xml_.load_buffer_inplace_own(text, source_.size(), kParse);
  const auto line_of = [&](std::ptrdiff_t byte) {
    const auto end = source_.begin() + std::min<std::ptrdiff_t>(byte, std::ssize(source_));
    return 1 + std::count(source_.begin(), end, '\n');
  };
  if (!result) {
    throw InputError(Location{file_, line_of(result.offset), -1},
                     fmt::format("the XML is malformed ({})", result.description()),
                     "the file may be cut short");
  }
  if (std::string_view(root().name()) != "Xdmf") {
    throw InputError(Location{file_, 1, -1}, fmt::format("the file is a <{}>", root().name()),
                     "a file of XDMF begins with <Xdmf …>");
  }
  for (pugi::xml_node next = root().next_sibling(); next; next = next.next_sibling()) {
    if (next.type() != pugi::node_element) continue;
    throw error(next, fmt::format("a <{}> follows the <Xdmf> element", next.name()),
                "put all Grids into one <Xdmf>, as XML has one root element");
  }
  items_ = elements_named(xml_, "DataItem");
  for (std::size_t i = 0; i < items_.size(); ++i) numbers_.emplace(items_[i].hash_value(), i);
  const std::vector<pugi::xml_node> grids = elements_named(xml_, "Grid");
  for (std::size_t i = 0; i < grids.size(); ++i) numbers_.emplace(grids[i].hash_value(), i);
}

InputError Document::error(pugi::xml_node at, const std::string& what, const std::string& remedy) const {
  const std::ptrdiff_t byte = std::clamp<std::ptrdiff_t>(at.offset_debug(), 0, std::ssize(source_));
  std::string line = what;
  std::replace_if(
      line.begin(), line.end(), [](char c) { return static_cast<unsigned char>(c) < ' '; }, ' ');
  return {Location{file_, 1 + std::count(source_.begin(), source_.begin() + byte, '\n'), -1}, line, remedy};
}

const std::vector<pugi::xml_node>& Document::selected(pugi::xml_node from, std::string path) const {
  path = std::string(without_xml_blanks(path));
  if (path.starts_with("xpointer(") && path.ends_with(")")) path = path.substr(9, path.size() - 10);
  std::vector<pugi::xml_node>& found = selected_[path];
  if (!found.empty()) return found;
  if (!is_linear(path)) {
    throw error(from, fmt::format("the XPath '{}' is too complex", path.substr(0, 100)),
                "write it like /Xdmf/Domain/Grid[1]/Topology");
  }
  if (selected_.size() * numbers_.size() > kMostVisits) {
    throw error(from, fmt::format("the file has {} different references", selected_.size()),
                "repeat the same XPath where the same element is meant");
  }
  try {
    if (!path.empty() && path.size() <= kLongestPath) {
      for (const pugi::xpath_node& node : xml_.select_nodes(path.c_str())) {
        if (node.node().type() == pugi::node_element) found.push_back(node.node());
      }
    }
  } catch (const pugi::xpath_exception& fault) {
    throw error(from, fmt::format("'{}' is not an XPath ({})", path.substr(0, 100), fault.what()),
                "write it like /Xdmf/Domain/Grid[1]/Topology");
  }
  if (found.empty()) {
    throw error(from, fmt::format("'{}' names no element of the file", path.substr(0, 100)),
                "only references to elements of the same file are supported");
  }
  return found;
}

pugi::xml_node Document::resolved(pugi::xml_node element) const {
  for (int i = 0; i < kMostReferences; ++i) {
    const pugi::xml_attribute reference = element.attribute("Reference");
    if (!reference) return element;
    const bool in_text = same_but_for_case(reference.value(), "XML");
    const std::string path = in_text ? element.text().get() : reference.value();
    const pugi::xml_node next = selected(element, path).front();
    if (std::string_view(next.name()) != element.name()) {
      throw error(element, fmt::format("the <{}> refers to a <{}>", element.name(), next.name()),
                  "an element can only refer to one of the same name");
    }
    element = next;
  }
  throw error(element, "the references lead in a circle", "an element refers to one with data");
}

std::vector<pugi::xml_node> Document::children(pugi::xml_node grid) const {
  std::vector<pugi::xml_node> result;
  for (const pugi::xml_node child : grid.children()) {
    if (child.type() != pugi::node_element) continue;
    if (!is_include(child)) {
      result.push_back(resolved(child));
      continue;
    }
    if (*child.attribute("href").value() != '\0') {
      throw error(child, fmt::format("the file includes '{}'", child.attribute("href").value()),
                  "put both into one file");
    }
    for (const pugi::xml_node node : selected(child, child.attribute("xpointer").value())) {
      result.push_back(resolved(node));
    }
  }
  return result;
}

std::string Document::take_values_out(std::vector<std::size_t> items) {
  // descending: an inner element has a higher number than the elements around it
  std::sort(items.begin(), items.end(), std::greater());
  for (const std::size_t item : items) items_[item].remove_children();
  std::string text;
  print(xml_, prolog(), [&](std::string_view part) { text += part; });
  return text;
}

std::string_view Document::prolog() const {
  constexpr std::string_view kPlain = "<?xml version=\"1.0\"?>\n";
  const std::string_view before = std::string_view(source_).substr(0, source_.find("<Xdmf"));
  const std::size_t encoding = before.find("encoding=");
  const bool is_utf8 =
      encoding == std::string_view::npos || same_but_for_case(before.substr(encoding + 10, 5), "utf-8");
  return is_utf8 && before.size() < source_.size() && before.starts_with('<') ? before : kPlain;
}

}  // namespace meshorder::xdmf
