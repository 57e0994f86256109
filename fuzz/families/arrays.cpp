// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Files of arrays: OpenFOAM's lists, NumPy's maps.
#include "fuzz/families/families.hpp"
#include "fuzz/families/scratch.hpp"
#include "fuzz/input_files.hpp"
#include "io/npy.hpp"
#include "io/openfoam/poly_mesh.hpp"

#include <algorithm>
#include <array>

namespace meshorder::fuzz {
namespace {

constexpr std::array<std::string_view, 4> kBesideOwner{"neighbour", "points", "faces", "boundary"};

void check_graph(const CsrGraph& graph) {
  for (const Index v : graph.neighbours) {
    if (v < 0 || v >= graph.size()) fail("a neighbour is no cell");
  }
}

}  // namespace

void check_openfoam(std::string_view /*family*/, Family::Bytes input) {
  const std::vector<MemoryFile> files = input_files(text_of(input), "owner");
  const std::filesystem::path folder = scratch_file("owner", files.front().bytes).parent_path();
  for (const std::string_view name : kBesideOwner) {
    scratch_file(std::string(name), bytes_of(files, name));
  }
  for (const bool with_centres : {false, true}) {
    Notes notes;
    const auto mesh = accepted([&] { return openfoam::read_poly_mesh(folder, folder, with_centres, notes); });
    if (mesh) check_graph(mesh->graph);
  }
}

void check_npy(std::string_view /*family*/, Family::Bytes input) {
  const std::filesystem::path path = scratch_file("map.npy", text_of(input));
  const auto numbers = accepted([&] { return read_npy(path); });
  if (!numbers) return;
  const std::filesystem::path copy = path.parent_path() / "copy.npy";
  write_npy(std::span<const std::int64_t>(*numbers), copy);
  if (read_npy(copy) != *numbers) fail("an array that was written has other numbers");
  const auto map = accepted([&] { return read_permutation(path, index_size(*numbers), "vertices"); });
  if (!map) return;
  if (!std::equal(numbers->begin(), numbers->end(), map->old_to_new().begin(), map->old_to_new().end())) {
    fail("a permutation differs from its file");
  }
}

}  // namespace meshorder::fuzz
