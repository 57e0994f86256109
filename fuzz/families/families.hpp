// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "fuzz/family.hpp"

namespace meshorder::fuzz {

// The checks of the families; see Family::check.

/// Checks the files of a mesh (see `input_files` and `check_mesh_files`).
void check_mesh_family(std::string_view family, Family::Bytes input);
/// Checks a folder `polyMesh`, read as for ordering its cells: `owner`, `neighbour`, `points`, `faces`.
void check_openfoam(std::string_view family, Family::Bytes input);
/// Checks a NumPy array: written and read again, and read as a permutation, as by `--maps`.
void check_npy(std::string_view family, Family::Bytes input);
void check_scenario(std::string_view family, Family::Bytes input);
/// Checks the results of a study, which are written and read again.
void check_results(std::string_view family, Family::Bytes input);
/// Checks a checkpoint, which is written and read again.
void check_checkpoint(std::string_view family, Family::Bytes input);
void check_motion(std::string_view family, Family::Bytes input);
/// Calls the C interface with arrays that the bytes describe. Each call must return a valid status, and
/// orders of a call that succeeds must be bijections.
void check_graphs(std::string_view family, Family::Bytes input);
void check_cells(std::string_view family, Family::Bytes input);
/// Reads past the end of an array if the input begins with "$Mesh": a working fuzzer finds this fault.
void check_planted(std::string_view family, Family::Bytes input);

// Mutations that know the structure of a format; see Family::mutate.

std::string mutate_words(std::string input, std::uint32_t seed);
std::string mutate_sections(std::string input, std::uint32_t seed);
std::string mutate_ply(std::string input, std::uint32_t seed);
std::string mutate_vtu(std::string input, std::uint32_t seed);
std::string mutate_xml(std::string input, std::uint32_t seed);
std::string mutate_hdf5(std::string input, std::uint32_t seed);
std::string mutate_exodus(std::string input, std::uint32_t seed);
std::string mutate_json(std::string input, std::uint32_t seed);
std::string mutate_checkpoint(std::string input, std::uint32_t seed);

}  // namespace meshorder::fuzz
