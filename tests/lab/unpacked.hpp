// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "base/point.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <zlib.h>

#include <cstdint>
#include <string>
#include <vector>

namespace meshorder::test {

/// The content of the script element with that id; "" if there is none.
inline std::string script_content(const std::string& html, const std::string& id) {
  const auto named = html.find("id=\"" + id + "\"");
  if (named == std::string::npos) return "";
  const auto begin = html.find('>', named) + 1;
  return html.substr(begin, html.find("</script", begin) - begin);
}

inline std::string from_base64(const std::string& text) {
  const std::string alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int held = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = bits << 6U | static_cast<std::uint32_t>(alphabet.find(c));
    held += 6;
    if (held >= 8) bytes += static_cast<char>(bits >> (held -= 8) & 0xFFU);
  }
  return bytes;
}

/// The numbers of an array of a manifest, by the format of viewer/README.md.
inline std::vector<std::uint32_t> unpacked(const std::string& html, const nlohmann::ordered_json& array) {
  const std::string packed = from_base64(script_content(html, array["blob"]));
  const std::string type = array["type"];
  const std::size_t width = type == "uint8" ? 1 : type == "uint16" ? 2 : type == "uint32" ? 4 : 0;
  std::size_t count = 1;
  for (const std::size_t side : array["shape"]) count *= side;
  std::string bytes(width * count + 1, '\0');
  uLongf size = bytes.size();
  EXPECT_EQ(::uncompress(reinterpret_cast<Bytef*>(bytes.data()), &size,
                         reinterpret_cast<const Bytef*>(packed.data()), packed.size()),
            Z_OK);
  EXPECT_EQ(size, width * count) << array.dump();
  std::vector<std::uint32_t> numbers(count);
  for (std::size_t i = 0; i < count * width; ++i)
    numbers[i / width] |= std::uint32_t{static_cast<unsigned char>(bytes[i])} << 8 * (i % width);
  if (array.value("delta", false)) {
    const std::size_t frame = count / array["shape"][0].get<std::size_t>();
    for (std::size_t i = frame; i < count; ++i) numbers[i] = (numbers[i] + numbers[i - frame]) & 0xFFFFU;
  }
  return numbers;
}

/// The coordinates of an array of positions.
inline std::vector<Point> unpacked_places(const std::string& html, const nlohmann::ordered_json& array) {
  const std::vector<std::uint32_t> numbers = unpacked(html, array);
  std::vector<Point> places(numbers.size() / 3);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    places[i / 3][i % 3] =
        array["offset"][i % 3].get<double>() + array["scale"][i % 3].get<double>() * numbers[i];
  }
  return places;
}

}  // namespace meshorder::test
