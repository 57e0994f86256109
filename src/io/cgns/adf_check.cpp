// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/input_file.hpp"
#include "base/run_scope.hpp"
#include "io/cgns/tree.hpp"
#include "io/stream/byte_order.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <bit>
#include <charconv>
#include <cstdint>
#include <set>
#include <utility>

// Checks an ADF file before libcgns reads it: libcgns follows the file's pointers unchecked. Layout: Advanced
// Data Format software library, "ADF file layout" (NASA, https://cgns.github.io/CGNS_docs_current/adf/).
// Numbers are hexadecimal digits. A pointer has 8 digits for a block of 4,096 bytes and 4 for a byte in the
// block. In files of version B…, which libcgns writes if it is configured for 64 bits, pointers and
// dimensions are binary numbers with as many bytes as digits (ADF_internals.c of libcgns).

namespace meshorder::cgns {
namespace {

constexpr int kDeepestNode = 64;
constexpr std::uint64_t kBlock = 4096;
constexpr std::size_t kTag = 4;
constexpr std::size_t kPointer = 12;
constexpr std::size_t kName = 32;
constexpr std::size_t kMostLengths = 12;
constexpr std::size_t kDigits = 8;  // digits of a count, a dimension, or a pointer's block
constexpr std::uint64_t kVersionAt = 25;
constexpr std::uint64_t kByteOrderAt = 100;
constexpr std::uint64_t kRootPointerAt = 134;

// offsets in a node
constexpr std::size_t kChildrenAt = kTag + 2 * kName;
constexpr std::size_t kTypeAt = kChildrenAt + 2 * kDigits + kPointer;
constexpr std::size_t kRankAt = kTypeAt + kName;
constexpr std::size_t kChunksAt = kRankAt + 2 + kMostLengths * kDigits;
constexpr std::size_t kNode = kChunksAt + 4 + kPointer + kTag;

class AdfCheck {
 public:
  AdfCheck(const InputFile& file, std::string name) : name_(std::move(name)), file_(file) {}

  void run() {
    binary_ = bytes(kVersionAt, 1) == "B";
    const std::string order = bytes(kByteOrderAt, 1);
    if (binary_ && order != "L" && order != "B") fail(kByteOrderAt, "the byte order is unknown");
    order_ = order == "L" ? std::endian::little : std::endian::big;
    check_node(pointer(kRootPointerAt), 0);
  }

 private:
  [[noreturn]] void fail(std::uint64_t at, std::string_view what) const {
    throw InputError(Location{name_, 0, static_cast<std::int64_t>(at)}, std::string(what),
                     "the file may be damaged");
  }

  std::string bytes(std::uint64_t at, std::size_t count) {
    if (at > file_.size() || count > file_.size() - at)
      fail(at, "a part of a node lies beyond the end of the file");
    std::string result(count, '\0');
    if (file_.read_at(at, result) < count) fail(at, "cannot be read");
    return result;
  }

  std::uint64_t number(std::uint64_t at, std::size_t digits) {
    const std::string text = bytes(at, digits);
    std::uint64_t value = 0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + digits, value, 16);
    if (code != std::errc{} || end != text.data() + digits) fail(at, "a number is not hexadecimal");
    return value;
  }

  /// Returns a number that is binary in files of version B… and hexadecimal in others.
  template <class T>
  std::uint64_t wide(std::uint64_t at) {
    return binary_ ? number_at<T>(bytes(at, sizeof(T)).data(), order_) : number(at, sizeof(T));
  }

  std::uint64_t pointer(std::uint64_t at) {
    const std::uint64_t block = wide<std::uint64_t>(at);
    const std::uint64_t byte = wide<std::uint32_t>(at + kDigits);
    if (block > file_.size() / kBlock || byte > kBlock)
      fail(at, "the target of a pointer lies beyond the end of the file");
    return block * kBlock + byte;
  }

  void expect_tag(std::uint64_t at, std::string_view tag) {
    if (bytes(at, kTag) != tag) fail(at, fmt::format("'{}' is missing", tag));
  }

  void check_node(std::uint64_t at, int level) {
    poll();
    if (level > kDeepestNode) fail(at, "nodes are nested too deeply");
    if (!seen_.insert(at).second) fail(at, "a node has two parents");
    expect_tag(at, "NoDe");
    expect_tag(at + kNode - kTag, "TaiL");
    const std::uint64_t children = number(at + kChildrenAt, kDigits);
    const std::uint64_t entries = number(at + kChildrenAt + kDigits, kDigits);
    if (children > entries) fail(at, "a node has more children than entries for them");
    if (children > 0) check_children(pointer(at + kChildrenAt + 2 * kDigits), children, entries, level);
    check_data(at);
  }

  void check_children(std::uint64_t table, std::uint64_t children, std::uint64_t entries, int level) {
    constexpr std::size_t kEntry = kName + kPointer;
    expect_tag(table, "SNTb");
    const std::uint64_t first = table + kTag + kPointer;
    if (entries > file_.size() / kEntry) fail(table, "a node has more children than the file can hold");
    const std::uint64_t end = first + entries * kEntry;
    if (pointer(table + kTag) != end) fail(table, "the table of children has a wrong end");
    expect_tag(end, "snTE");
    for (std::uint64_t c = 0; c < children; ++c) {
      check_node(pointer(first + c * kEntry + kName), level + 1);
    }
  }

  void check_data(std::uint64_t node) {
    const std::string type = bytes(node + kTypeAt, kName);
    const std::size_t width = size_of_type(type.substr(0, type.find(' ')));
    const std::uint64_t rank = number(node + kRankAt, 2);
    if (rank > kMostLengths) fail(node, fmt::format("a node has {} dimensions", rank));
    std::uint64_t wanted = width;
    for (std::uint64_t k = 0; k < rank; ++k) {
      const std::uint64_t length = wide<std::uint64_t>(node + kRankAt + 2 + k * kDigits);
      if (wanted > 0 && length > file_.size() / wanted)
        fail(node, "a node claims more values than the file can hold");
      wanted *= length;
    }
    const std::uint64_t chunks = number(node + kChunksAt, 4);
    if (chunks == 0) return;
    const std::uint64_t at = pointer(node + kChunksAt + 4);
    const std::uint64_t found = chunks == 1 ? bytes_of_chunk(at) : bytes_of_chunks(at, chunks);
    if (rank > 0 && found < wanted) fail(node, "the values of a node end early");
  }

  /// Returns the number of bytes in a chunk of values.
  std::uint64_t bytes_of_chunk(std::uint64_t at) {
    expect_tag(at, "DaTa");
    const std::uint64_t end = pointer(at + kTag);
    if (end < at + kTag + kPointer) fail(at, "values end before they begin");
    expect_tag(end, "dEnD");
    return end - at - kTag - kPointer;
  }

  std::uint64_t bytes_of_chunks(std::uint64_t table, std::uint64_t chunks) {
    expect_tag(table, "DCtb");
    const std::uint64_t first = table + kTag + kPointer;
    const std::uint64_t end = first + chunks * 2 * kPointer;
    if (pointer(table + kTag) != end) fail(table, "the table of chunks has a wrong end");
    expect_tag(end, "dcTE");
    std::uint64_t sum = 0;
    for (std::uint64_t at = first; at < end; at += 2 * kPointer) sum += bytes_of_chunk(pointer(at));
    return sum;
  }

  std::string name_;
  const InputFile& file_;
  bool binary_ = false;
  std::endian order_ = std::endian::little;  // byte order of binary numbers
  std::set<std::uint64_t> seen_;             // offsets of nodes
};

}  // namespace

void check_adf(const InputFile& file, const std::string& name) { AdfCheck(file, name).run(); }

}  // namespace meshorder::cgns
