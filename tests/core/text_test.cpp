// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/text.hpp"

#include <meshorder/error.hpp>

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace meshorder {
namespace {

using namespace std::string_literals;

// constant expressions do not depend on the locale, as std::tolower does
static_assert(same_but_for_case("MESH.INP", "mesh.inp"));
static_assert(!same_but_for_case("a", "ab"));
static_assert(!same_but_for_case("[", "{"));

TEST(Text, ChangesTheCaseOfAsciiLettersOnly) {
  EXPECT_EQ(lower_case("AZ[\xC4Ä1"), "az[\xC4Ä1");
  EXPECT_EQ(upper_case("az{\xE4ä1"), "AZ{\xE4ä1");
}

TEST(Visible, ShowsWhatATerminalWouldActOn) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"", ""},
      {"Plate – Größe 3 %", "Plate – Größe 3 %"},
      {"\x1b[31mred", "\\u001b[31mred"},
      {"a\ab\bc\rd\ne\tf", "a\\u0007b\\u0008c\\u000dd\\u000ae\\u0009f"},
      {"a\0b"s, "a\\u0000b"},
      {"a\x7f", "a\\u007f"},
      {"\u009b31m", "\\u009b31m"},                            // CSI as one character
      {"a\u202eb\u2066c\u200f", "a\\u202eb\\u2066c\\u200f"},  // direction of writing
      {"a\u2028b", "a\\u2028b"},
      {"Stra\xdf"
       "e",
       "Stra\\xdfe"},
      {"\xc0\x80", "\\xc0\\x80"},  // overlong
      {"\xe0\x80\x80", "\\xe0\\x80\\x80"},
      {"\xed\xa0\x80", "\\xed\\xa0\\x80"},           // a surrogate
      {"\xf4\x90\x80\x80", "\\xf4\\x90\\x80\\x80"},  // above U+10FFFF
      {"\xe2\x82", "\\xe2\\x82"},                    // cut
      {"\U0001F600", "\U0001F600"},
  };
  for (const auto& [text, expected] : cases) EXPECT_EQ(visible(text), expected);
  EXPECT_EQ(visible("a\nb\x1b", "\n"), "a\nb\\u001b");
}

TEST(IsUtf8, RefusesWhatIsNone) {
  EXPECT_TRUE(is_utf8("Größe \U0001F600\x1b"));
  for (const std::string_view text :
       {"\xff", "a\xdf", "\xe2\x82", "\xc1\xbf", "\xed\xbf\xbf", "\xf5\x80\x80\x80"})
    EXPECT_FALSE(is_utf8(text)) << visible(text);
}

TEST(InputError, IsOneLineWhateverTheNames) {
  const InputError error(Location{"a\nb.exo", 0, 7}, "els\n\x1b has too many dimensions", "a remedy");
  EXPECT_STREQ(error.what(), "a\\u000ab.exo: byte 7: els\\u000a\\u001b has too many dimensions; a remedy");
  EXPECT_EQ(error.location().file, "a\nb.exo");
}

TEST(Utf8Prefix, EndsWithAWholeCharacter) {
  EXPECT_EQ(utf8_prefix("abc", 3), "abc");
  EXPECT_EQ(utf8_prefix("abcd", 3), "abc");
  EXPECT_EQ(utf8_prefix("ab€", 4), "ab");
  EXPECT_EQ(utf8_prefix("ab€", 5), "ab€");
  EXPECT_EQ(utf8_prefix("a\U0001F600b", 4), "a");
  EXPECT_EQ(utf8_prefix("a\U0001F600b", 5), "a\U0001F600");
  // not UTF-8: cut at the requested byte
  EXPECT_EQ(utf8_prefix("\x80\x80\x80\x80\x80\x80", 5), "\x80\x80\x80\x80\x80");
}

TEST(XmlEscaped, GivesWhatXmlAllows) {
  EXPECT_EQ(xml_escaped("<a href=\"x\">&</a>"), "&lt;a href=&quot;x&quot;&gt;&amp;&lt;/a&gt;");
  EXPECT_EQ(xml_escaped("a\tb\nc\r"), "a&#9;b&#10;c&#13;");
  EXPECT_EQ(xml_escaped("\x1b\x01\xff\uffff\u202e"), "\\u001b\\u0001\\xff\\uffff\u202e");
}

}  // namespace
}  // namespace meshorder
