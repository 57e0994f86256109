// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <meshorder/export.hpp>
#include <meshorder/mesh.hpp>
#include <meshorder/options.hpp>
#include <meshorder/permutation.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <iosfwd>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder {
inline namespace v0_3 {

/// Warnings of a reader or writer: what was dropped, repaired or looks wrong. The library never prints.
using Notes = std::vector<std::string>;

/// Description of a file format.
struct FormatInfo {
  std::string name = {};                     ///< such as "gmsh"; the name for `ReadOptions::format`
  std::vector<std::string> extensions = {};  ///< lower case, with the dot
  bool single_file = true;                   ///< false for formats of several files (TetGen)
  bool groups_cells_by_type = false;         ///< the file keeps cells of one type together
};

/// Lists the formats of this build, in the order in which help shows them.
[[nodiscard]] MESHORDER_API std::vector<FormatInfo> formats();

/// Options of `read_mesh`.
struct ReadOptions {
  /// Name of the format. Empty: the extension decides; for bytes and streams, the first bytes.
  std::string format = {};
  std::string name = {};  ///< what messages call bytes or a stream; its extension does not choose the format
  /// For formats of several files in memory: returns the bytes of the file of that name; an empty string if
  /// there is no such file. An exception passes through.
  std::function<std::string(std::string_view name)> companion = {};
  Notes* notes = nullptr;  ///< receives warnings; null: they are dropped
  Run run = {};            ///< `threads`; readers report no progress
  /// Limit, in bytes, on memory for data that files hold in fewer bytes: compressed or repeated values, sizes
  /// without values, ranges of numbers. If not set: 256 MiB plus 100 times the size of the mesh's files, but
  /// at most three quarters of the memory that this process may have.
  std::optional<std::uint64_t> memory_limit = {};
  /// Folders in which files that the mesh's file names may lie, besides the folder of that file. Links are
  /// resolved first.
  std::vector<std::filesystem::path> include_folders = {};
};

/// Reads a mesh from a file.
///
/// An interrupted writer can leave files that do not belong together. `read_mesh` refuses such files if the
/// format marks the files of one mesh (TetGen, XDMF). Nothing is written.
///
/// @param path     the file; any of the files if the format has several
/// @param options  see `ReadOptions`
/// @return a mesh that `check_mesh` accepts, with at least one cell
/// @throws InputError for a file that is missing, faulty or without cells, with place and remedy; for more
///         than 2,147,483,647 vertices or cells; for data that exceed `options.memory_limit`; if the file
///         names files in folders that are not allowed; for an unknown extension (the message lists the known
///         ones)
/// @throws InvalidArgument for an unknown format (the message lists the known ones)
/// @throws Unavailable for a format or a compression whose library this build lacks
[[nodiscard]] MESHORDER_API Mesh read_mesh(const std::filesystem::path& path,
                                           const ReadOptions& options = {});

/// Reads a mesh from the bytes of a file; throws as for a path. The mesh does not refer to `bytes`.
[[nodiscard]] MESHORDER_API Mesh read_mesh(std::span<const std::byte> bytes, const ReadOptions& options = {});

/// Reads a mesh from a stream, up to its end; throws as for a path.
[[nodiscard]] MESHORDER_API Mesh read_mesh(std::istream& stream, const ReadOptions& options = {});

/// Options of `keep_cells`.
struct KeepOptions {
  /// Name of the format that the mesh will be written in; empty: none in particular.
  std::string format = {};
  int dimension = -1;      ///< keep the cells of this dimension only, 0 to 3; −1: of all dimensions
  Notes* notes = nullptr;  ///< receives what the format cannot hold, removed arrays and sets; null: dropped
};

/// Removes cells from a mesh: first the cells whose dimension is not the wanted one, then the cells that the
/// format cannot hold. If one of the latter has the highest dimension, all of them stay (`write_mesh` refuses
/// such a mesh). Call this function before `reorder`: the permutations then describe the file that
/// `write_mesh` makes.
///
/// All vertices stay. Arrays, sets, ids and blocks follow the cells. A set, or an array on only some cells,
/// is removed if none of its cells is left; `notes` names it.
///
/// @param mesh     changed in place
/// @param options  see `KeepOptions`
/// @return the old positions of the cells that are kept, ascending
/// @throws InvalidArgument for a mesh that `check_mesh` refuses, an unknown format, a dimension out of range,
///         and a dimension of which the mesh has no cells
/// @note O(size of the mesh).
MESHORDER_API std::vector<Index> keep_cells(Mesh& mesh, const KeepOptions& options);

/// Options of `write_mesh`.
struct WriteOptions {
  bool strict = false;     ///< throw instead of leaving anything out: cells, arrays, sets, ids, names
  Notes* notes = nullptr;  ///< receives what the format cannot hold; null: dropped
};

/// Writes a mesh to a file in the format of its extension.
///
/// Cells that the format cannot hold are left out, as by `keep_cells`.
///
/// @param mesh   not changed
/// @param path   replaced once all bytes are on the disk; an exception leaves no unfinished file.
///               Symbolic links are followed in `path` itself, not in names derived from it. Owner, mode and
///               ACLs are kept as far as the system allows. Other hard links keep the old content; `notes`
///               reports that. Devices and pipes are written directly
/// @param notes  receives what the format cannot hold; null: dropped
/// @return the permutation that moves the mesh's cells to their places in the file; cells that are left out
///         come last. After `reorder` for that format: the identity
/// @throws InvalidArgument for a mesh that `check_mesh` refuses
/// @throws InputError for an unknown extension, if the file cannot be written, and for cells of the highest
///         dimension that the format cannot hold (the message lists formats that can)
MESHORDER_API Permutation write_mesh(const Mesh& mesh, const std::filesystem::path& path,
                                     Notes* notes = nullptr);

/// The same with options; under `options.strict`, throws InputError also if anything would be left out.
///
/// @note A strict call writes the mesh twice, first to memory.
MESHORDER_API Permutation write_mesh(const Mesh& mesh, const std::filesystem::path& path,
                                     const WriteOptions& options);

/// Writes a mesh to a stream, for formats of one file; returns and throws as for a path.
///
/// @param mesh    not changed
/// @param stream  receives the bytes of the file
/// @param format  name of the format
/// @param notes   receives what the format cannot hold; null: dropped
/// @throws InvalidArgument also for an unknown format and for a format of several files
/// @throws Error of `Code::io` if the stream fails
MESHORDER_API Permutation write_mesh(const Mesh& mesh, std::ostream& stream, std::string_view format,
                                     Notes* notes = nullptr);

/// A file in memory.
struct MemoryFile {
  std::string name;
  std::string bytes;
};

/// The files that `write_mesh` would write, and the permutation that it would return.
struct MemoryFiles {
  std::vector<MemoryFile> files;  ///< one, or for TetGen several
  Permutation cells;
};

/// Writes a mesh to memory; throws as `write_mesh`, and InvalidArgument for an unknown format.
///
/// @param mesh    not changed
/// @param format  name of the format
/// @param name    name of the file, from which the names of its companions are derived
/// @param notes   receives what the format cannot hold; null: dropped
[[nodiscard]] MESHORDER_API MemoryFiles write_mesh_to_memory(const Mesh& mesh, std::string_view format,
                                                             std::string_view name, Notes* notes = nullptr);

}  // namespace v0_3
}  // namespace meshorder
