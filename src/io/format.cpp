// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/format.hpp"

#include "base/text.hpp"
#include "io/all_formats.hpp"
#include "io/openfoam/cell_order.hpp"
#include "io/stream/gzip.hpp"
#include "io/stream/text_ends.hpp"
#include "io/ucd/ucd.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <system_error>

namespace meshorder {
namespace {

const std::vector<Format> kFormats{
    tetgen_format(),        vega_format(),        gmsh_format(), medit_format(),   vtu_format(),
    vtk_format(),           off_format(),         obj_format(),  ply_format(),     stl_format(),
    su2_format(),           abaqus_format(),      ucd_format(),  nastran_format(), unv_format(),
#ifdef MESHORDER_HAS_HDF5
    vtkhdf_format(),
#endif
#ifdef MESHORDER_HAS_NETCDF
    exodus_format(),
#endif
#ifdef MESHORDER_HAS_XDMF
    xdmf_format(),
#endif
#ifdef MESHORDER_HAS_CGNS
    cgns_format(),
#endif
#ifdef MESHORDER_HAS_HDF5
    med_format(),
#endif
    matrix_market_format(), metis_graph_format(),
};

/// A format whose library this build lacks.
struct LackingFormat {
  std::string_view name;
  std::vector<std::string_view> extensions;  ///< with dot, lower case
  std::string_view library;
  std::string_view option;  ///< CMake option that enables the library
};

const std::vector<LackingFormat> kLackingFormats{
#ifndef MESHORDER_HAS_NETCDF
    {"Exodus", {kExodusExtensions.begin(), kExodusExtensions.end()}, "netCDF", "MESHORDER_NETCDF"},
#endif
#ifndef MESHORDER_HAS_XDMF
    {"XDMF", {".xdmf", ".xmf"}, "HDF5 and pugixml", "MESHORDER_HDF5"},
#endif
#ifndef MESHORDER_HAS_HDF5
    {"VTKHDF", {".vtkhdf"}, "HDF5", "MESHORDER_HDF5"},
    {"MED", {".med"}, "HDF5", "MESHORDER_HDF5"},
#endif
#ifndef MESHORDER_HAS_CGNS
    {"CGNS", {".cgns"}, "the CGNS library", "MESHORDER_CGNS"},
#endif
};

[[noreturn]] void throw_lacking(const LackingFormat& format, const std::string& where) {
  throw Unavailable(fmt::format("{}: {} needs {}, which this build of meshorder lacks; build it with {}=ON",
                                where, format.name, format.library, format.option));
}

/// Loads the library of a format, if the format has one, and returns the format. Throws Unavailable if the
/// library cannot be loaded.
const Format& with_library(const Format& format, const std::string& where) {
  try {
    if (format.load_library != nullptr) format.load_library();
  } catch (const Unavailable& unavailable) {
    throw Unavailable(where + ": " + unavailable.what());
  }
  return format;
}

/// Returns whether the file has the length that its header, read as binary STL, implies.
bool has_size_of_stl(std::string_view bytes) {
  constexpr std::size_t kHeader = 80;
  if (bytes.size() < kHeader + 4) return false;
  std::uint64_t triangles = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    triangles |= std::uint64_t{static_cast<unsigned char>(bytes[kHeader + k])} << (8 * k);
  }
  return bytes.size() == kHeader + 4 + 50 * triangles;
}

/// Returns whether a line can begin an SU2 file. `word`: the line's first word; `rest`: the text after it.
bool is_su2_keyword(std::string_view word, std::string_view rest) {
  constexpr std::array<std::string_view, 5> kKeywords{"NDIME", "NZONE", "IZONE", "NELEM", "NPOIN"};
  const std::size_t equals = word.find('=');
  if (equals == std::string_view::npos && !trimmed(rest).starts_with('=')) return false;
  return std::any_of(kKeywords.begin(), kKeywords.end(), [&](std::string_view keyword) {
    return same_but_for_case(keyword, word.substr(0, equals));
  });
}

/// Returns whether the bytes are a classic netCDF file, or an HDF5 file with a name that all Exodus files
/// contain.
bool is_exodus(std::string_view bytes) {
  if (bytes.starts_with("CDF\x01") || bytes.starts_with("CDF\x02") || bytes.starts_with("CDF\x05"))
    return true;
  return bytes.starts_with("\x89HDF\r\n\x1a\n") && bytes.find("num_el_blk") != std::string_view::npos;
}

/// Returns whether the bytes are an HDF5 file that contains a group name of MED.
bool is_med(std::string_view bytes) {
  return bytes.starts_with("\x89HDF\r\n\x1a\n") && (bytes.find("INFOS_GENERALES") != std::string_view::npos ||
                                                    bytes.find("ENS_MAA") != std::string_view::npos);
}

/// Returns whether the bytes are an HDF5 file that contains VTKHDF's group name.
bool is_vtkhdf(std::string_view bytes) {
  return bytes.starts_with("\x89HDF\r\n\x1a\n") && bytes.find("VTKHDF") != std::string_view::npos;
}

/// Returns whether the bytes are an ADF file, or an HDF5 file with the node that all CGNS files have.
bool is_cgns(std::string_view bytes) {
  if (bytes.substr(0, 64).find("ADF Database Version") != std::string_view::npos) return true;
  return bytes.starts_with("\x89HDF\r\n\x1a\n") && bytes.find("CGNSLibraryVersion") != std::string_view::npos;
}

/// Returns whether an XML file is XDMF: whether it has <Xdmf before any <VTKFile.
bool is_xdmf(std::string_view word, std::string_view rest_of_line, std::string_view rest) {
  for (const std::string_view text : {word, rest_of_line, rest.substr(0, 4096)}) {
    const std::size_t xdmf = text.find("<Xdmf");
    const std::size_t vtk = text.find("<VTKFile");
    if (xdmf != vtk) return xdmf < vtk;
  }
  return false;
}

/// Returns whether a file whose first word begins with an asterisk is an Abaqus deck, not a Vega file.
/// `rest`: the lines after the first. Both formats have *MATERIAL and *INCLUDE.
bool is_deck(std::string_view word, std::string_view rest) {
  constexpr std::array<std::string_view, 4> kOfVega{"*VERTICES", "*ELEMENTS", "*SET", "*REGION"};
  constexpr std::array<std::string_view, 4> kOfBoth{"*MATERIAL", "*INCLUDE", "*MATERIAL,", "*INCLUDE,"};
  const auto is_one_of = [&](const auto& keywords) {
    return std::any_of(keywords.begin(), keywords.end(),
                       [&](std::string_view keyword) { return same_but_for_case(keyword, word); });
  };
  while (is_one_of(kOfBoth)) {
    if (word.ends_with(',')) return true;
    while (!rest.empty() && !trimmed(rest).starts_with('*')) {
      rest.remove_prefix(std::min(rest.find_first_of("\r\n"), rest.size() - 1) + 1);
    }
    if (rest.empty()) return false;
    word = next_word(rest, "\r\n");
  }
  return !is_one_of(kOfVega);
}

/// Returns whether a file can be one of Nastran: by its first line that is neither blank nor a comment, or by
/// a BEGIN BULK soon after.
bool is_bulk_data(std::string_view bytes) {
  constexpr std::array<std::string_view, 6> kWords{"SOL", "CEND", "BEGIN", "NASTRAN", "GRID", "GRID*"};
  constexpr int kMostLines = 100;
  bool is_first = true;
  for (int k = 0; k < kMostLines && !bytes.empty(); ++k) {
    const std::string_view line = bytes.substr(0, bytes.find_first_of("\r\n"));
    bytes.remove_prefix(std::min(line.size() + 1, bytes.size()));
    std::string_view rest = line;
    const std::string_view word = next_word(rest, ",");
    if (word.empty() || word.starts_with('$')) continue;
    if (is_first && std::any_of(kWords.begin(), kWords.end(),
                                [&](std::string_view known) { return same_but_for_case(known, word); })) {
      return true;
    }
    if (same_but_for_case(word, "BEGIN") && same_but_for_case(next_word(rest, ","), "BULK")) return true;
    is_first = false;
  }
  return false;
}

/// Returns whether a file whose first word begins with $ is Gmsh's: text of other programs has such comments.
bool is_gmsh(std::string_view word, std::string_view rest) {
  return word == "$MeshFormat" || word == "$NOD" || rest.find("$MeshFormat") != std::string_view::npos;
}

/// Returns the name of the format whose files begin like `bytes`; empty if no format fits. Skips comments
/// and empty lines before the first word.
std::string_view format_that_begins(std::string_view bytes) {
  if (is_cgns(bytes)) return "CGNS";
  if (is_exodus(bytes)) return "Exodus";
  if (is_bulk_data(bytes)) return "Nastran";
  if (is_med(bytes)) return "MED";
  if (is_vtkhdf(bytes)) return "VTKHDF";
  if (ucd::begins_ucd(bytes)) return "UCD";
  while (!bytes.empty()) {
    std::string_view line = bytes.substr(0, bytes.find_first_of("\r\n"));
    bytes.remove_prefix(std::min(line.size() + 1, bytes.size()));
    if (line.starts_with("# vtk DataFile")) return "VTK";
    if (line.starts_with("%%MatrixMarket")) return "MatrixMarket";
    const std::string_view word = next_word(line);
    if (word.empty() || word.front() == '#' || word.front() == '%') continue;
    if (word.starts_with("$")) return is_gmsh(word, bytes) ? "Gmsh" : "";
    if (word.starts_with("MeshVersion")) return "Medit";
    if (word.starts_with("<")) return is_xdmf(word, line, bytes) ? "XDMF" : "VTU";
    if (same_but_for_case(word, "*KEYWORD")) return {};  // LS-DYNA
    if (word == "-1") return "UNV";
    if (word.starts_with("*")) return is_deck(word, bytes) ? "Abaqus" : "Vega";
    if (word.ends_with("OFF")) return "OFF";
    if (word == "ply") return "PLY";
    if (same_but_for_case(word, "solid")) return "STL";
    if (is_su2_keyword(word, line)) return "SU2";
    constexpr std::array<std::string_view, 9> kObjWords{"v", "vn", "vt",     "f",     "o",
                                                        "g", "s",  "mtllib", "usemtl"};
    return std::find(kObjWords.begin(), kObjWords.end(), word) != kObjWords.end() ? "OBJ" : "";
  }
  return {};
}

/// Returns the path of a piece of an Exodus mesh without its two last numbers: "mesh.e" for "mesh.e.16.03".
/// Returns other paths unchanged.
std::filesystem::path without_piece_numbers(const std::filesystem::path& path) {
  const auto is_number = [](const std::string& extension) {
    return extension.size() > 1 && extension.find_first_not_of("0123456789", 1) == std::string::npos;
  };
  const std::filesystem::path once = path.stem();
  if (!is_number(path.extension().string()) || !is_number(once.extension().string())) return path;
  const std::string extension = lower_case(once.stem().extension().string());
  const bool is_exodus_name =
      std::find(kExodusExtensions.begin(), kExodusExtensions.end(), extension) != kExodusExtensions.end();
  return is_exodus_name ? path.parent_path() / once.stem() : path;
}

/// Returns the first bytes of a file without its byte order mark; nothing if it is not a file.
std::string beginning(const FilePath& path) {
  constexpr std::size_t kMost = 65536;
  if (!path.is_file() || path.is_empty()) return {};
  const std::string bytes = uncompressed_start(path.read_first(kMost), path.string());
  return std::string(without_byte_order_mark(bytes));
}

/// Throws InputError if a file is of a format other than `named`, the format of its name; "" if its name is
/// not that of a format.
void refuse_by_content(const FilePath& path, std::string_view named) {
  const std::string bytes = beginning(path);
  const std::string_view name = has_size_of_stl(bytes) ? "STL" : format_that_begins(bytes);
  if (name.empty() || name == named) return;
  if (name == "Abaqus" && named == "Vega") return;  // their keywords are alike
  if (name == "UCD" && !named.empty()) return;      // other files have columns of numbers, too
  if (name == "VTU" && bytes.find("UnstructuredGrid") == std::string::npos) return;
  const auto found = std::find_if(kFormats.begin(), kFormats.end(),
                                  [&](const Format& format) { return format.name == name; });
  if (found == kFormats.end()) return;
  const std::string fault = named.empty() ? fmt::format("looks like {}, but its name does not end so", name)
                                          : fmt::format("looks like {}, not like {}", name, named);
  throw InputError(path.string(), fault,
                   fmt::format("name it {}{}", found->extensions.front(),
                               without_gz(path.path()) == path.path() ? "" : ".gz"));
}

}  // namespace

std::string Format::key() const { return lower_case(name); }

std::span<const Format> all_formats() { return kFormats; }

const Format& format_of(const std::filesystem::path& path) {
  const std::string extension = lower_case(without_piece_numbers(without_gz(path)).extension().string());
  if (openfoam::is_case(openfoam::case_folder(path))) {
    throw InputError(path.string(), "is an OpenFOAM case",
                     "order its cells with meshorder openfoam " + openfoam::case_folder(path).string());
  }
  if (std::error_code code; extension.empty() && std::filesystem::is_directory(path, code)) {
    throw InputError(path.string(), "is a folder", "give a mesh file");
  }
  std::vector<std::string> known;
  for (const Format& format : kFormats) {
    for (const std::string_view candidate : format.extensions) {
      if (candidate == extension) return with_library(format, path.string());
      known.emplace_back(candidate);
    }
  }
  for (const LackingFormat& format : kLackingFormats) {
    const auto& extensions = format.extensions;
    if (std::find(extensions.begin(), extensions.end(), extension) != extensions.end()) {
      throw_lacking(format, path.string());
    }
  }
  if (const OtherFormat* const other = other_format(extension)) {
    throw InputError(path.string(), std::string(other->what), std::string(other->advice));
  }
  const std::string fault = extension.empty() ? "has no extension" : "unknown extension '" + extension + "'";
  if (const std::string nearest = suggestion(extension, known); !nearest.empty())
    throw InputError(path.string(), fault, nearest.substr(2));
  throw InputError(path.string(), fault,
                   "known: " + join(known, std::string_view(" ")) +
                       "; the Python package and its command also take meshio's formats");
}

const Format& format_of_file(const FilePath& path) {
  try {
    const Format& format = format_of(path.path());
    return format.name == "Abaqus" && ucd::begins_ucd(beginning(path)) ? format_named("UCD") : format;
  } catch (const InputError&) {
    refuse_by_content(path, "");
    throw;
  }
}

void refuse_other_content(const FilePath& path, const Format& format) {
  refuse_by_content(path, format.name);
}

const Format& output_format_of(const std::filesystem::path& path) {
  const Format& format = format_of(path);
  if (lower_case(without_gz(path).extension().string()) == ".pvtu") {
    throw InputError(path.string(), "lists pieces; one mesh cannot be written as such a list",
                     "write a .vtu file, or pieces with `mpirun -n 4 meshorder order MESH --pieces FOLDER`");
  }
  return format;
}

const Format& output_format_of(const std::filesystem::path& path, std::string_view of_mesh) {
  const Format& format = output_format_of(path);
  return of_mesh == "ucd" && format.name == "Abaqus" ? format_named("UCD") : format;
}

const Format& format_named(std::string_view name) {
  const auto found = std::find_if(kFormats.begin(), kFormats.end(),
                                  [&](const Format& format) { return same_but_for_case(format.name, name); });
  if (found != kFormats.end()) return with_library(*found, "the format '" + std::string(name) + "'");
  for (const LackingFormat& format : kLackingFormats) {
    if (same_but_for_case(format.name, name)) throw_lacking(format, "the format '" + std::string(name) + "'");
  }
  std::vector<std::string> known;
  known.reserve(kFormats.size());
  for (const Format& format : kFormats) known.push_back(format.key());
  throw InvalidArgument(unknown_in_words("format", std::string(name), known));
}

const Format* format_of_bytes(std::string_view bytes) {
  if (has_size_of_stl(bytes)) return &format_named("STL");
  const std::string_view name = format_that_begins(without_byte_order_mark(bytes));
  return name.empty() ? nullptr : &format_named(name);
}

inline namespace v0_3 {

std::vector<FormatInfo> formats() {
  std::vector<FormatInfo> result;
  result.reserve(kFormats.size());
  for (const Format& format : kFormats) {
    result.push_back({.name = format.key(),
                      .extensions = {format.extensions.begin(), format.extensions.end()},
                      .single_file = format.single_file,
                      .groups_cells_by_type = format.groups_cells_by_type});
  }
  return result;
}

}  // namespace v0_3
}  // namespace meshorder
