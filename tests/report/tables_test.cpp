// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include <meshorder/report/tables.hpp>

#include "sample_results.hpp"

#include <gtest/gtest.h>

#include <cstdio>

namespace {

using namespace meshorder;

TEST(Tables, Print) { std::puts(to_markdown(tables_of(test::sample_results())).c_str()); std::puts(to_csv(tables_of(test::sample_results())).substr(0,1500).c_str());}

}  // namespace
