// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include <meshorder/report/figures.hpp>

#include "sample_results.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

namespace {

using namespace meshorder;

TEST(Figures, Print) {
  for (const Figure& f : figures_of(test::sample_results())) std::ofstream("/tmp/gp/" + f.name + ".svg") << f.svg;
}

}  // namespace
