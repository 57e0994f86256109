// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// XML files: elements are moved, copied and joined. The file stays valid XML and gets another meaning. Two
// elements may refer to the same values, which a change of bytes hardly ever achieves.
#include "fuzz/families/families.hpp"
#include "fuzz/input_files.hpp"
#include "fuzz/mutators/choice.hpp"

#include <pugixml.hpp>

#include <algorithm>
#include <iterator>
#include <sstream>
#include <string_view>
#include <vector>

namespace meshorder::fuzz {
namespace {

std::vector<pugi::xml_node> elements_of(const pugi::xml_document& document) {
  std::vector<pugi::xml_node> elements;
  for (const pugi::xpath_node& found : document.select_nodes("//*")) elements.push_back(found.node());
  return elements;
}

/// Returns the path of an element from the root. Each step has a name, and a position among the siblings with
/// this name.
std::string path_of(pugi::xml_node element) {
  std::string path;
  for (; element.type() == pugi::node_element; element = element.parent()) {
    const std::string name = element.name();
    std::size_t place = 1;
    for (auto before = element.previous_sibling(name.c_str()); before;
         before = before.previous_sibling(name.c_str())) {
      ++place;
    }
    path.insert(0, "/" + name + "[" + std::to_string(place) + "]");
  }
  return path;
}

/// Replaces the content of `element` by a reference to `other`.
void refer(pugi::xml_node element, pugi::xml_node other) {
  const std::string path = path_of(other);
  element.remove_children();
  element.remove_attribute("Reference");
  element.append_attribute("Reference").set_value(path.c_str());
}

/// Gives one attribute the value of the same attribute of `other`, or another value.
void change_attribute(pugi::xml_node element, pugi::xml_node other, Choice& choice) {
  const auto attributes = element.attributes();
  const auto count = static_cast<std::size_t>(std::distance(attributes.begin(), attributes.end()));
  if (count == 0) return;
  pugi::xml_attribute attribute =
      *std::next(attributes.begin(), static_cast<std::ptrdiff_t>(choice.below(count)));
  if (const pugi::xml_attribute same = other.attribute(attribute.name()); same && choice.below(2) == 0) {
    attribute.set_value(same.value());
    return;
  }
  const std::string value = attribute.value();
  attribute.set_value(mutated_bytes(value, value.size() + kTextRoom).c_str());
}

void change(pugi::xml_node element, pugi::xml_node other, Choice& choice) {
  pugi::xml_node parent = element.parent();
  switch (choice.below(7)) {
    case 0:  // both have the same values
      element.text().set(other.text().get());
      break;
    case 1:
      refer(element, other);
      break;
    case 2:
      parent.insert_copy_after(other, element);
      break;
    case 3:
      parent.insert_copy_before(other, element);
      parent.remove_child(element);
      break;
    case 4:
      parent.remove_child(element);
      break;
    case 5: {
      const std::string text = element.text().get();
      element.text().set(mutated_bytes(text, text.size() + kTextRoom).c_str());
      break;
    }
    default:
      change_attribute(element, other, choice);
  }
}

std::string text_of(const pugi::xml_document& document) {
  std::ostringstream text;
  document.save(text, "", pugi::format_raw | pugi::format_no_declaration);
  return text.str();
}

}  // namespace

std::string mutate_xml(std::string input, std::uint32_t seed) {
  Choice choice(seed);
  std::vector<MemoryFile> files = input_files(input, "first");
  std::string& text = files.front().bytes;
  pugi::xml_document document;
  if (!document.load_buffer(text.data(), text.size(), pugi::parse_full)) return {};
  const std::vector<pugi::xml_node> elements = elements_of(document);
  if (elements.empty()) return {};
  const pugi::xml_node element = elements[choice.below(elements.size())];
  std::vector<pugi::xml_node> alike;
  std::copy_if(elements.begin(), elements.end(), std::back_inserter(alike),
               [&](const pugi::xml_node& one) { return std::string_view(one.name()) == element.name(); });
  change(element, alike[choice.below(alike.size())], choice);
  text = text_of(document);
  return input_of(files);
}

}  // namespace meshorder::fuzz
