// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Checks the header of netCDF-3 files, see "The NetCDF Classic Format Specification". Finds files that end
// too early: netCDF's library would read zeros.
#include "io/exodus/netcdf.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace meshorder::exodus {
namespace {

/// Thrown if the header continues beyond the bytes that were read so far.
struct Ended {};

constexpr std::uint64_t kStreaming = 0xFFFFFFFFU;
constexpr std::uint64_t kNameBytes = 256;  // longer names overflow a buffer in netCDF's library

class HeaderReader {
 public:
  HeaderReader(const std::string& file, std::string_view bytes, std::uint64_t size)
      : file_(file), bytes_(bytes), size_(size) {}

  void check() {
    at_ = 3;
    const int version = static_cast<unsigned char>(byte());
    if (version != 1 && version != 2 && version != 5)
      fail(fmt::format("the version of netCDF is {}", version), "1, 2 and 5 are supported");
    wide_ = version == 5;
    wide_offsets_ = version != 1;
    records_ = count();
    if (records_ == (wide_ ? std::numeric_limits<std::uint64_t>::max() : kStreaming)) records_ = 0;
    read_dimensions();
    skip_attributes();
    read_variables();
  }

 private:
  [[noreturn]] void fail(const std::string& what,
                         const std::string& remedy = "the file may be damaged") const {
    throw InputError(Location{file_, 0, static_cast<std::int64_t>(at_)}, what, remedy);
  }

  char byte() {
    if (at_ >= bytes_.size()) throw Ended{};
    return bytes_[at_++];
  }

  std::uint64_t integer(std::size_t width) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < width; ++i) value = value << 8U | static_cast<unsigned char>(byte());
    return value;
  }

  std::uint64_t count() { return integer(wide_ ? 8 : 4); }

  /// Skips bytes and the zeros that fill them up to a multiple of four.
  void skip(std::uint64_t bytes) {
    if (bytes > size_) fail("the header names more bytes than the file has", "the file may be cut short");
    at_ += (bytes + 3) / 4 * 4;
  }

  std::string text() {
    const std::uint64_t length = count();
    if (length > kNameBytes)
      fail(fmt::format("a name has {} bytes", length), "netCDF's names have up to 256");
    const std::size_t begin = at_;
    skip(length);
    if (at_ > bytes_.size()) throw Ended{};
    return std::string(bytes_.substr(begin, length));
  }

  /// Reads the tag and the length of a list; returns the length. Each item has at least `least` bytes.
  std::uint64_t list(std::uint64_t tag, std::uint64_t least, const char* of) {
    const std::uint64_t found = integer(4);
    const std::uint64_t length = count();
    if (found != (length == 0 && found == 0 ? 0 : tag)) fail(fmt::format("the list of {} is missing", of));
    if (length > size_ / least)
      fail(fmt::format("the header claims {} {}", length, of), "the file is too small for them");
    return length;
  }

  std::uint64_t width_of_type() {
    const std::uint64_t type = integer(4);
    if (type < 1 || type > 11) fail(fmt::format("{} is not a type of numbers", type));
    return size_of(static_cast<NcType>(type));
  }

  void read_dimensions() {
    const std::uint64_t dimensions = list(10, 8, "dimensions");
    for (std::uint64_t i = 0; i < dimensions; ++i) {
      (void)text();
      lengths_.push_back(count());
    }
  }

  void skip_attributes() {
    const std::uint64_t attributes = list(12, 12, "attributes");
    for (std::uint64_t i = 0; i < attributes; ++i) {
      (void)text();
      const std::uint64_t width = width_of_type();
      const std::uint64_t values = count();
      if (values > size_ / width) fail("an attribute is larger than the file", "the file may be cut short");
      skip(values * width);
    }
  }

  /// Returns the number of bytes of a variable, or of one record if the variable has records. Throws
  /// InputError if the file has fewer bytes.
  std::uint64_t bytes_of(const std::string& name, const std::vector<std::uint64_t>& places,
                         std::uint64_t width) {
    std::uint64_t bytes = width;
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (places[i] >= lengths_.size()) fail(name + " has a dimension that does not exist");
      const std::uint64_t length = lengths_[places[i]];
      if (i == 0 && length == 0) continue;  // this dimension counts the records
      if (length > size_ / std::max<std::uint64_t>(1, bytes))
        fail(fmt::format("{} has more values than the file has bytes", name), "the file may be cut short");
      bytes *= length;
    }
    return bytes;
  }

  struct VariablePart {
    std::string name;
    std::uint64_t begin;
    std::uint64_t bytes;
    bool in_records;
  };

  void read_variables() {
    const std::uint64_t variables = list(11, 28, "variables");
    std::vector<VariablePart> parts;
    std::uint64_t record = 0;
    std::uint64_t record_variables = 0;
    for (std::uint64_t i = 0; i < variables; ++i) {
      VariablePart part{text(), 0, 0, false};
      const std::uint64_t rank = count();
      if (rank > lengths_.size() + 1024) fail(part.name + " has too many dimensions");
      std::vector<std::uint64_t> places;
      for (std::uint64_t k = 0; k < rank; ++k) places.push_back(count());
      skip_attributes();
      const std::uint64_t width = width_of_type();
      (void)count();  // skips the stored size: it is too small for large variables
      part.begin = integer(wide_offsets_ ? 8 : 4);
      part.bytes = bytes_of(part.name, places, width);
      part.in_records = !places.empty() && lengths_[places.front()] == 0;
      if (part.in_records) {
        record += (part.bytes + 3) / 4 * 4;
        ++record_variables;
      }
      parts.push_back(std::move(part));
    }
    for (const VariablePart& part : parts) {
      // if only one variable has records, its records follow each other without gaps
      const std::uint64_t step = record_variables == 1 ? part.bytes : record;
      if (part.in_records && (records_ == 0 || part.bytes == 0)) continue;
      const std::uint64_t before = part.in_records ? records_ - 1 : 0;
      const bool fits = part.begin <= size_ && part.bytes <= size_ - part.begin &&
                        (before == 0 || step <= (size_ - part.begin - part.bytes) / before);
      if (!fits) {
        throw InputError(Location{file_, 0, static_cast<std::int64_t>(size_)},
                         fmt::format("unexpected end of file in the values of {}", part.name),
                         "the file may be cut short");
      }
    }
  }

  const std::string& file_;
  std::string_view bytes_;
  std::uint64_t size_;
  std::size_t at_ = 0;
  bool wide_ = false;
  bool wide_offsets_ = false;
  std::uint64_t records_ = 0;
  std::vector<std::uint64_t> lengths_;
};

}  // namespace

void check_classic_header(const std::string& file, const std::function<std::string(std::size_t)>& first_bytes,
                          std::uint64_t size) {
  constexpr std::size_t kFirst = std::size_t{1} << 16;
  for (std::size_t wanted = kFirst;; wanted *= 4) {
    const std::string bytes = first_bytes(wanted);
    try {
      return HeaderReader(file, bytes, size).check();
    } catch (const Ended&) {
      if (bytes.size() < wanted) {
        throw InputError(Location{file, 0, static_cast<std::int64_t>(bytes.size())},
                         "unexpected end of file in the header", "the file may be cut short");
      }
    }
  }
}

}  // namespace meshorder::exodus
