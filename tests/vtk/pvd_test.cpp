// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/vtu.hpp"
#include "support/files.hpp"
#include <meshorder/error.hpp>

#include <gtest/gtest.h>
#include <vtkNew.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLDataParser.h>

#include <limits>
#include <string>
#include <vector>

namespace meshorder {
namespace {

TEST(Pvd, VtkReadsTheSameTimesAndFiles) {
  const test::TemporaryFolder folder;
  const std::vector<PvdEntry> entries{
      {0, "a-000000.vtu"}, {0.1, "a-000001.vtu"}, {1.0 / 3, "<b> & \"c\".vtu"}, {1e-300, "d.vtu"}};
  const auto path = folder.path() / "a.pvd";
  write_pvd(entries, path);
  EXPECT_EQ(folder.names(), std::vector<std::string>{"a.pvd"});

  vtkNew<vtkXMLDataParser> parser;
  parser->SetFileName(path.c_str());
  ASSERT_EQ(parser->Parse(), 1);
  vtkXMLDataElement* const root = parser->GetRootElement();
  EXPECT_STREQ(root->GetName(), "VTKFile");
  EXPECT_STREQ(root->GetAttribute("type"), "Collection");
  vtkXMLDataElement* const collection = root->FindNestedElementWithName("Collection");
  ASSERT_NE(collection, nullptr);
  ASSERT_EQ(collection->GetNumberOfNestedElements(), static_cast<int>(entries.size()));
  for (std::size_t i = 0; i < entries.size(); ++i) {
    vtkXMLDataElement* const entry = collection->GetNestedElement(static_cast<int>(i));
    EXPECT_STREQ(entry->GetName(), "DataSet");
    EXPECT_EQ(std::stod(entry->GetAttribute("timestep")), entries[i].time);
    EXPECT_EQ(entry->GetAttribute("file"), entries[i].file);
  }
}

TEST(Pvd, ReplacesTheLastOneWhole) {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "a.pvd";
  write_pvd(std::vector<PvdEntry>(100, {1, "frame.vtu"}), path);
  write_pvd(std::vector<PvdEntry>(1, {1, "frame.vtu"}), path);
  const std::string content = test::content_of(path);
  EXPECT_EQ(content.find("frame.vtu"), content.rfind("frame.vtu"));
  EXPECT_THROW(
      write_pvd(std::vector<PvdEntry>(1, {std::numeric_limits<double>::quiet_NaN(), "frame.vtu"}), path),
      InvalidArgument);
  EXPECT_EQ(test::content_of(path), content);
  EXPECT_THROW(write_pvd({}, folder.path() / "absent" / "a.pvd"), InputError);
}

}  // namespace
}  // namespace meshorder
