// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// A loop that adds up without a lock. In a build with ThreadSanitizer, this program must end with a report of
// the race.
#include "base/parallel.hpp"

#include <cstdio>

int main() {
  meshorder::Offset sum = 0;
  meshorder::parallel_loop(meshorder::Index{1000}, [&](meshorder::Index i) { sum += i; });
  return std::printf("%lld\n", static_cast<long long>(sum)) > 0 ? 0 : 1;
}
