// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "fuzz/family.hpp"

namespace meshorder::fuzz {

// The checks of families; each is in the file of its subject.

/// The files of a mesh (see `input_files` and `check_mesh_files`).
void check_mesh_family(std::string_view family, Family::Bytes input);
/// A folder `polyMesh`: `owner`, `neighbour`, `points` and `faces`, read as for an order of cells.
void check_openfoam(std::string_view family, Family::Bytes input);
/// An array of NumPy as `--maps` reads it: a permutation, written and read again.
void check_npy(std::string_view family, Family::Bytes input);
void check_scenario(std::string_view family, Family::Bytes input);
/// Results of a study, written and read again.
void check_results(std::string_view family, Family::Bytes input);
/// A checkpoint, written and read again.
void check_checkpoint(std::string_view family, Family::Bytes input);
void check_motion(std::string_view family, Family::Bytes input);
/// Arrays that the bytes describe, given to the C interface: each call returns a status; a call that succeeds
/// also returns a bijection.
void check_graphs(std::string_view family, Family::Bytes input);
void check_cells(std::string_view family, Family::Bytes input);
/// Reads past the end of an array for one input of 5 bytes: a working fuzzer finds it.
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
