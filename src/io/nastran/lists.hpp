// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/nastran/references.hpp"
#include "io/stream/id_map.hpp"

#include <cstdint>
#include <vector>

namespace meshorder::nastran {

/// Returns the numbers in a list of a card that items of no file have but `others`, ascending, has. `found`
/// receives the positions of the items of the file that the list names, each once.
std::vector<std::int64_t> numbers_in_list(const std::vector<NumberRange>& ranges, const IdMap& items,
                                          const std::vector<std::int64_t>& others, std::vector<Index>& found);

}  // namespace meshorder::nastran
