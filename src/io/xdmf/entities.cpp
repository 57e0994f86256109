// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/vtk/vtu_document.hpp"
#include "io/xdmf/document.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <string_view>
#include <utility>

// Extensible Markup Language (XML) 1.0, fifth edition (W3C, 2008), sections 2.8 and 4. pugixml does not
// replace entities. Each entity is expanded once and its text is kept, so the time grows only with the added
// text, which is limited.

namespace meshorder::xdmf {
namespace {

constexpr std::size_t kMostAdded = std::size_t{16} << 20U;  // bytes, by all entities together
constexpr int kDeepest = 32;                                // levels of entities in entities
constexpr std::string_view kBlanks = " \t\r\n";
constexpr std::array<std::string_view, 5> kPredefined{"amp", "apos", "gt", "lt", "quot"};

struct Entity {
  std::string text;      ///< text as declared, with references to characters replaced
  std::string expanded;  ///< set once `is_expanded`
  bool is_expanded = false;
  bool is_open = false;  ///< true while it is being expanded
  bool is_external = false;
};

std::size_t end_of(std::string_view text, std::string_view what, std::size_t from) {
  const std::size_t at = text.find(what, from);
  return at == std::string_view::npos ? at : at + what.size();
}

/// Returns the end of the name that begins at `from`; `from` if there is no name.
std::size_t end_of_name(std::string_view text, std::size_t from) {
  const auto is_part = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == ':' || c == '-' || c == '.' || static_cast<unsigned char>(c) >= 0x80;
  };
  while (from < text.size() && is_part(text[from])) ++from;
  return from;
}

class Expansion {
 public:
  Expansion(std::string_view text, const std::string& file) : text_(text), file_(file) {}

  /// Returns the text without declarations and with entities replaced; empty if it declares no entities.
  std::string run() {
    const std::size_t begin = begin_of_subset();
    if (begin == std::string_view::npos) return {};
    const std::size_t end = read_subset(begin);  // after the ]
    if (entities_.empty()) return {};
    std::string result(text_.substr(0, begin - 1));
    result.append(static_cast<std::size_t>(
                      std::count(text_.begin() + offset(begin), text_.begin() + offset(end), '\n')),
                  '\n');
    result += expanded(text_.substr(end), end, 0);
    return result;
  }

 private:
  static std::ptrdiff_t offset(std::size_t at) { return static_cast<std::ptrdiff_t>(at); }

  [[noreturn]] void fail(std::size_t at, const std::string& what, const std::string& remedy) const {
    const auto end = text_.begin() + offset(std::min(at, text_.size()));
    throw InputError(Location{file_, 1 + std::count(text_.begin(), end, '\n'), -1}, what, remedy);
  }

  [[noreturn]] void fail_malformed(std::size_t at) const {
    fail(at, "the DOCTYPE is malformed", "remove it: only declarations of entities are read");
  }

  /// Returns where the declarations in the DOCTYPE begin, after the [; npos if there are none.
  [[nodiscard]] std::size_t begin_of_subset() const {
    constexpr std::size_t kNone = std::string_view::npos;
    std::size_t at = text_.find('<');
    while (at != kNone && (text_.substr(at).starts_with("<?") || text_.substr(at).starts_with("<!--"))) {
      at = end_of(text_, text_[at + 1] == '?' ? "?>" : "-->", at);
      if (at != kNone) at = text_.find('<', at);
    }
    if (at == kNone || !text_.substr(at).starts_with("<!DOCTYPE")) return kNone;
    at = text_.find_first_of("[>\"'", at);
    while (at != kNone && text_[at] != '[' && text_[at] != '>') {
      at = text_.find(text_[at], at + 1);
      if (at != kNone) at = text_.find_first_of("[>\"'", at + 1);
    }
    return at == kNone || text_[at] == '>' ? kNone : at + 1;
  }

  [[nodiscard]] std::size_t skip_blanks(std::size_t at) const {
    return std::min(text_.find_first_not_of(kBlanks, at), text_.size());
  }

  /// Reads the declarations; returns where they end, after the ].
  std::size_t read_subset(std::size_t at) {
    while (true) {
      at = skip_blanks(at);
      const std::string_view rest = text_.substr(at);
      std::size_t next = std::string_view::npos;
      if (rest.starts_with(']')) return at + 1;
      if (rest.starts_with("<!--")) {
        next = end_of(text_, "-->", at);
      } else if (rest.starts_with("<?")) {
        next = end_of(text_, "?>", at);
      } else if (rest.starts_with("<!ENTITY")) {
        next = read_entity(at);
      } else if (rest.starts_with("<!")) {
        next = skip_declaration(at);
      } else if (rest.starts_with('%')) {
        fail(at, "the DOCTYPE uses a parameter entity", "replace the reference by its text");
      }
      if (next == std::string_view::npos) fail_malformed(at);
      at = next;
    }
  }

  /// Returns the end of a declaration other than <!ENTITY …>.
  [[nodiscard]] std::size_t skip_declaration(std::size_t begin) const {
    std::size_t at = text_.find_first_of(">\"'", begin);
    while (at != std::string_view::npos && text_[at] != '>') {
      if (text_.substr(begin).starts_with("<!ATTLIST")) {
        fail(begin, "the DOCTYPE gives attributes defaults", "write the attributes where they are missing");
      }
      at = text_.find(text_[at], at + 1);
      if (at != std::string_view::npos) at = text_.find_first_of(">\"'", at + 1);
    }
    return at == std::string_view::npos ? at : at + 1;
  }

  /// Reads <!ENTITY NAME "TEXT">; returns its end.
  std::size_t read_entity(std::size_t begin) {
    std::size_t at = skip_blanks(begin + std::string_view("<!ENTITY").size());
    if (at < text_.size() && text_[at] == '%') return skip_declaration(begin);  // refused where it is used
    const std::size_t end = end_of_name(text_, at);
    const std::string name(text_.substr(at, end - at));
    at = skip_blanks(end);
    if (name.empty() || at >= text_.size()) fail_malformed(begin);
    Entity entity;
    if (text_[at] == '"' || text_[at] == '\'') {
      const std::size_t close = text_.find(text_[at], at + 1);
      if (close == std::string_view::npos) fail_malformed(begin);
      entity.text = with_characters(text_.substr(at + 1, close - at - 1), at);
      at = skip_blanks(close + 1);
      if (at >= text_.size() || text_[at] != '>') fail_malformed(begin);
      ++at;
    } else {
      const std::string_view where = text_.substr(at, 6);
      if (where != "SYSTEM" && where != "PUBLIC") fail_malformed(begin);
      entity.is_external = true;
      at = skip_declaration(begin);
    }
    entities_.emplace(name, std::move(entity));  // the first declaration counts
    return at;
  }

  /// Returns the text of a declaration with its references to characters, &#38; and &#x26;, replaced.
  [[nodiscard]] std::string with_characters(std::string_view text, std::size_t at) const {
    std::string result;
    while (true) {
      const std::size_t reference = text.find("&#");
      result += text.substr(0, reference);
      if (reference == std::string_view::npos) return result;
      text.remove_prefix(reference + 1);
      const std::size_t end = text.find(';');
      const std::string character = vtk::entity(text.substr(0, end));
      if (end == std::string_view::npos || character.empty() || character.front() == '\0')
        fail(at, "an entity has a character that XML does not know", "&#38; is one");
      result += character;
      text.remove_prefix(end + 1);
    }
  }

  /// Returns markup with its entities replaced. At depth 0, `text` is the file from byte `origin` on.
  /// Otherwise it is the text of an entity, whose errors are reported at byte `origin`.
  std::string expanded(std::string_view text, std::size_t origin, int depth) {
    std::string result;
    std::size_t at = 0;
    const auto copy_to = [&](std::size_t end) {
      end = std::min(end, text.size());
      result += text.substr(at, end - at);
      at = end;
    };
    const auto place = [&] { return depth == 0 ? origin + at : origin; };
    char quote = '\0';  // quote that began the attribute's value
    bool in_tag = false;
    while (at < text.size()) {
      const char* const stops = quote != '\0' ? (quote == '"' ? "&\"" : "&'") : in_tag ? "\"'>" : "&<";
      copy_to(text.find_first_of(stops, at));
      if (at == text.size()) break;
      const std::string_view rest = text.substr(at);
      if (rest.front() == '&') {
        at += append_reference(result, rest, quote != '\0', place(), depth);
      } else if (in_tag) {
        if (rest.front() == '>') in_tag = false;
        if (rest.front() != '>') quote = quote == '\0' ? rest.front() : '\0';
        copy_to(at + 1);
      } else if (rest.starts_with("<!--")) {
        copy_to(end_of(text, "-->", at));
      } else if (rest.starts_with("<![CDATA[")) {
        copy_to(end_of(text, "]]>", at));
      } else if (rest.starts_with("<?")) {
        copy_to(end_of(text, "?>", at));
      } else {
        in_tag = true;
        copy_to(at + 1);
      }
    }
    return result;
  }

  /// Appends the replacement of the reference at the beginning of `text`; returns the reference's length.
  std::size_t append_reference(std::string& result, std::string_view text, bool in_attribute,
                               std::size_t place, int depth) {
    const std::size_t end = end_of_name(text, 1);
    const std::string name(text.substr(1, end - 1));
    const bool is_plain = name.empty() || end == text.size() || text[end] != ';' ||
                          std::find(kPredefined.begin(), kPredefined.end(), name) != kPredefined.end();
    if (is_plain) {  // pugixml replaces the reference
      result += '&';
      return 1;
    }
    const std::string& replacement = replacement_of(name, place, depth);
    std::size_t added = 0;
    if (!in_attribute) {
      result += replacement;
      added = replacement.size();
    } else {
      if (replacement.find('<') != std::string::npos) {
        fail(place, fmt::format("the entity '{}' has a < and is in an attribute", shown(name)),
             "write &#38;lt; in its declaration");
      }
      const std::size_t before = result.size();
      for (const char c : replacement) {
        if (c == '"') {
          result += "&quot;";
        } else if (c == '\'') {
          result += "&apos;";
        } else {
          result += c;
        }
      }
      added = result.size() - before;
    }
    added_ += added;
    if (added_ > kMostAdded) {
      fail(place, "the entities in the DOCTYPE make the file more than 16 MiB longer",
           "replace the references by their text");
    }
    return end + 1;
  }

  const std::string& replacement_of(const std::string& name, std::size_t place, int depth) {
    const auto found = entities_.find(name);
    if (found == entities_.end()) {
      fail(place, fmt::format("the entity '{}' is not declared in the file", shown(name)),
           "declare it in the DOCTYPE; other files are not read for it");
    }
    Entity& entity = found->second;
    if (entity.is_external) {
      fail(place, fmt::format("the entity '{}' is in another file, which is not read", shown(name)),
           "replace the reference by its text");
    }
    if (entity.is_open || depth >= kDeepest) {
      fail(place, fmt::format("the entity '{}' refers to itself or is nested too deeply", shown(name)),
           "replace the reference by its text");
    }
    if (!entity.is_expanded) {
      entity.is_open = true;
      entity.expanded = expanded(entity.text, place, depth + 1);
      entity.is_open = false;
      entity.is_expanded = true;
    }
    return entity.expanded;
  }

  static std::string shown(const std::string& name) { return name.substr(0, 40); }

  std::string_view text_;
  const std::string& file_;
  std::map<std::string, Entity> entities_;
  std::size_t added_ = 0;
};

}  // namespace

std::string with_entities_expanded(std::string text, const std::string& file) {
  std::string result = Expansion(text, file).run();
  return result.empty() ? std::move(text) : result;
}

}  // namespace meshorder::xdmf
