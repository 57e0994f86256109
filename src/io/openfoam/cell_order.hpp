// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/stream/output_file.hpp"
#include <meshorder/permutation.hpp>

#include <array>
#include <filesystem>
#include <string_view>

namespace meshorder::openfoam {

/// Name of the file from which renumberMesh's method `manual` reads an order. The file lies beside the folder
/// `polyMesh`.
inline constexpr std::string_view kCellOrder = "cellOrder";

/// Writes the old numbers of the cells, in the new order of the cells. The caller commits the file.
void write_cell_order(const Permutation& cells, OutputFile& file);

/// The entries of renumberMeshDict that take the order from `kCellOrder`. OpenFOAM 1912 refuses a dictionary
/// without the first entry.
inline constexpr std::array<std::string_view, 3> kDictionaryEntries{
    "writeMaps false;", "method manual;", "manualCoeffs { dataFile \"cellOrder\"; }"};

/// Writes a renumberMeshDict of these entries. The caller commits the file.
void write_dictionary(OutputFile& file);

/// Returns whether a renumberMeshDict takes the order from `kCellOrder`.
///
/// @throws InputError for a file that is no dictionary of OpenFOAM
bool takes_cell_order(const FilePath& dictionary);

/// Returns the folder of a case: `CASE` for `CASE/NAME.foam`, the file by which ParaView opens a case; other
/// paths unchanged.
std::filesystem::path case_folder(const std::filesystem::path& path);

/// Returns whether a folder is an OpenFOAM case with a mesh: it has a folder `polyMesh` in `constant` or
/// `processor0/constant`, or in a region there.
bool is_case(const std::filesystem::path& folder);

}  // namespace meshorder::openfoam
