// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/stream/base64.hpp"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace meshorder
