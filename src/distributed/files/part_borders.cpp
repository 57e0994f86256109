// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "distributed/files/part_borders.hpp"

#include "cells/facets.hpp"
#include "distributed/files/piece_contents.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <tuple>

namespace meshorder::distributed {
namespace {

/// A facet that more than one part may have, to be sent to the owner of the corner with the largest number.
struct Candidate {
  std::array<GlobalIndex, 4> corners;  ///< descending; −1 after the last
  GlobalIndex cell;
  Index part;  ///< part of the cell
  int facet;

  [[nodiscard]] auto key() const { return std::tie(corners, cell, facet); }
};

/// A facet shared with another part, to be sent to the rank of its cell's part.
struct Match {
  GlobalIndex cell;
  Index part;   ///< part of the cell
  Index other;  ///< part of the cell on the other side
  int facet;
};

/// Returns whether several parts have all vertices at these positions of a cell.
bool is_shared(const MeshParts& parts, std::span<const Index> cell, const std::vector<int>& positions) {
  const auto first = parts.parts_with(cell[positions.front()]);
  if (first.size() < 2) return false;
  const auto has_all = [&](Index part) {
    return std::all_of(positions.begin(), positions.end(), [&](int position) {
      const auto with = parts.parts_with(cell[position]);
      return std::binary_search(with.begin(), with.end(), part);
    });
  };
  return std::count_if(first.begin(), first.end(), has_all) > 1;
}

/// Returns the facets of this rank's cells that more than one part may have.
std::vector<Candidate> candidates(const Mesh& mesh, const ShareNumbers& numbers, const MeshParts& parts) {
  std::vector<Candidate> found;
  FacetsOfTypes facets_of;
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    const auto cell = mesh.cells[c];
    const auto& facets = facets_of(mesh.cells.shapes[c], mesh.cells.vertex_count(c));
    for (std::size_t f = 0; f < facets.size(); ++f) {
      if (facets[f].size() < 2 || !is_shared(parts, cell, facets[f])) continue;
      Candidate candidate{{}, numbers.cells[c], parts.part_with(c), static_cast<int>(f)};
      const std::array<Index, 4> corners = sorted_corners(cell, facets[f]);
      std::transform(corners.begin(), corners.end(), candidate.corners.begin(),
                     [&](Index corner) { return corner < 0 ? GlobalIndex{-1} : numbers.vertices[corner]; });
      found.push_back(candidate);
    }
  }
  return found;
}

/// Calls `take(a, b)` for every two facets with the same corners in different parts; sorts `facets`.
template <class Take>
void for_pairs(std::vector<Candidate>& facets, const Take& take) {
  std::sort(facets.begin(), facets.end(),
            [](const Candidate& a, const Candidate& b) { return a.key() < b.key(); });
  for (std::size_t begin = 0, end = 0; begin < facets.size(); begin = end) {
    while (end < facets.size() && facets[end].corners == facets[begin].corners) ++end;
    for (std::size_t i = begin; i < end; ++i) {
      for (std::size_t k = i + 1; k < end; ++k) {
        if (facets[i].part != facets[k].part) take(facets[i], facets[k]);
      }
    }
  }
}

}  // namespace

std::vector<std::vector<BorderFacet>> facets_between(const Communicator& communicator, const Mesh& mesh,
                                                     const ShareNumbers& numbers, const MeshParts& parts) {
  std::vector<Candidate> asked =
      sent_to_ranks(communicator, communicator.together([&] { return candidates(mesh, numbers, parts); }),
                    [&](const Candidate& facet) { return numbers.layout.owner(facet.corners[0]); });
  const Layout ranks = ranks_of_parts(parts.size(), communicator.size());
  const std::vector<Match> own = sent_to_ranks(communicator, communicator.together([&] {
    std::vector<Match> matches;
    for_pairs(asked, [&](const Candidate& a, const Candidate& b) {
      // add both at once, so that the lists of the two parts have the same sequence
      matches.push_back({a.cell, a.part, b.part, a.facet});
      matches.push_back({b.cell, b.part, a.part, b.facet});
    });
    return matches;
  }),
                                               [&](const Match& match) { return ranks.owner(match.part); });
  return communicator.together([&] {
    std::vector<std::vector<BorderFacet>> result(static_cast<std::size_t>(parts.size()));
    for (const Match& match : own) {
      const auto cell = std::lower_bound(numbers.cells.begin(), numbers.cells.end(), match.cell);
      result[match.part].push_back(
          {match.other, static_cast<Index>(cell - numbers.cells.begin()), match.facet});
    }
    for (std::vector<BorderFacet>& of_part : result) {
      std::stable_sort(of_part.begin(), of_part.end(),
                       [](const BorderFacet& a, const BorderFacet& b) { return a.part < b.part; });
    }
    return result;
  });
}

}  // namespace meshorder::distributed
