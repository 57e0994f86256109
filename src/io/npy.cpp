// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// The format: NumPy Enhancement Proposal 1, "A Simple File Format for NumPy Arrays".
#include "io/npy.hpp"

#include "io/stream/output_file.hpp"
#include "io/stream/scanner.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <bit>
#include <utility>

namespace meshorder {
namespace {

constexpr std::string_view kMagic = "\x93NUMPY\x01";  // with the major version 1
constexpr std::size_t kAlignment = 64;                // alignment of the header, magic included, in bytes
constexpr std::size_t kPreamble = 10;                 // bytes of magic, versions and header length

template <class T>
void write_array(std::span<const T> values, const FilePath& path) {
  OutputFile file(path);
  file.write(
      npy_header(fmt::format("<i{}", sizeof(T)), std::array{static_cast<std::int64_t>(values.size())}));
  for (const T value : values) file.binary(value, std::endian::little);
  file.commit();
}

/// Returns the value after `'key':` in a header: the text before the next comma or closing brace; a tuple
/// includes its opening but not its closing parenthesis.
std::string_view header_value(const Scanner& at, std::string_view header, std::string_view key) {
  const auto found = header.find("'" + std::string(key) + "'");
  const auto colon = header.find(':', found);
  if (found == std::string_view::npos || colon == std::string_view::npos) {
    at.fail_at_byte("the header has no '" + std::string(key) + "'", "write it with numpy.save");
  }
  std::string_view value = header.substr(colon + 1);
  value.remove_prefix(std::min(value.find_first_not_of(' '), value.size()));
  const auto end = value.starts_with('(') ? value.find(')') : value.find_first_of(",}");
  return value.substr(0, end);
}

}  // namespace

void write_npy(std::span<const std::int32_t> values, const FilePath& path) { write_array(values, path); }

void write_npy(std::span<const std::int64_t> values, const FilePath& path) { write_array(values, path); }

std::string npy_header(std::string_view type, std::span<const std::int64_t> shape) {
  std::string header = fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}{}), }}", type,
                                   fmt::join(shape, ", "), shape.size() == 1 ? "," : "");
  header.append(kAlignment - (kPreamble + header.size() + 1) % kAlignment, ' ');
  header += '\n';
  const auto length = static_cast<std::uint16_t>(header.size());
  std::string preamble(kMagic);
  for (const int byte : {0, length & 0xff, length >> 8}) preamble += static_cast<char>(byte);
  return preamble + header;
}

NpyHeader read_npy_header(Scanner& file) {
  if (file.binary_block(6, "the magic") != kMagic.substr(0, 6)) {
    file.fail_at_byte("is not a NumPy array", "give a file that numpy.save or meshorder wrote");
  }
  const auto major = file.binary<std::uint8_t>("the version");
  file.binary<std::uint8_t>("the version");
  const std::int64_t length =
      major == 1 ? std::int64_t{file.binary<std::uint16_t>("the length", std::endian::little)}
                 : std::int64_t{file.binary<std::uint32_t>("the length", std::endian::little)};
  const std::string text(file.binary_block(length, "the header"));
  NpyHeader header;
  std::string_view type = header_value(file, text, "descr");
  while (!type.empty() && (type.front() == '\'' || type.front() == '"')) type.remove_prefix(1);
  header.type = type.substr(0, type.find_first_of("'\""));
  header.columns_first = header_value(file, text, "fortran_order").starts_with("True");
  std::string_view shape = header_value(file, text, "shape");
  if (shape.starts_with('(')) shape.remove_prefix(1);
  while (!shape.empty()) {
    const auto comma = std::min(shape.find(','), shape.size());
    header.shape.push_back(
        parse_integer<std::int64_t>(file, shape.substr(0, comma), "the number of entries"));
    shape.remove_prefix(std::min(comma + 1, shape.size()));
    shape.remove_prefix(std::min(shape.find_first_not_of(' '), shape.size()));
  }
  return header;
}

std::vector<std::int64_t> read_npy(const FilePath& path) {
  Scanner file(path);
  const NpyHeader header = read_npy_header(file);
  if (header.shape.size() != 1) {
    file.fail_at_byte("has " + std::string(header.shape.empty() ? "no dimension" : "more than one dimension"),
                      "a map is a list of numbers");
  }
  const std::string& type = header.type;
  if (type.size() != 3 || (type[0] != '<' && type[0] != '>') || (type[1] != 'i' && type[1] != 'u') ||
      (type[2] != '4' && type[2] != '8')) {
    file.fail_at_byte("holds '" + type + "'", "32- or 64-bit integers are needed");
  }
  const std::int64_t size = header.shape[0];
  const std::endian order = type[0] == '<' ? std::endian::little : std::endian::big;
  const std::int64_t width = type[2] - '0';
  if (size < 0 || size > file.bytes_left() / width) {
    file.fail_at_byte("announces " + std::to_string(size) + " entries, but only " +
                          std::to_string(file.bytes_left()) + " bytes follow",
                      "it may be cut short");
  }
  std::vector<std::int64_t> values(size);
  for (std::int64_t& value : values) {
    value = width == 4 ? std::int64_t{file.binary<std::int32_t>("an entry", order)}
                       : file.binary<std::int64_t>("an entry", order);
  }
  return values;
}

Permutation read_permutation(const FilePath& path, Index count, const std::string& what) {
  const std::vector<std::int64_t> places = read_npy(path);
  if (index_size(places) != count) {
    throw InputError(
        path.string(),
        "maps " + std::to_string(places.size()) + " " + what + ", the mesh has " + std::to_string(count),
        "give the maps that were written with this mesh");
  }
  std::vector<Index> old_to_new;
  old_to_new.reserve(places.size());
  // Permutation reports -1 as an invalid position
  for (const std::int64_t place : places)
    old_to_new.push_back(place < 0 || place >= count ? -1 : static_cast<Index>(place));
  try {
    return Permutation::from_old_to_new(std::move(old_to_new));
  } catch (const InvalidArgument& error) {
    throw InputError(path.string(), error.what(), "give a map that meshorder wrote");
  }
}

}  // namespace meshorder
