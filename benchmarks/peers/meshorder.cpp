// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// This project's own solver, on one thread.
#include "peer.hpp"
#include "spectral/fiedler.hpp"

#include <tbb/global_control.h>

int main(int argc, char** argv) {
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  return peer::run(argc, argv, [](const peer::Arguments& arguments) {
    peer::measure(arguments.vector, [&] {
      return meshorder::fiedler_vectors(arguments.graph, {.tolerance = arguments.tolerance}).values;
    });
  });
}
