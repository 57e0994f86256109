// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/format.hpp"
#include "support/files.hpp"
#include "support/sample_meshes.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <span>
#include <string>
#include <thread>
#include <vector>

namespace meshorder {
namespace {

using test::TemporaryFolder;
using test::with;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

// XDMF 2: a triangle, two points, a line of three points and a quadrilateral, with coordinates axis by axis
// and numbers from 1
constexpr std::string_view kMixed = R"(<?xml version="1.0" ?>
<!DOCTYPE Xdmf SYSTEM "Xdmf.dtd" []>
<!-- made by hand -->
<Xdmf Version="2.0">
 <Domain>
  <Grid Name="g" GridType="Uniform">
   <Information Name="unit" Value="mm"/>
   <Topology TopologyType="Mixed" NumberOfElements="4" BaseOffset="1">
    <DataItem Dimensions="18" NumberType="Int" Format="XML">4 1 2 3  1 2 4 5  2 3 1 4 5  5 2 3 4 5 </DataItem>
   </Topology>
   <Geometry GeometryType="X_Y_Z">
    <DataItem Dimensions="5" Precision="8">0 1 0 0.1 -1e-3</DataItem>
    <DataItem Dimensions="5" Precision="4">0 0 1 0.5 2</DataItem>
    <DataItem Dimensions="5" Precision="8">0 0 0 1 +3</DataItem>
   </Geometry>
   <Attribute Name="t" AttributeType="Tensor6" Center="Cell">
    <DataItem Dimensions="4 6" Precision="8">1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24</DataItem>
   </Attribute>
   <Attribute Name="small" Center="Node">
    <DataItem Dimensions="5" NumberType="Char">-1 2 -3 4 127</DataItem>
   </Attribute>
   <Attribute Name="energy" Center="Grid"><DataItem Dimensions="1" Precision="8">42.5</DataItem></Attribute>
   <Set Name="some" SetType="Cell"><DataItem Dimensions="2" NumberType="Int">2 0</DataItem></Set>
   <Set Name="held" SetType="Node"><DataItem Dimensions="1" NumberType="Int">4</DataItem></Set>
  </Grid>
 </Domain>
</Xdmf>
)";

Mesh read_xdmf(std::string_view text, Notes* notes = nullptr) {
  const TemporaryFolder folder;
  return read_mesh(folder.file("m.xdmf", text), {.notes = notes});
}

std::string fault_of(std::string_view text) {
  try {
    (void)read_xdmf(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

/// The files of a mesh in memory.
using Files = std::map<std::string, std::string>;

Files files_of(const Mesh& mesh, Notes* notes = nullptr) {
  Files files;
  for (const MemoryFile& file : write_mesh_to_memory(mesh, "xdmf", "m.xdmf", notes).files) {
    files[file.name] = file.bytes;
  }
  return files;
}

Mesh read_files(const Files& files) {
  const std::string& xml = files.at("m.xdmf");
  return read_mesh(std::as_bytes(std::span(xml)), {.name = "m.xdmf", .companion = [&](std::string_view name) {
                                                     const auto found = files.find(std::string(name));
                                                     return found == files.end() ? std::string()
                                                                                 : found->second;
                                                   }});
}

TEST(Xdmf, WritesPlaneGeometryWhateverTheCaseOfItsType) {
  for (const char* const type : {"XY", "xy", "Xy", "xY"}) {
    const Mesh mesh =
        read_xdmf(fmt::format("<Xdmf><Domain><Grid><Topology TopologyType=\"Triangle\"><DataItem "
                              "Dimensions=\"1 3\" NumberType=\"Int\">"
                              "0 1 2</DataItem></Topology><Geometry GeometryType=\"{}\"><DataItem "
                              "Dimensions=\"3 2\" Precision=\"8\">"
                              "0 0 1 0 0.5 2</DataItem></Geometry></Grid></Domain></Xdmf>",
                              type));
    const TemporaryFolder folder;
    write_mesh(mesh, folder.path() / "b.xdmf");
    EXPECT_EQ(read_mesh(folder.path() / "b.xdmf").points, mesh.points) << type;
  }
}

TEST(Xdmf, ReadsMixedCellsAxesSetsAndNumberTypes) {
  Notes notes;
  const Mesh mesh = read_xdmf(kMixed, &notes);
  EXPECT_THAT(notes, IsEmpty());
  EXPECT_THAT(mesh.cells.shapes,
              ElementsAre(Shape::triangle, Shape::poly_vertex, Shape::polyline, Shape::quad));
  EXPECT_THAT(mesh.cells.vertices, ElementsAre(0, 1, 2, 3, 4, 0, 3, 4, 1, 2, 3, 4));
  EXPECT_EQ(mesh.points[3], (Point{0.1, 0.5, 1}));
  EXPECT_EQ(mesh.points[4], (Point{-1e-3, 2, 3}));
  ASSERT_EQ(mesh.data.size(), 2U);
  EXPECT_EQ(mesh.data[0].components, 6);
  EXPECT_EQ(mesh.data[1].values, Values(std::vector<std::int8_t>{-1, 2, -3, 4, 127}));
  EXPECT_THAT(mesh.sets, ElementsAre(EntitySet{"some", Association::cells, {2, 0}},
                                     EntitySet{"held", Association::vertices, {4}}));
  ASSERT_NE(mesh.format_metadata, nullptr);
  EXPECT_THAT(mesh.format_metadata->contents(),
              ElementsAre("the attribute 'energy' of the whole grid", "1 <Information> elements"));
}

TEST(Xdmf, WritesWhatItReadInTheSameWords) {
  const Mesh mesh = read_xdmf(kMixed);
  const Files files = files_of(mesh);
  ASSERT_EQ(files.size(), 1U);
  const std::string& text = files.at("m.xdmf");
  for (const char* const part :
       {"<!-- made by hand -->", "<Information Name=\"unit\" Value=\"mm\"/>", "BaseOffset=\"1\"",
        "GeometryType=\"X_Y_Z\"", "AttributeType=\"Tensor6\"", "<Xdmf Version=\"2.0\">",
        "<DataItem Dimensions=\"1\" Precision=\"8\">42.5</DataItem>"}) {
    EXPECT_THAT(text, HasSubstr(part));
  }
  const Mesh again = read_files(files);
  test::expect_same(again, mesh);
  EXPECT_EQ(files_of(again), files);
}

TEST(Xdmf, LeavesOutWhatTheMeshHasNoLonger) {
  Mesh mesh = read_xdmf(kMixed);
  mesh.data.erase(mesh.data.begin());
  mesh.sets.erase(mesh.sets.begin());
  const Files files = files_of(mesh);
  EXPECT_THAT(files.at("m.xdmf"), testing::Not(HasSubstr("Tensor6")));
  EXPECT_THAT(files.at("m.xdmf"), testing::Not(HasSubstr("\"some\"")));
  test::expect_same(read_files(files), mesh);
}

TEST(Xdmf, NamesTheTypeOfAnArrayThatGotOtherComponents) {
  Mesh mesh = read_xdmf(kMixed);
  for (const auto& [components, type] :
       {std::pair{3, "Vector"}, std::pair{1, "Scalar"}, std::pair{4, "Matrix"}}) {
    mesh.data[0].components = components;
    mesh.data[0].values = std::vector<double>(static_cast<std::size_t>(4 * components), 0.5);
    const Files files = files_of(mesh);
    EXPECT_THAT(files.at("m.xdmf"), HasSubstr(std::string("Name=\"t\" AttributeType=\"") + type + '"'));
    test::expect_same(read_files(files), mesh);
  }
}

TEST(Xdmf, MovesEverythingOfAMixedMesh) {
  const Mesh before = read_xdmf(kMixed);
  Mesh mesh = before;
  apply_reordering(mesh, test::shuffled(5, 3), test::shuffled_cells(mesh, 4));
  const Mesh moved = mesh;
  test::expect_same(read_files(files_of(mesh)), moved);
  EXPECT_NE(moved.points, before.points);
}

TEST(Xdmf, HoldsEveryTypeOfCells) {
  int held = 0;
  for (const auto& [shape, vertices] : test::common_types()) {
    SCOPED_TRACE(type_name(shape, vertices));
    Mesh mesh = test::cells_of_type(shape, vertices, 3);
    mesh.data.clear();
    mesh.sets.clear();
    if (!format_named("xdmf").holds(mesh, shape, vertices)) continue;
    ++held;
    const Mesh back = read_files(files_of(mesh));
    EXPECT_EQ(back.cells, mesh.cells);
    EXPECT_EQ(back.points, mesh.points);
    EXPECT_EQ(files_of(back), files_of(read_files(files_of(back))));
  }
  EXPECT_GE(held, 16);
}

TEST(Xdmf, WedgesHaveTheirFirstTriangleOutwardInTheFile) {
  Mesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
  mesh.cells.push_back(Shape::wedge, std::array<Index, 6>{0, 1, 2, 3, 4, 5});
  const Mesh back = read_files(files_of(mesh));
  EXPECT_EQ(back.cells, mesh.cells);
  // the same cell in a file's order, and in that of VTK 9.7
  const std::string text =
      "<Xdmf><Domain><Grid><Topology TopologyType=\"Wedge\"><DataItem Dimensions=\"1 6\" "
      "NumberType=\"Int\">0 2 1 3 5 4</DataItem></Topology><Geometry><DataItem Dimensions=\"6 3\">0 0 0 1 0 "
      "0 0 "
      "1 0 0 0 1 1 0 1 0 1 1</DataItem></Geometry></Grid></Domain></Xdmf>";
  EXPECT_EQ(read_xdmf(text).cells, mesh.cells);
  EXPECT_THAT(files_of(read_xdmf(text)).at("m.xdmf"), HasSubstr("0 2 1 3 5 4"));
  const std::string inward = with(text, "0 2 1 3 5 4", "0 1 2 3 4 5");
  EXPECT_EQ(read_xdmf(inward).cells, mesh.cells);
  EXPECT_THAT(files_of(read_xdmf(inward)).at("m.xdmf"), HasSubstr("0 1 2 3 4 5"));
}

TEST(Xdmf, SetsAndPartialArraysOfOtherFormatsBecomeArrays) {
  Mesh mesh = test::tetrahedral_bar(2);
  mesh.sets = {{"fixed", Association::vertices, {5, 2, 7}}, {"body", Association::cells, {0, 3}}};
  mesh.data = {
      {"some", Association::vertices, 1, std::vector<double>{1.5, 2.5}, {3, 0}, {}},
      {"texts", Association::vertices, 1, std::vector<std::string>(mesh.points.size(), "a"), {}, {}}};
  Notes notes;
  const Mesh back = read_files(files_of(mesh, &notes));
  EXPECT_THAT(notes, testing::UnorderedElementsAre(
                         HasSubstr("the array 'some' is given for some vertices; the others get NaN"),
                         HasSubstr("the array 'texts'"),
                         HasSubstr("the set 'fixed' of vertices is written as the array"),
                         HasSubstr("the set 'body' of cells is written as the array")));
  EXPECT_THAT(back.sets, testing::UnorderedElementsAreArray(mesh.sets));
  EXPECT_TRUE(std::isnan(std::get<std::vector<double>>(back.data.front().values)[1]));
}

TEST(Xdmf, PointsThatMoveInASeriesAreAnArrayOfEachStep) {
  const auto grid = [](const char* points, int step) {
    return fmt::format(
        "<Grid><Time Value=\"{}\"/><Topology TopologyType=\"Triangle\"><DataItem Dimensions=\"1 3\" "
        "NumberType=\"Int\">0 1 2</DataItem></Topology><Geometry GeometryType=\"XY\"><DataItem "
        "Dimensions=\"3 2\">{}</DataItem></Geometry></Grid>",
        step, points);
  };
  const std::string text =
      "<Xdmf Version=\"3.0\"><Domain><Grid GridType=\"Collection\" CollectionType=\"Temporal\">" +
      grid("0 0 1 0 0 1", 0) + grid("0 0 2 0 0 3", 1) + "</Grid></Domain></Xdmf>";
  Mesh mesh = read_xdmf(text);
  EXPECT_EQ(mesh.dimension, 2);
  ASSERT_EQ(mesh.data.size(), 1U);
  EXPECT_EQ(mesh.data[0].name, "points step 1");
  EXPECT_EQ(mesh.cell_count(), 1);
  apply_reordering(mesh, Permutation::from_old_to_new({2, 0, 1}), Permutation::identity(1));
  const std::string moved = files_of(mesh).at("m.xdmf");
  EXPECT_THAT(moved, HasSubstr("\n2 0\n0 3\n0 0\n"));
  EXPECT_EQ(moved.find("0 1 2"), std::string::npos);
  const std::string other = with(text, "\"Temporal\"", "\"Spatial\"");
  EXPECT_THAT(fault_of(other), HasSubstr("m.xdmf:1: a spatial collection holds several meshes"));
}

// two triangles, a line and points that Grids refer to
constexpr std::string_view kReferredTo = R"(<Xdmf Version="2.0">
 <Domain>
  <DataItem Name="points" Dimensions="4 2">0 0 1 0 1 1 0 1</DataItem>
  <DataItem Name="cells" Dimensions="12" NumberType="Int">4 0 1 2 2 2 3 0 4 0 2 3</DataItem>
  <Topology TopologyType="Mixed" NumberOfElements="3">
   <DataItem Reference="XML">/Xdmf/Domain/DataItem[2]</DataItem>
  </Topology>
  <Grid GridType="Collection" CollectionType="Temporal">
   <Grid Name="first">
    <Topology Reference="/Xdmf/Domain/Topology[1]"/>
    <Geometry GeometryType="XY"><DataItem Reference="XML">/Xdmf/Domain/DataItem[@Name="points"]</DataItem></Geometry>
   </Grid>
   <Grid Name="second">
    <Topology TopologyType="Mixed" NumberOfElements="3">
     <DataItem Reference="XML">/Xdmf/Domain/DataItem[2]</DataItem>
    </Topology>
    <Geometry GeometryType="XY"><DataItem Reference="XML">/Xdmf/Domain/DataItem[@Name="points"]</DataItem></Geometry>
   </Grid>
  </Grid>
 </Domain>
</Xdmf>
)";

TEST(Xdmf, WritesValuesThatGridsReferTo) {
  Mesh mesh = read_xdmf(kReferredTo);
  apply_reordering(mesh, Permutation::from_old_to_new({2, 0, 1, 3}), Permutation::from_old_to_new({2, 1, 0}));
  mesh.data.push_back(
      {.name = "u", .association = Association::vertices, .values = std::vector<double>{1, 2, 3, 4}});
  const Files files = files_of(mesh);
  const std::string& text = files.at("m.xdmf");
  EXPECT_THAT(text, HasSubstr(" <Domain>\n  <DataItem Name=\"points\" Dimensions=\"4 2\">\n1 0\n1 1\n0 0\n"));
  EXPECT_LT(text.find("<Grid Name=\"first\">"), text.find("<Attribute Name=\"u\""));
  EXPECT_LT(text.find("<Attribute Name=\"u\""), text.find("<Grid Name=\"second\">"));
  test::expect_same(read_files(files), mesh);
}

TEST(Xdmf, AnnouncesTheCellsThatStayInEachStep) {
  Mesh mesh = read_xdmf(kReferredTo);
  (void)keep_cells(mesh, {.dimension = 2});
  const std::string text = files_of(mesh).at("m.xdmf");
  EXPECT_THAT(text, HasSubstr("<Topology TopologyType=\"Mixed\" NumberOfElements=\"2\">\n   <DataItem"));
  EXPECT_THAT(text, HasSubstr("<Topology TopologyType=\"Mixed\" NumberOfElements=\"2\">\n     <DataItem"));
  EXPECT_THAT(text, Not(HasSubstr("NumberOfElements=\"3\"")));
}

TEST(Xdmf, FaultsNameTheLine) {
  const std::string text(kMixed);
  const std::vector<std::pair<std::string, std::pair<std::string, std::string>>> faults{
      {"m.xdmf:9: cell 0 (counted from 0) names a point that does not exist", {"4 1 2 3", "4 0 2 3"}},
      {"m.xdmf:9: the mixed Topology is damaged", {"4 1 2 3", "99 1 2 3"}},
      {"m.xdmf:9: the DataItem has 17 values", {"4 1 2 3", "4 1 2"}},
      {"m.xdmf:9: '0x' is not a number", {"4 1 2 3", "4 0x 2 3"}},
      {"m.xdmf:9: '99999999999' is not a number", {"4 1 2 3", "4 99999999999 2 3"}},
      {"m.xdmf:9: Dimensions is '-18'", {"\"18\"", "\"-18\""}},
      {"m.xdmf:9: the numbers are 'Int' of 3 bytes", {"\"Int\"", "\"Int\" Precision=\"3\""}},
      {"m.xdmf:9: the Format is 'netCDF'", {"\"XML\"", "\"netCDF\""}},
      {"m.xdmf:12: point 1 (counted from 0) has a coordinate that is not finite",
       {"0 1 0 0.1", "0 nan 0 0.1"}},
      {"m.xdmf:11: the Geometry has 3 DataItems", {"X_Y_Z", "XYZ"}},
      {"m.xdmf:11: the GeometryType is 'ORIGIN_DXDYDZ'", {"X_Y_Z", "ORIGIN_DXDYDZ"}},
      {"m.xdmf:8: the TopologyType is '3DSMesh', which is structured", {"Mixed", "3DSMesh"}},
      {"m.xdmf:16: the attribute 't' is on each Edge",
       {"Cell\">\n    <DataItem Dimensions=\"4", "Edge\">\n    <DataItem Dimensions=\"4"}},
      {"m.xdmf:23: the set 'some' names 4", {">2 0<", ">2 4<"}},
      {"m.xdmf:23: the set 'some' names 2 twice", {">2 0<", ">2 2<"}},
      {"the XML is malformed", {"</Grid>", ""}},
      {"there is no <Domain>", {"<Domain>", "<Dom>"}},
  };
  for (const auto& [fault, change] : faults) {
    std::string broken = with(text, change.first, change.second);
    if (fault == "there is no <Domain>") broken = with(broken, "</Domain>", "</Dom>");
    EXPECT_THAT(fault_of(broken), HasSubstr(fault));
  }
  EXPECT_THAT(fault_of(with(with(text, "\"4 6\"", "\"23\""), " 24<", "<")),
              HasSubstr("m.xdmf:16: the attribute 't' has 23 values; the Grid has 4 cells"));
  EXPECT_THAT(fault_of("<Xdmf"), HasSubstr("malformed"));
  EXPECT_THAT(fault_of("<VTKFile/>"), HasSubstr("the file is a <VTKFile>"));
}

/// kMixed with declarations in its DOCTYPE, and one change.
std::string declared(const std::string& declarations, std::string_view what = "", std::string_view by = "") {
  return with(with(std::string(kMixed), "[]", "[" + declarations + "]"), what, by);
}

TEST(Xdmf, NumbersInAttributesMayHaveBlanksAndASign) {
  const std::string binary = R"(<Xdmf Version="3.0"><Domain><Grid>
   <Topology TopologyType="Polyline" NumberOfElements="2" NodesPerElement="3">
    <DataItem Dimensions="2 3" NumberType="Int" Precision="4" Format="XML">0 1 2 2 3 4</DataItem></Topology>
   <Geometry GeometryType="XYZ">
    <DataItem Dimensions="5 3" Precision="8" Format="Binary" Endian="Little" Seek="8">points.bin</DataItem>
   </Geometry></Grid></Domain></Xdmf>)";
  const TemporaryFolder folder;
  std::string bytes(8, 'x');
  for (int k = 0; k < 15; ++k) {
    const auto number = std::bit_cast<std::array<char, 8>>(k / 2.0);
    bytes.append(number.data(), number.size());
  }
  (void)folder.file("points.bin", bytes);
  for (const std::string& text : {std::string(kMixed), binary}) {
    const Mesh mesh = read_mesh(folder.file("a.xdmf", text));
    for (const std::string attribute :
         {"NumberOfElements", "BaseOffset", "NodesPerElement", "Dimensions", "Precision", "Seek"}) {
      const std::string begin = attribute + "=\"";
      std::string changed = text;
      for (std::size_t at = changed.find(begin); at != std::string::npos; at = changed.find(begin, at + 1)) {
        changed.insert(at + begin.size(), " \n\t+");
        changed.insert(changed.find('"', at + begin.size()), " \r\n");
      }
      const Mesh found = read_mesh(folder.file("b.xdmf", changed));
      EXPECT_EQ(found.points, mesh.points) << attribute;
      EXPECT_EQ(found.cells, mesh.cells) << attribute;
      EXPECT_EQ(found.data, mesh.data) << attribute;
    }
  }
  for (const std::string attribute : {"NodesPerElement=\"3", "Precision=\"8", "Seek=\"8"}) {
    const std::string fault =
        attribute.substr(0, attribute.find('=')) + " is '8 3'; a whole number is needed";
    const std::string changed = with(binary, attribute, attribute.substr(0, attribute.size() - 1) + "8 3");
    EXPECT_THAT(test::read_error(folder.file("c.xdmf", changed)), HasSubstr(fault));
  }
  EXPECT_THAT(fault_of(with(std::string(kMixed), "BaseOffset=\"1\"", "BaseOffset=\"one\"")),
              HasSubstr("m.xdmf:8: BaseOffset is 'one'"));
  EXPECT_THAT(fault_of(with(std::string(kMixed), "Elements=\"4\"", "Elements=\"4x\"")),
              HasSubstr("m.xdmf:8: NumberOfElements is '4x'"));
}

TEST(Xdmf, EntitiesOfTheDoctypeStandForTheirText) {
  const Mesh plain = read_xdmf(kMixed);
  for (const auto& [declarations, what, by] : std::vector<std::array<std::string, 3>>{
           {"<!ENTITY u \"mm\">", "\"mm\"", "\"&u;\""},
           {"<!-- <!ENTITY u \"cm\"> --><?x ]?><!ELEMENT g ANY>\n<!ENTITY u 'mm'><!ENTITY u 'cm'>", "\"mm\"",
            "\"&u;\""},
           {"<!ENTITY all '4 1 &rest; '>\n<!ENTITY rest '2 3'>", "4 1 2 3", "&all;"},
           {"<!ENTITY i '<DataItem Dimensions=\"2\" NumberType=\"Int\">2 0&#60;/DataItem>'>",
            "<DataItem Dimensions=\"2\" NumberType=\"Int\">2 0</DataItem>", "&i;"},
           {"<!ENTITY % unused 'x'><!ENTITY far SYSTEM \"/etc/passwd\">", "", ""},
           {"<!ENTITY e 'x'>", "made by hand", "&e; &none;"},
           {"<!ENTITY point '4&#x20;1'>", "4 1 2 3", "&point; 2 3"}}) {
    test::expect_same(read_xdmf(declared(declarations, what, by)), plain);
  }
  const Mesh named = read_xdmf(declared("<!ENTITY q '\"&#38;amp;&apos;'>", "\"some\"", "\"a&q;\""));
  EXPECT_EQ(named.sets.front().name, "a\"&'");
}

TEST(Xdmf, FaultsOfEntitiesNameTheLine) {
  std::string nested = "<!ENTITY e0 '0123456789'>";
  std::string deep = nested;
  for (int k = 1; k < 1000; ++k) {
    const std::string before = fmt::format("&e{};", k - 1);
    nested += fmt::format("<!ENTITY e{} '{}{}{}{}'>", k, before, before, before, before);
    deep += fmt::format("<!ENTITY e{} '{}'>", k, before);
  }
  const std::string large = "<!ENTITY e '" + std::string(1 << 20, ' ') + "'>";
  std::string often;
  for (int k = 0; k < 20; ++k) often += "&e;";
  for (const auto& [declarations, by, fault] : std::vector<std::array<std::string, 3>>{
           {"<!ENTITY e 'x'>", "&f;", "m.xdmf:9: the entity 'f' is not declared"},
           {"<!ENTITY e SYSTEM \"/etc/passwd\">", "&e;", "m.xdmf:9: the entity 'e' is in another file"},
           {"<!ENTITY e 'a&e;'>", "&e;", "m.xdmf:9: the entity 'e' refers to itself"},
           {"<!ENTITY e '&f;'><!ENTITY f '&e;'>", "&e;", "refers to itself"},
           {nested, "&e25;", "more than 16 MiB longer"},
           {large, often, "more than 16 MiB longer"},
           {deep, "&e999;", "too deep"},
           {"<!ENTITY e '&#0;'>", "&e;", "m.xdmf:2: an entity has a character"},
           {"<!ENTITY % p \"<!ENTITY e 'x'>\">\n%p;", "&e;", "m.xdmf:3: the DOCTYPE uses a parameter entity"},
           {"<!ATTLIST Grid Name CDATA 'g'>", "4", "m.xdmf:2: the DOCTYPE gives attributes defaults"},
           {"<!ENTITY e>", "4", "m.xdmf:2: the DOCTYPE is malformed"},
           {"<!ENTITY e 'x", "4", "m.xdmf:"}}) {
    EXPECT_THAT(fault_of(declared(declarations, "4 1 2 3", by + " 1 2 3")), HasSubstr(fault));
  }
  EXPECT_THAT(fault_of(declared("<!ENTITY e 'a&#60;b'>", "\"mm\"", "\"&e;\"")), HasSubstr("has a <"));
}

TEST(Xdmf, ATruncatedFileIsAFaultOrTheSameMesh) {
  const Files files = files_of(test::mixed_mesh());
  const Mesh whole = read_files(files);
  for (const auto& [name, bytes] : files) {
    for (std::size_t size = 0; size < bytes.size(); size += 1 + bytes.size() / 97) {
      Files cut = files;
      cut[name] = bytes.substr(0, size);
      try {
        EXPECT_EQ(read_files(cut).cells, whole.cells);
      } catch (const InputError& error) {
        EXPECT_EQ(std::string_view(error.what()).find('\n'), std::string_view::npos);
      }
    }
  }
}

TEST(Xdmf, DiffersFromVtkInItsFirstElement) {
  EXPECT_EQ(format_of_bytes(kMixed)->name, "XDMF");
  EXPECT_EQ(format_of_bytes("<Xdmf Version=\"3.0\">")->name, "XDMF");
  EXPECT_EQ(format_of_bytes("<?xml version=\"1.0\"?>\n<VTKFile><Xdmf>")->name, "VTU");
}

TEST(Xdmf, MayBeReadAndWrittenByManyThreads) {
  const Mesh mesh = test::tetrahedral_bar(3);
  const Files expected = files_of(mesh);
  std::vector<std::thread> threads;
  std::array<bool, 4> same{};
  for (bool& one : same) {
    threads.emplace_back([&] {
      one = true;
      for (int i = 0; i < 10; ++i) one = one && read_files(files_of(mesh)).cells == mesh.cells;
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_THAT(same, testing::Each(true));
}

}  // namespace
}  // namespace meshorder
