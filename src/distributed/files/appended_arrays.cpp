// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/files/appended_arrays.hpp"

#include "base/memory.hpp"
#include "io/vtk/vtu_compressor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <string_view>
#include <utility>

namespace meshorder::distributed {
namespace {

constexpr const char* kCutShort = "the file may be cut short";
constexpr Offset kMostBytes = std::numeric_limits<Offset>::max();
constexpr std::size_t kMostDigits = std::numeric_limits<Offset>::digits10 + 1;

}  // namespace

VtuXml::VtuXml(std::string text, const vtk::VtuDocument& file) : text_(std::move(text)) {
  add_places(file, file.root());
  std::sort(places_.begin(), places_.end(), [](const Place& a, const Place& b) { return a.at < b.at; });
}

void VtuXml::add_places(const vtk::VtuDocument& file, const vtk::VtuElement& element) {
  if (element.text_of("format") == "appended") {
    const Offset offset = file.count(element, "offset", kMostBytes);
    const vtk::VtuAttribute& attribute = *element.find("offset");
    places_.push_back({attribute.at, attribute.size, offset});
  }
  for (const vtk::VtuElement& child : element.children) add_places(file, child);
}

std::vector<Offset> VtuXml::offsets() const {
  std::vector<Offset> result;
  for (const Place& place : places_) result.push_back(place.offset);
  return result;
}

Offset VtuXml::most_bytes() const {
  std::size_t bytes = text_.find_last_not_of(kXmlBlanks, text_.size() - 2) + 2;
  for (const Place& place : places_) bytes += kMostDigits - std::min(place.size, kMostDigits);
  return static_cast<Offset>(std::max(bytes, text_.size()));
}

std::string VtuXml::with_offsets(const std::function<Offset(Offset)>& moved, Offset bytes) const {
  std::string result;
  std::size_t at = 0;
  for (const Place& place : places_) {
    result += std::string_view(text_).substr(at, place.at - at);
    result += std::to_string(moved(place.offset));
    at = place.at + place.size;
  }
  result += std::string_view(text_).substr(at, text_.size() - 1 - at);
  result.resize(static_cast<std::size_t>(bytes) - 1, ' ');  // adds blanks, or cuts those of an earlier call
  return result + '_';
}

AppendedArrays::AppendedArrays(const std::string& path, const vtk::VtuDocument& document, Offset first_byte,
                               int ranks)
    : file_(path),
      document_(document),
      bytes_(static_cast<Offset>(file_.size())),
      first_byte_(first_byte),
      ranks_(ranks),
      word_(document.encoding().wide_headers ? 8 : 4) {}

Offset AppendedArrays::place(const vtk::VtuElement& element, FilePart& part, std::vector<Offset>& bounds) {
  const std::string what = fmt::format("the array '{}'", element.text_of("Name").substr(0, 40));
  const Offset offset = document_.count(element, "offset", kMostBytes);
  if (offset > bytes_ - first_byte_)
    throw document_.error(element, what + " lies beyond the end of the file", kCutShort);
  part.at = at_ = first_byte_ + offset;
  return static_cast<Offset>(document_.encoding().compressor == VtuEncoding::Compressor::none
                                 ? place_bytes(element, what, part)
                                 : place_blocks(element, what, part, bounds));
}

/// Returns the next `count` words of the file.
std::vector<std::uint64_t> AppendedArrays::words(const vtk::VtuElement& element, const std::string& what,
                                                 std::uint64_t count) {
  const auto left = static_cast<std::uint64_t>(bytes_ - at_);
  if (count > left / word_) throw document_.error(element, what + " ends early", kCutShort);
  document_.claim(element, bytes_for(count, 2 * sizeof(std::uint64_t)));
  std::vector<char> bytes(count * word_);
  const std::size_t got = file_.read_at(static_cast<std::uint64_t>(at_), bytes);
  at_ += std::ssize(bytes);
  if (got < bytes.size())
    throw document_.error(element, what + " cannot be read", "the file may have changed while it was read");
  std::vector<std::uint64_t> result;
  for (std::size_t at = 0; at < bytes.size(); at += word_) {
    std::uint64_t wide = 0;
    std::uint32_t narrow = 0;
    std::memcpy(word_ == 8 ? static_cast<void*>(&wide) : &narrow, bytes.data() + at, word_);
    result.push_back(word_ == 8 ? wide : narrow);
  }
  return result;
}

/// Finds the bytes of an uncompressed array and returns their number, which is the word before them.
std::uint64_t AppendedArrays::place_bytes(const vtk::VtuElement& element, const std::string& what,
                                          FilePart& part) {
  const std::uint64_t size = words(element, what, 1).front();
  const auto left = static_cast<std::uint64_t>(bytes_ - at_);
  if (size > left) {
    throw document_.error(
        element, fmt::format("{} has {} bytes, but the file ends after {}", what, size, left), kCutShort);
  }
  part.stored = static_cast<Offset>(word_ + size);
  return size;
}

/// Finds the blocks of a compressed array. Before the blocks there are words with these numbers:
/// - the number of blocks;
/// - the uncompressed bytes of a block;
/// - the uncompressed bytes of the last block, or 0 if it has as many as the others;
/// - the compressed bytes of each block.
///
/// Returns the uncompressed size of the array.
std::uint64_t AppendedArrays::place_blocks(const vtk::VtuElement& element, const std::string& what,
                                           FilePart& part, std::vector<Offset>& bounds) {
  const std::vector<std::uint64_t> head = words(element, what, 3);
  const std::vector<std::uint64_t> compressed = words(element, what, head[0]);
  if (head[0] > 1 && head[1] == 0)
    throw document_.error(element, what + " has empty blocks", "the array is damaged");
  const std::uint64_t ratio = vtk::VtuCompressor::greatest_ratio(document_.encoding().compressor);
  std::uint64_t size = 0;
  bounds = {at_};
  for (std::size_t b = 0; b < compressed.size(); ++b) {
    if (compressed[b] > static_cast<std::uint64_t>(bytes_ - bounds.back()))
      throw document_.error(element, what + " ends early", kCutShort);
    const std::uint64_t bytes = b + 1 == compressed.size() && head[2] > 0 ? head[2] : head[1];
    if (bytes > compressed[b] * ratio + 1024) {
      throw document_.error(element,
                            fmt::format("{}: a block of {} bytes cannot hold {}", what, compressed[b], bytes),
                            "the array is damaged");
    }
    size += bytes;
    bounds.push_back(bounds.back() + static_cast<Offset>(compressed[b]));
  }
  // claim the memory that a rank needs: its share of the array, and one block of which it needs only a part
  document_.claim(element, size / static_cast<std::uint64_t>(ranks_) + std::min(head[1], size));
  part.stored = bounds.back() - part.at;
  part.blocks = std::ssize(compressed);
  part.block = static_cast<Offset>(compressed.size() == 1 ? size : head[1]);
  return size;
}

}  // namespace meshorder::distributed
