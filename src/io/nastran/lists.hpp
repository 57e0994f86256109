// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/nastran/references.hpp"
#include "io/stream/id_map.hpp"

#include <cstdint>
#include <vector>

namespace meshorder::nastran {

/// Returns those of `others` (ascending) that the list of a card names. `found` receives the positions of the
/// file's items that the list names, each once.
std::vector<std::int64_t> numbers_in_list(const std::vector<NumberRange>& ranges, const IdMap& items,
                                          const std::vector<std::int64_t>& others, std::vector<Index>& found);

}  // namespace meshorder::nastran
