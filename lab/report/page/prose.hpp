// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace meshorder {

// Sentences of a report, in which text in `backticks` is code and all else is plain: names in it are no
// markup.

/// Returns text as HTML, with a no-break space before per cent signs.
std::string prose_as_html(std::string text);

/// Returns text as one paragraph of Markdown.
std::string prose_as_markdown(std::string_view text);

}  // namespace meshorder
