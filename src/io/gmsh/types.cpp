// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/gmsh/gmsh.hpp"

#include <algorithm>
#include <array>

// For the numbers see https://gmsh.info/doc/texinfo/gmsh.html#MSH-file-format and, for high orders,
// GmshDefines.h of Gmsh's sources. Left out are types without a fixed number of nodes (polygons 34,
// polyhedra 35, 67–70 of cut meshes, 133–136), types of order 0 (84–89, 132) and trihedra (140).

namespace meshorder::gmsh {
namespace {

// If two types have the same shape and number of nodes, `find_type(shape, nodes)` returns the first. The
// second is a serendipity element: 24, 40, 53 and 60. 138 and 139 are MINI elements.
constexpr auto kTypes = std::to_array<ElementType>({
    {1, Shape::line, 2},           {2, Shape::triangle, 3},       {3, Shape::quad, 4},
    {4, Shape::tetrahedron, 4},    {5, Shape::hexahedron, 8},     {6, Shape::wedge, 6},
    {7, Shape::pyramid, 5},        {8, Shape::line, 3},           {9, Shape::triangle, 6},
    {10, Shape::quad, 9},          {11, Shape::tetrahedron, 10},  {12, Shape::hexahedron, 27},
    {13, Shape::wedge, 18},        {14, Shape::pyramid, 14},      {15, Shape::vertex, 1},
    {16, Shape::quad, 8},          {17, Shape::hexahedron, 20},   {18, Shape::wedge, 15},
    {19, Shape::pyramid, 13},      {20, Shape::triangle, 9},      {21, Shape::triangle, 10},
    {22, Shape::triangle, 12},     {23, Shape::triangle, 15},     {24, Shape::triangle, 15},
    {25, Shape::triangle, 21},     {26, Shape::line, 4},          {27, Shape::line, 5},
    {28, Shape::line, 6},          {29, Shape::tetrahedron, 20},  {30, Shape::tetrahedron, 35},
    {31, Shape::tetrahedron, 56},  {32, Shape::tetrahedron, 22},  {33, Shape::tetrahedron, 28},
    {36, Shape::quad, 16},         {37, Shape::quad, 25},         {38, Shape::quad, 36},
    {39, Shape::quad, 12},         {40, Shape::quad, 16},         {41, Shape::quad, 20},
    {42, Shape::triangle, 28},     {43, Shape::triangle, 36},     {44, Shape::triangle, 45},
    {45, Shape::triangle, 55},     {46, Shape::triangle, 66},     {47, Shape::quad, 49},
    {48, Shape::quad, 64},         {49, Shape::quad, 81},         {50, Shape::quad, 100},
    {51, Shape::quad, 121},        {52, Shape::triangle, 18},     {53, Shape::triangle, 21},
    {54, Shape::triangle, 24},     {55, Shape::triangle, 27},     {56, Shape::triangle, 30},
    {57, Shape::quad, 24},         {58, Shape::quad, 28},         {59, Shape::quad, 32},
    {60, Shape::quad, 36},         {61, Shape::quad, 40},         {62, Shape::line, 7},
    {63, Shape::line, 8},          {64, Shape::line, 9},          {65, Shape::line, 10},
    {66, Shape::line, 11},         {71, Shape::tetrahedron, 84},  {72, Shape::tetrahedron, 120},
    {73, Shape::tetrahedron, 165}, {74, Shape::tetrahedron, 220}, {75, Shape::tetrahedron, 286},
    {79, Shape::tetrahedron, 34},  {80, Shape::tetrahedron, 40},  {81, Shape::tetrahedron, 46},
    {82, Shape::tetrahedron, 52},  {83, Shape::tetrahedron, 58},  {90, Shape::wedge, 40},
    {91, Shape::wedge, 75},        {92, Shape::hexahedron, 64},   {93, Shape::hexahedron, 125},
    {94, Shape::hexahedron, 216},  {95, Shape::hexahedron, 343},  {96, Shape::hexahedron, 512},
    {97, Shape::hexahedron, 729},  {98, Shape::hexahedron, 1000}, {99, Shape::hexahedron, 32},
    {100, Shape::hexahedron, 44},  {101, Shape::hexahedron, 56},  {102, Shape::hexahedron, 68},
    {103, Shape::hexahedron, 80},  {104, Shape::hexahedron, 92},  {105, Shape::hexahedron, 104},
    {106, Shape::wedge, 126},      {107, Shape::wedge, 196},      {108, Shape::wedge, 288},
    {109, Shape::wedge, 405},      {110, Shape::wedge, 550},      {111, Shape::wedge, 24},
    {112, Shape::wedge, 33},       {113, Shape::wedge, 42},       {114, Shape::wedge, 51},
    {115, Shape::wedge, 60},       {116, Shape::wedge, 69},       {117, Shape::wedge, 78},
    {118, Shape::pyramid, 30},     {119, Shape::pyramid, 55},     {120, Shape::pyramid, 91},
    {121, Shape::pyramid, 140},    {122, Shape::pyramid, 204},    {123, Shape::pyramid, 285},
    {124, Shape::pyramid, 385},    {125, Shape::pyramid, 21},     {126, Shape::pyramid, 29},
    {127, Shape::pyramid, 37},     {128, Shape::pyramid, 45},     {129, Shape::pyramid, 53},
    {130, Shape::pyramid, 61},     {131, Shape::pyramid, 69},     {137, Shape::tetrahedron, 16},
    {138, Shape::triangle, 4},     {139, Shape::tetrahedron, 5},
});

// Gmsh sorts the edges of a cell by their lower, then by their higher corner; VTK lists them face by face
constexpr std::array kTetrahedron10{0, 1, 2, 3, 4, 5, 6, 7, 9, 8};
constexpr std::array kPyramid14{0, 1, 2, 3, 4, 5, 8, 10, 6, 7, 9, 11, 12, 13};
constexpr std::array kWedge18{0, 1, 2, 3, 4, 5, 6, 9, 7, 12, 14, 13, 8, 10, 11, 15, 17, 16};
constexpr std::array kHexahedron27{0,  1,  2,  3,  4,  5,  6,  7,  8,  11, 13, 9,  16, 18,
                                   19, 17, 10, 12, 14, 15, 22, 23, 21, 24, 20, 25, 26};

}  // namespace

const ElementType* find_type(int number) {
  const auto found = std::find_if(kTypes.begin(), kTypes.end(),
                                  [number](const ElementType& type) { return type.number == number; });
  return found == kTypes.end() ? nullptr : &*found;
}

const ElementType* find_type(Shape shape, int nodes) {
  const auto found = std::find_if(kTypes.begin(), kTypes.end(), [=](const ElementType& type) {
    return type.shape == shape && type.nodes == nodes;
  });
  return found == kTypes.end() ? nullptr : &*found;
}

std::span<const int> vtk_order(Shape shape, int nodes) {
  if (shape == Shape::tetrahedron && nodes == 10) return kTetrahedron10;
  // serendipity cells lack the nodes on faces and inside, which come last in complete cells
  if (shape == Shape::pyramid && (nodes == 13 || nodes == 14)) return std::span(kPyramid14).first(nodes);
  if (shape == Shape::wedge && (nodes == 15 || nodes == 18)) return std::span(kWedge18).first(nodes);
  if (shape == Shape::hexahedron && (nodes == 20 || nodes == 27))
    return std::span(kHexahedron27).first(nodes);
  return {};
}

}  // namespace meshorder::gmsh
