// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/scenario/motion_file.hpp"

#include "support/files.hpp"
#include <meshorder/error.hpp>

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <utility>
#include <vector>

namespace meshorder {
namespace {

using test::TemporaryFolder;

TEST(MotionFile, GivesBackFramesInSinglePrecision) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "a.npy";
  MotionFile file(path, 2);
  const std::vector<Point> first{{0.1, 1, 2}, {3, 4, 5}};
  const std::vector<Point> second{{-1, 1e-9, 0}, {6, 7, 8}};
  file.add(first);
  file.add(second);
  EXPECT_FALSE(std::filesystem::exists(path));  // before it is complete
  file.commit();
  const Motion motion = read_motion(path);
  EXPECT_EQ(motion.vertices, 2);
  ASSERT_EQ(motion.frames.size(), 2U);
  EXPECT_EQ(motion.frames[0][0][0], 0.1F);
  EXPECT_EQ(motion.frames[1][0], (std::array{-1.0F, 1e-9F, 0.0F}));
  EXPECT_EQ(motion.frames[1][1], (std::array{6.0F, 7.0F, 8.0F}));
}

TEST(MotionFile, IsWhatNumpyLoads) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "a.npy";
  MotionFile file(path, 1);
  file.add(std::vector<Point>{{1, 2, 3}});
  file.commit();
  const std::string content = test::content_of(path);
  EXPECT_EQ(content.substr(10, 64), "{'descr': '<f4', 'fortran_order': False, 'shape': (1, 1, 3), }  ");
  EXPECT_EQ(content.size(), 128 + 12U);
  EXPECT_EQ(content.substr(128, 4), std::string("\0\0\x80\x3f", 4));
}

TEST(MotionFile, TakesOnlyFramesOfAllVertices) {
  const TemporaryFolder folder;
  MotionFile file(folder.path() / "a.npy", 2);
  EXPECT_THROW(file.add(std::vector<Point>{{0, 0, 0}}), InvalidArgument);
}

TEST(MotionFile, LeavesNoFileWithoutACommit) {
  const TemporaryFolder folder;
  { MotionFile(folder.path() / "a.npy", 1).add(std::vector<Point>{{0, 0, 0}}); }
  EXPECT_TRUE(folder.names().empty());
}

TEST(MotionFile, BrokenFilesAreErrorsWithTheirNames) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "a.npy";
  MotionFile file(path, 1);
  file.add(std::vector<Point>{{1, 2, 3}});
  file.commit();
  const std::string content = test::content_of(path);
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string text = content;
    return text.replace(text.find(from), from.size(), to);
  };
  std::string not_finite = content;
  not_finite.replace(128, 4, std::string("\0\0\xc0\x7f", 4));
  const std::vector<std::pair<std::string, std::string>> files{
      {content.substr(0, content.size() - 1), "should have 1 frames of 1 vertices, but only 11 bytes"},
      {changed("(1, 1, 3)", "(9, 1, 3)"), "should have 9 frames"},
      {changed("(1, 1,", "(-1,1,"), "should have -1 frames"},
      {changed("<f4", "<f8"), "is not a motion"},
      {changed("False", "True "), "is not a motion"},
      {changed("(1, 1, 3)", "(1, 3, 1)"), "is not a motion"},
      {not_finite, "not finite"}};
  for (const auto& [broken, expected] : files) {
    try {
      (void)read_motion(folder.file("b.npy", broken));
      ADD_FAILURE() << "read it; expected: " << expected;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("b.npy"), std::string::npos);
      EXPECT_NE(std::string(error.what()).find(expected), std::string::npos) << error.what();
    }
  }
}

TEST(SurfaceFile, GivesBackTheTrianglesOfEachFrame) {
  using Triangles = std::vector<std::array<Index, 3>>;
  const TemporaryFolder folder;
  const auto path = folder.path() / "a.npy";
  SurfaceFile file(path);
  file.add(Triangles{{0, 1, 2}, {2, 1, 3}});
  file.add(Triangles{});
  file.add(Triangles{{3, 0, 1}});
  EXPECT_FALSE(std::filesystem::exists(path));  // before it is complete
  file.commit();
  const std::vector<Triangles> surfaces = read_surfaces(path, 3, 4);
  EXPECT_EQ(surfaces, (std::vector<Triangles>{{{0, 1, 2}, {2, 1, 3}}, {}, {{3, 0, 1}}}));
  EXPECT_THROW(read_surfaces(path, 2, 4), Error);  // the file has more frames
  EXPECT_THROW(read_surfaces(path, 3, 3), Error);  // the file has more vertices
  const std::string content = test::content_of(path);
  EXPECT_EQ(content.substr(10, 58), "{'descr': '<i4', 'fortran_order': False, 'shape': (3, 4), ");
  for (const std::string& broken :
       {content.substr(0, content.size() - 1), std::string("NUMPY"), "\x93" + content.substr(2)}) {
    EXPECT_THROW(read_surfaces(folder.file("broken.npy", broken), 3, 4), Error);
  }
}

}  // namespace
}  // namespace meshorder
