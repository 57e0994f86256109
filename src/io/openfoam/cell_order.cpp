// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/openfoam/cell_order.hpp"

#include "io/openfoam/foam_file.hpp"

#include <string>
#include <system_error>

namespace meshorder::openfoam {
namespace {

namespace fs = std::filesystem;

void write_header(OutputFile& file, std::string_view class_name, std::string_view object) {
  file.print(
      "FoamFile\n{{\n    version     2.0;\n    format      ascii;\n    class       {};\n"
      "    note        \"written by meshorder\";\n    object      {};\n}}\n\n",
      class_name, object);
}

/// Returns whether there is a mesh in `constant`, or in a region of it.
bool has_mesh(const fs::path& constant) {
  std::error_code ignored;
  if (fs::is_directory(constant / "polyMesh", ignored)) return true;
  for (const fs::directory_entry& entry : fs::directory_iterator(constant, ignored)) {
    if (fs::is_directory(entry.path() / "polyMesh", ignored)) return true;
  }
  return false;
}

}  // namespace

void write_cell_order(const Permutation& cells, OutputFile& file) {
  write_header(file, "labelList", kCellOrder);
  file.print("// the old number of each cell, in the new order\n{}\n(", cells.size());
  for (const Index old : cells.new_to_old()) file.integer("\n", old);
  file.write("\n)\n");
}

void write_dictionary(OutputFile& file) {
  write_header(file, "dictionary", "renumberMeshDict");
  for (const std::string_view entry : kDictionaryEntries) file.print("{}\n", entry);
}

bool takes_cell_order(const FilePath& dictionary) {
  FoamFile file(dictionary);
  bool is_manual = false;
  bool names_order = false;
  int depth = 0;  // of braces; only a `method` outside of all braces belongs to the dictionary
  std::string key = ";";
  while (!file.at_end()) {
    const std::string value(file.token());
    if (key == "{") ++depth;
    if (key == "}") --depth;
    if (key == "method" && depth == 0) is_manual = value == "manual";
    if (key == "dataFile") names_order = value == kCellOrder;
    key = value;
  }
  return is_manual && names_order;
}

fs::path case_folder(const fs::path& path) {
  if (path.extension() != ".foam") return path;
  const fs::path folder = path.parent_path();
  return folder.empty() ? fs::path(".") : folder;
}

bool is_case(const fs::path& folder) {
  return has_mesh(folder / "constant") || has_mesh(folder / "processor0" / "constant");
}

}  // namespace meshorder::openfoam
