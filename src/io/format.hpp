// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/csr_graph.hpp"
#include "io/stream/file_path.hpp"
#include <meshorder/error.hpp>
#include <meshorder/io.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder {

/// A file format: its name, its file extensions, its reader and its writer.
///
/// Readers throw Error for every fault of a file and must return a mesh that passes `check_mesh`. Writers
/// leave no partial file and note what the format cannot hold. Every format has a reader and a writer.
struct Format {
  std::string_view name;                     ///< as people write it: "Gmsh"
  std::vector<std::string_view> extensions;  ///< with dot, lower case
  bool groups_cells_by_type;                 ///< whether files keep the cells of a type together
  Mesh (*read)(const FilePath&, Notes&);
  void (*write)(const Mesh&, const FilePath&, Notes&);
  /// Returns whether a file of this mesh can hold cells of this type in a form that other programs read. For
  /// a mesh from this format, a form that only meshorder reads suffices. `write` gets no other cells.
  bool (*holds)(const Mesh& mesh, Shape shape, int vertices);
  /// Returns why the cells of a mesh cannot share a file, although the format `holds` each of their types: a
  /// clause that begins with the format's name; empty if they can share a file. Null: no conflicts. `write`
  /// gets no mesh with a conflict.
  std::string (*conflict)(const Mesh& mesh) = nullptr;
  /// For a mesh from another format: returns each cell's position in the file; `blocks` receives the position
  /// of the first cell of each block. Null: `groups_cells_by_type` decides.
  Permutation (*places)(const Mesh&, std::vector<Index>& blocks) = nullptr;
  /// Normalises cells whose form depends on the order of the vertices: moves the entries of a symmetric
  /// matrix below the diagonal, sorts the edges of a graph. Call this function after reordering vertices.
  /// Returns the permutation of cells that it applied. Null: the format has no such cells.
  Permutation (*settle_cells)(Mesh&) = nullptr;
  /// Returns the number of each cell's group; groups are numbered in order of appearance. The cells of a
  /// group need the same statements before them in the file; these cells stay together unless the caller
  /// gives other groups. Null: no groups.
  std::vector<Index> (*together)(const Mesh&) = nullptr;
  bool single_file = true;   ///< whether a mesh is one file; several files do not fit one stream
  int first_number = 0;      ///< number of the first vertex and the first cell of a mesh without ids
  bool has_numbers = false;  ///< whether files number vertices and cells; other files may use these numbers
  /// Returns the number of the first vertex or the first cell of a mesh that came from the format. Null:
  /// `first_number` is right for all files.
  std::int64_t (*first_number_of)(const Mesh&, Association) = nullptr;
  bool holds_ids = true;          ///< whether files can give vertices and cells any numbers
  std::string_view library = {};  ///< name of the library that parses the files; empty: meshorder parses them
  /// Loads `library`. A process must call this function before it gives up its right to open files. Null: the
  /// library is linked, or the format needs none.
  void (*load_library)() = nullptr;

  /// Returns the name in lower case, as the public functions take it.
  [[nodiscard]] std::string key() const;
};

/// Returns all formats, in the order of the help text.
std::span<const Format> all_formats();

/// Returns the format of the extension of `path`; case, a final ".gz" and the numbers of an Exodus piece are
/// ignored. Throws InputError, with advice, for extensions that are not read, OpenFOAM cases and folders
/// without an extension. Throws Unavailable if this build lacks the library of the format or cannot load it.
const Format& format_of(const std::filesystem::path& path);

/// As `format_of`, for a file to be written. Also throws InputError for .pvtu, which is only read.
const Format& output_format_of(const std::filesystem::path& path);

/// Returns the format of that name; case is ignored. Throws InvalidArgument if the name is unknown; the error
/// lists the known names. Throws Unavailable as `format_of` does.
const Format& format_named(std::string_view name);

/// Guesses the format of a file from its bytes; returns null if no format fits. Never recognises TetGen's
/// files: they look like any other columns of numbers. Throws Unavailable as `format_of` does.
const Format* format_of_bytes(std::string_view bytes);

/// Arranges the cells of a mesh as a file of the format `to` has them, before reordering and writing. A mesh
/// that came from `to` stays as it is. Otherwise cells are sorted by `to.places`, which also gives the
/// blocks. If `to.places` is null, the mesh loses its blocks; if the format also groups cells by type, cells
/// are sorted by type, and each type becomes a block. Returns the applied permutation of cells, or nothing if
/// none was applied. A reordering that is computed afterwards refers to the cells in the order of the file.
std::optional<Permutation> arrange_cells(Mesh& mesh, const Format& to);

/// Returns `cells` with each group of `to.together` made contiguous, as far as the group's cells can change
/// places. O(cells · log cells).
Permutation with_groups_together(const Mesh& mesh, Permutation cells, const Format& to);

/// As `compute_reordering`, for a mesh that will be written in `options.format` (if empty, in the mesh's own
/// format). If `options` has no groups of cells, the groups of `Format::together` stay together, unless the
/// mesh came from that format and its cells keep the original order.
MeshOrder compute_order_in_file(const Mesh& mesh, const CsrGraph& graph, const ReorderOptions& options);

/// Throws InvalidArgument for `Ids::keep` if the format cannot hold ids.
void check_holds_ids(const Format& format, Ids ids);

/// Reorders a valid mesh that `arrange_cells` arranged for the format `to`, and updates its ids.
///
/// @param to        null: a mesh without a format
/// @param arranged  what `arrange_cells` returned
/// @return the permutation of cells from their order before `arrange_cells` to their final order
Permutation move_in_file(Mesh& mesh, const Permutation& vertices, Permutation cells, const Format* to,
                         const std::optional<Permutation>& arranged, Ids ids);

/// Applies permutations that `reorder` returned for a mesh to be written in the format `to`. Call
/// `check_holds_ids` first. Throws as the public `apply_reordering`.
void apply_reordering(Mesh& mesh, const Format& to, const Permutation& vertices, const Permutation& cells,
                      Ids ids);

/// Undoes `apply_reordering` of these permutations; the mesh is to be written in `to`. Throws as
/// `apply_reordering`. Ids change as for `Ids::renumber`.
void undo_reordering(Mesh& mesh, const Format& to, const Permutation& vertices, const Permutation& cells);

/// As the public `read_mesh`; files that the mesh names must be below its folder or an include folder.
Mesh read_mesh_from(const FilePath& path, const ReadOptions& options = {});

/// As the public `write_mesh`, for a valid mesh. If `path` belongs to an OutputSet, the set's commit puts the
/// files in place. Returns nothing if the cells stay in their places.
///
/// @param format  null: the format of the extension
std::optional<Permutation> write_mesh_to(const Mesh& mesh, const FilePath& path, const WriteOptions& options,
                                         const Format* format = nullptr);

/// As `write_mesh_to`, for a mesh that `arrange_cells` arranged for `format`, which holds all its cells.
void write_arranged(const Mesh& mesh, const FilePath& path, const WriteOptions& options,
                    const Format& format);

// The extension .inp belongs to two formats: Abaqus decks and AVS UCD.

/// As `format_of`, for a file to be read: .inp is AVS UCD if the file's first bytes look like UCD, else
/// Abaqus. The error for an extension that is not read names the format of the content. Also throws
/// InputError for an .inp file that cannot be read.
const Format& format_of_file(const FilePath& path);

/// Throws InputError if the first bytes of a file are clearly of another format than `format`, and says
/// which. For files that could not be read.
void refuse_other_content(const FilePath& path, const Format& format);

/// As `output_format_of`, for a mesh of the format `of_mesh` (`Mesh::format`): .inp means AVS UCD if the mesh
/// came from it, else Abaqus.
const Format& output_format_of(const std::filesystem::path& path, std::string_view of_mesh);

/// A format of other programs that meshorder does not read.
struct OtherFormat {
  std::string_view extension;  ///< with dot, lower case
  std::string_view what;       ///< "holds VTK's PolyData"
  std::string_view advice;     ///< how to get a mesh that meshorder reads
};

/// Returns the format of this extension (with dot, lower case), or null if it is unknown.
const OtherFormat* other_format(std::string_view extension);

/// Thrown if the marks of a mesh's files show that they were not written together.
struct NotTogether : InputError {
  using InputError::InputError;
  explicit NotTogether(const InputError& error) : InputError(error) {}
};

}  // namespace meshorder
