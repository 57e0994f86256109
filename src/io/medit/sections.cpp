// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/text.hpp"
#include "io/medit/medit.hpp"

#include <algorithm>

namespace meshorder::medit {
namespace {

/// A reference cell: the coordinates of its corners, and the pairs of corners that have a node halfway
/// between them, two digits for each pair.
struct Reference {
  std::vector<std::vector<int>> corners;
  std::string_view middles;
};

Reference reference(Shape shape) {
  switch (shape) {
    case Shape::line:
      return {{{0}, {2}}, "01"};
    case Shape::triangle:
      return {{{2, 0, 0}, {0, 2, 0}, {0, 0, 2}}, "01 12 20"};
    case Shape::quad:
      return {{{0, 0}, {2, 0}, {2, 2}, {0, 2}}, "01 12 23 30 02"};
    case Shape::tetrahedron:
      return {{{2, 0, 0, 0}, {0, 2, 0, 0}, {0, 0, 2, 0}, {0, 0, 0, 2}}, "01 12 20 03 13 23"};
    case Shape::pyramid:
      return {{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {0, 0, 2}}, "01 12 23 30 04 14 24 34 02"};
    case Shape::wedge:
      return {{{2, 0, 0, 0}, {0, 2, 0, 0}, {0, 0, 2, 0}, {2, 0, 0, 2}, {0, 2, 0, 2}, {0, 0, 2, 2}},
              "01 12 20 34 45 53 03 14 25 04 15 23"};
    case Shape::hexahedron:
      return {{{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {0, 0, 2}, {2, 0, 2}, {2, 2, 2}, {0, 2, 2}},
              "01 12 23 30 45 56 67 74 04 15 26 37 07 16 05 27 02 46 06"};
    default:
      return {};
  }
}

}  // namespace

std::vector<std::string> MeditMetadata::contents() const {
  std::vector<std::string> result;
  for (const VerbatimSection& section : sections) result.push_back("Medit's " + section.keyword);
  for (const Rows& section : rows) result.push_back("Medit's " + section.keyword);
  return result;
}

std::shared_ptr<const FormatMetadata> MeditMetadata::moved(std::span<const Index> vertices,
                                                           std::span<const Index> cells) const {
  if (rows.empty()) return nullptr;
  auto result = std::make_shared<MeditMetadata>(*this);
  for (Rows& section : result->rows) {
    std::size_t next = 0;
    while (next < section.items.size()) {
      for (const char column : section.columns) {
        if (column == '.') continue;
        const std::span<const Index> new_places = target_of(column) ? cells : vertices;
        Index& item = section.items[next++];
        if (!new_places.empty() && item >= 0) item = new_places[item];
      }
    }
  }
  return result;
}

Target target_of(char column) {
  switch (column) {
    case 'e':
      return Shape::line;
    case 't':
      return Shape::triangle;
    case 'q':
      return Shape::quad;
    case 'k':
      return Shape::tetrahedron;
    default:
      return {};
  }
}

std::size_t kind_of(Shape shape, int nodes) {
  const auto found = std::find_if(kCellKinds.begin(), kCellKinds.end(), [&](const CellKind& kind) {
    return kind.shape == shape && kind.nodes == nodes;
  });
  return static_cast<std::size_t>(found - kCellKinds.begin());
}

std::size_t kind_of_ordering(std::string_view keyword) {
  constexpr std::string_view kEnd = "Ordering";
  if (keyword.size() <= kEnd.size() ||
      !same_but_for_case(keyword.substr(keyword.size() - kEnd.size()), kEnd)) {
    return kCellKinds.size();
  }
  const std::string_view name = keyword.substr(0, keyword.size() - kEnd.size());
  const auto found =
      std::find_if(kCellKinds.begin() + kLinearKinds, kCellKinds.end(),
                   [&](const CellKind& kind) { return same_but_for_case(kind.keyword, name); });
  return static_cast<std::size_t>(found - kCellKinds.begin());
}

std::vector<std::vector<int>> reference_nodes(Shape shape) {
  const Reference cell = reference(shape);
  std::vector<std::vector<int>> result = cell.corners;
  std::string_view middles = cell.middles;
  for (auto pair = next_word(middles); !pair.empty(); pair = next_word(middles)) {
    std::vector<int> node = cell.corners[pair[0] - '0'];
    const std::vector<int>& other = cell.corners[pair[1] - '0'];
    for (std::size_t k = 0; k < node.size(); ++k) node[k] = (node[k] + other[k]) / 2;
    result.push_back(std::move(node));
  }
  return result;
}

std::size_t counted_kind(Shape target, std::span<const Index> counts) {
  for (std::size_t kind = 0; kind < kCellKinds.size(); ++kind) {
    if (kCellKinds[kind].shape == target && counts[kind] > 0) return kind;
  }
  return kCellKinds.size();
}

void note_solutions(const FilePath& path, std::string_view what, Notes& notes) {
  for (const char* extension : {".sol", ".solb"}) {
    const FilePath solutions = path.companion(extension);
    if (solutions.exists()) notes.push_back(solutions.string() + " " + std::string(what));
  }
}

}  // namespace meshorder::medit
