// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace meshorder {

// Sentences of a report. Text in `backticks` is code; all other text is plain, so that no name in it acts as
// markup.

/// Returns text as HTML, with a no-break space before per cent signs.
std::string prose_as_html(std::string text);

/// Returns text as one paragraph of Markdown.
std::string prose_as_markdown(std::string_view text);

}  // namespace meshorder
