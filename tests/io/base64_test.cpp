// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/stream/base64.hpp"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

namespace meshorder {
namespace {

TEST(Base64, GivesTheExamplesOfItsStandard) {
  // RFC 4648, section 10
  const std::vector<std::pair<std::string, std::string>> examples{{"", ""},
                                                                  {"f", "Zg=="},
                                                                  {"fo", "Zm8="},
                                                                  {"foo", "Zm9v"},
                                                                  {"foob", "Zm9vYg=="},
                                                                  {"fooba", "Zm9vYmE="},
                                                                  {"foobar", "Zm9vYmFy"}};
  for (const auto& [bytes, text] : examples) {
    EXPECT_EQ(to_base64(bytes), text);
    EXPECT_EQ(base64_length(bytes.size()), text.size());
  }
  EXPECT_EQ(to_base64(std::string("\xfb\xff\xfe")), "+//+");
}

TEST(Base64, DoesNotDependOnHowTheBytesCome) {
  Base64Encoder encoder;
  const std::string bytes = "foobar!";
  std::string text;
  for (const char byte : bytes) text += encoder.put({&byte, 1});
  EXPECT_EQ(text + encoder.finish(), to_base64(bytes));
}

TEST(Base64, DecodesWhatItEncodes) {
  std::string bytes;
  for (int k = 0; k < 1000; ++k) bytes += static_cast<char>(k * k % 251 - 100);
  for (std::size_t size = 0; size < 60; ++size) {
    const std::string part = bytes.substr(size * 7, size);
    std::string decoded(size, '?');
    EXPECT_TRUE(from_base64(to_base64(part) + "trailing", decoded));
    EXPECT_EQ(decoded, part);
  }
}

TEST(Base64, RefusesWhatIsNone) {
  std::string bytes(4, '?');
  EXPECT_TRUE(from_base64("Zm9vYg==", bytes));
  EXPECT_EQ(bytes, "foob");
  for (const std::string text : {"Zm9vY", "Zm 9vYg=", "Zm=vYg==", "Zm9vY===", "Zm9v\xffg==", "Zm9vYg=\n"})
    EXPECT_FALSE(from_base64(text, bytes)) << text;
}

}  // namespace
}  // namespace meshorder
