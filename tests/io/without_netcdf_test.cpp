// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// A separate program, linked with format.cpp as a build without optional libraries compiles it.
#include "io/format.hpp"
#include <meshorder/error.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace meshorder {
namespace {

using testing::HasSubstr;

template <class Call>
std::string refusal(const Call& call) {
  try {
    call();
  } catch (const Unavailable& error) {
    return error.what();
  }
  return "not refused";
}

TEST(WithoutNetcdf, AnExodusFileIsRefusedByNameOfLibraryAndOption) {
  for (const char* const name : {"a.exo", "a.E", "a.ex2", "a.g"}) {
    const std::string message = refusal([&] { (void)format_of(name); });
    EXPECT_THAT(message,
                HasSubstr(std::string(name) + ": Exodus needs netCDF, which this build of meshorder lacks"));
    EXPECT_THAT(message, HasSubstr("MESHORDER_NETCDF=ON"));
  }
  EXPECT_THAT(refusal([] { (void)format_named("exodus"); }), HasSubstr("MESHORDER_NETCDF=ON"));
  EXPECT_THAT(refusal([] {
                (void)format_of_bytes(
                    "CDF\x02"
                    "and more");
              }),
              HasSubstr("MESHORDER_NETCDF=ON"));
}

TEST(WithoutCgns, ACgnsFileIsRefusedByNameOfLibraryAndOption) {
  const std::string message = refusal([] { (void)format_of("a.cgns"); });
  EXPECT_THAT(message, HasSubstr("a.cgns: CGNS needs the CGNS library, which this build of meshorder lacks"));
  EXPECT_THAT(message, HasSubstr("MESHORDER_CGNS=ON"));
}

}  // namespace
}  // namespace meshorder
