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
  std::string name = {};                     ///< as in `ReadOptions::format`: "gmsh", "vtu"
  std::vector<std::string> extensions = {};  ///< lower case, with the dot
  bool single_file = true;                   ///< false for formats of several files (TetGen)
  bool groups_cells_by_type = false;         ///< cells of a type stand together in the file
};

/// Lists the formats of this build, in the order in which help shows them.
[[nodiscard]] MESHORDER_API std::vector<FormatInfo> formats();

/// Options of `read_mesh`.
struct ReadOptions {
  std::string format = {};  ///< name of the format; empty: by the extension, in memory by the first bytes
  std::string name = {};    ///< of bytes and streams in messages; its extension is not looked at
  /// For formats of several files in memory: returns the bytes of the file of that name, none where there is
  /// no such file. An exception passes through.
  std::function<std::string(std::string_view name)> companion = {};
  Notes* notes = nullptr;  ///< receives warnings; null: they are dropped
  Run run = {};            ///< `threads`; readers report no progress
  /// The most bytes that a file may take for what it claims rather than holds: compressed or repeated values,
  /// sizes without values, ranges of numbers. None: 256 MiB and 100 times the size of its files, at most
  /// three quarters of the memory that this process may have.
  std::optional<std::uint64_t> memory_limit = {};
  /// Folders where files may be that this one names to be read with it, besides its own folder. Links are
  /// followed before.
  std::vector<std::filesystem::path> include_folders = {};
};

/// Reads a mesh from a file.
///
/// Files of one mesh that do not belong together, as a stopped process leaves them, are refused where the
/// format marks them (TetGen, XDMF). Nothing is written.
///
/// @param path     the file; for formats of several, any of them
/// @param options  see `ReadOptions`
/// @return a mesh with at least one cell that `check_mesh` accepts
/// @throws InputError for a file that is missing, faulty or without cells, with place and remedy; for more
///         than 2,147,483,647 vertices or cells; for one that claims more than `options.memory_limit` or
///         names files elsewhere; for an unknown extension, with the known ones
/// @throws InvalidArgument for an unknown format, with the known ones
/// @throws Unavailable for a format or a compression of which this build lacks the library
[[nodiscard]] MESHORDER_API Mesh read_mesh(const std::filesystem::path& path,
                                           const ReadOptions& options = {});

/// Reads a mesh from the bytes of a file; throws likewise. Nothing of `bytes` is referred to afterwards.
[[nodiscard]] MESHORDER_API Mesh read_mesh(std::span<const std::byte> bytes, const ReadOptions& options = {});

/// Reads a mesh from the rest of a stream, which is read to its end; throws likewise.
[[nodiscard]] MESHORDER_API Mesh read_mesh(std::istream& stream, const ReadOptions& options = {});

/// Options of `keep_cells`.
struct KeepOptions {
  /// Name of the format that the mesh will be written in; empty: none in particular.
  std::string format = {};
  int dimension = -1;      ///< keep the cells of this dimension only, 0 to 3; −1: of all dimensions
  Notes* notes = nullptr;  ///< receives what was left out, one line for each type of cells; null: dropped
};

/// Leaves cells out of a mesh: those of other dimensions than the wanted one, then those that the format has
/// no place for, unless one of them has the highest dimension of the mesh (`write_mesh` refuses such a mesh).
/// Called before `reorder`, it makes the order and its permutations describe the file that `write_mesh`
/// makes.
///
/// Vertices stay, all of them. Arrays, sets, ids and blocks follow the cells. Sets and arrays on some cells
/// go with the last of their cells, which `notes` tells.
///
/// @param mesh     changed in place
/// @param options  see `KeepOptions`
/// @return the old positions of the cells that are kept, ascending
/// @throws InvalidArgument for a mesh that `check_mesh` refuses, an unknown format, a dimension out of range
///         and one of which the mesh has no cells
/// @note O(size of the mesh).
MESHORDER_API std::vector<Index> keep_cells(Mesh& mesh, const KeepOptions& options);

/// Options of `write_mesh`.
struct WriteOptions {
  bool strict = false;     ///< throw instead of leaving anything out: cells, arrays, sets, ids, names
  Notes* notes = nullptr;  ///< receives what the format cannot hold; null: dropped
};

/// Writes a mesh to a file in the format that the extension names.
///
/// Cells that the format has no place for are left out, as by `keep_cells`.
///
/// @param mesh   not changed
/// @param path   replaced when all is written and on the disk; nothing is left behind after an exception.
///               Symbolic links are followed in `path` itself, not in names derived from it; owner, mode and
///               ACLs stay as the system allows; further hard links keep the old content, which `notes`
///               tells; devices and pipes are written directly
/// @param notes  receives what the format cannot hold; null: dropped
/// @return the places that the cells have in the file, behind them those of cells that are left out; the
///         identity after `reorder` for that format
/// @throws InvalidArgument for a mesh that `check_mesh` refuses
/// @throws InputError for an unknown extension, for cells of the highest dimension that the format cannot
///         hold, with the formats that can, and if the file cannot be written
MESHORDER_API Permutation write_mesh(const Mesh& mesh, const std::filesystem::path& path,
                                     Notes* notes = nullptr);

/// The same with options; throws InputError also for the first loss where `options.strict` allows none.
///
/// @note A strict call writes the mesh twice, first to memory.
MESHORDER_API Permutation write_mesh(const Mesh& mesh, const std::filesystem::path& path,
                                     const WriteOptions& options);

/// Writes a mesh to a stream, for formats of one file; returns and throws likewise.
///
/// @param mesh    not changed
/// @param stream  receives the bytes of the file
/// @param format  name of the format
/// @param notes   receives what the format cannot hold; null: dropped
/// @throws InvalidArgument also for an unknown format and one of several files
/// @throws Error of `Code::io` if the stream fails
MESHORDER_API Permutation write_mesh(const Mesh& mesh, std::ostream& stream, std::string_view format,
                                     Notes* notes = nullptr);

/// A file in memory.
struct MemoryFile {
  std::string name;
  std::string bytes;
};

/// The files that `write_mesh` would have made, and what it would have returned.
struct MemoryFiles {
  std::vector<MemoryFile> files;  ///< one, or several for TetGen; at least one
  Permutation cells;
};

/// Writes a mesh to memory; throws as `write_mesh`.
///
/// @param mesh    not changed
/// @param format  name of the format
/// @param name    name of the file, from which those of its companions follow
/// @param notes   receives what the format cannot hold; null: dropped
[[nodiscard]] MESHORDER_API MemoryFiles write_mesh_to_memory(const Mesh& mesh, std::string_view format,
                                                             std::string_view name, Notes* notes = nullptr);

}  // namespace v0_3
}  // namespace meshorder
