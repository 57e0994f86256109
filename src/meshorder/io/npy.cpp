// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// The format: NumPy Enhancement Proposal 1, "A Simple File Format for NumPy Arrays".
#include <meshorder/io/npy.hpp>
#include <meshorder/io/output_file.hpp>
#include <meshorder/io/scanner.hpp>

#include <bit>
#include <string>
#include <string_view>

namespace meshorder {
namespace {

constexpr std::string_view kMagic = "\x93NUMPY\x01";  // and the minor version 0
constexpr std::size_t kAlignment = 64;                // of the header, magic included
constexpr std::size_t kPreamble = 10;                 // magic, versions and the header's length

template <class T>
void write_array(std::span<const T> values, const std::filesystem::path& path) {
  std::string header =
      fmt::format("{{'descr': '<i{}', 'fortran_order': False, 'shape': ({},), }}", sizeof(T), values.size());
  header.append(kAlignment - (kPreamble + header.size() + 1) % kAlignment, ' ');
  header += '\n';
  OutputFile file(path);
  file.write(kMagic);
  file.binary<std::uint8_t>(0);
  file.binary<std::uint16_t>(static_cast<std::uint16_t>(header.size()), std::endian::little);
  file.write(header);
  for (const T value : values) file.binary(value, std::endian::little);
  file.commit();
}

/// What stands behind `'key':` in a header, up to the next comma outside parentheses.
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

void write_npy(std::span<const std::int32_t> values, const std::filesystem::path& path) {
  write_array(values, path);
}

void write_npy(std::span<const std::int64_t> values, const std::filesystem::path& path) {
  write_array(values, path);
}

std::vector<std::int64_t> read_npy(const std::filesystem::path& path) {
  Scanner file(path);
  if (file.binary_block(6, "the magic") != kMagic.substr(0, 6)) {
    file.fail_at_byte("is not a NumPy array", "give a file that numpy.save or meshorder wrote");
  }
  const auto major = file.binary<std::uint8_t>("the version");
  file.binary<std::uint8_t>("the version");
  const std::int64_t length =
      major == 1 ? std::int64_t{file.binary<std::uint16_t>("the length", std::endian::little)}
                 : std::int64_t{file.binary<std::uint32_t>("the length", std::endian::little)};
  const std::string header(file.binary_block(length, "the header"));
  const std::string_view type = header_value(file, header, "descr");
  std::string_view shape = header_value(file, header, "shape");
  if (shape.starts_with('(')) shape.remove_prefix(1);
  if (shape.ends_with(',')) shape.remove_suffix(1);
  if (shape.find(',') != std::string_view::npos) {
    file.fail_at_byte("has more than one dimension", "a map is a list of numbers");
  }
  const auto size = parse_integer<std::int64_t>(file, shape, "the number of entries");
  if (type.size() != 5 || (type[1] != '<' && type[1] != '>') || (type[2] != 'i' && type[2] != 'u') ||
      (type[3] != '4' && type[3] != '8')) {
    file.fail_at_byte("holds " + std::string(type), "32- or 64-bit integers are needed");
  }
  const std::endian order = type[1] == '<' ? std::endian::little : std::endian::big;
  const std::int64_t width = type[3] - '0';
  if (size < 0 || size > file.bytes_left() / width) {
    file.fail_at_byte("promises " + std::to_string(size) + " entries, but only " +
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

}  // namespace meshorder
