// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/report/tables/tables.hpp"

#include <gtest/gtest.h>

namespace meshorder {
namespace {

TEST(Prose, TakesNamesForNoMarkup) {
  EXPECT_EQ(prose_as_markdown("saves 3 % on <b>my_mesh*</b>: run `order a_b.msh`."),
            "saves 3 % on \\<b\\>my\\_mesh\\*\\</b\\>: run `order a_b.msh`.");
  EXPECT_EQ(prose_as_markdown("a\n# heading `b`c`"), "a \\# heading `b`c\\`");
  EXPECT_EQ(prose_as_markdown("`\x1b[31m\n`"), "`\\u001b[31m\\u000a`");
  EXPECT_EQ(prose_as_html("3 % <b>&`a<b`"), "3\u00a0% &lt;b&gt;&amp;<code>a&lt;b</code>");
  EXPECT_EQ(prose_as_html("one ` alone"), "one ` alone");
}

TEST(MarkdownEscaped, ShowsControlCharacters) {
  EXPECT_EQ(markdown_escaped("a|b\x1b[31m\xff\u202e"), "a\\|b\\\\u001b\\[31m\\\\xff\\\\u202e");
}

}  // namespace
}  // namespace meshorder
