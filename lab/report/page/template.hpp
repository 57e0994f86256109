// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace meshorder {

/// `text` with what `value_of` gives for each placeholder: for `{{table speedup}}` it is called with "table
/// speedup". Values are taken as they are, placeholders in them are none. Throws InvalidArgument for a
/// placeholder without end. O(size of the result).
std::string fill_template(std::string_view text,
                          const std::function<std::string(std::string_view)>& value_of);

}  // namespace meshorder
