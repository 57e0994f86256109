// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "fuzz/families/families.hpp"

#include <vector>

namespace meshorder::fuzz {

void check_planted(std::string_view /*family*/, Family::Bytes input) {
  const std::vector<std::uint8_t> copy(input.begin(), input.end());
  if (copy.size() < 5 || copy[0] != '$' || copy[1] != 'M' || copy[2] != 'e' || copy[3] != 's') return;
  volatile std::uint8_t beyond = 0;
  if (copy[4] == 'h') beyond = *(copy.data() + copy.size());
  (void)beyond;
}

}  // namespace meshorder::fuzz
