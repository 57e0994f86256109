// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "graph/csr_graph.hpp"
#include "io/stream/file_path.hpp"
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
/// leave no partial file and note the parts of the mesh that the format has no place for.
struct Format {
  std::string_view name;                     ///< as people write it: "Gmsh"
  std::vector<std::string_view> extensions;  ///< with dot, lower case
  bool groups_cells_by_type;                 ///< whether files keep the cells of a type together
  Mesh (*read)(const FilePath&, Notes&);
  void (*write)(const Mesh&, const FilePath&, Notes&);
  /// Returns whether other programs that read the format find cells of this type in a file of this mesh. For
  /// a mesh that came from the format it is enough that the reader finds them. `write` gets no other cells.
  bool (*holds)(const Mesh& mesh, Shape shape, int vertices);
  /// Returns why cells that it `holds` by their types do not fit one file together, as a clause that begins
  /// with the format's name; an empty text if they do. Null if all do. `write` gets no mesh with a conflict.
  std::string (*conflict)(const Mesh& mesh) = nullptr;
  /// Returns the places that the cells of a mesh of another format have in a file, where types do not decide
  /// them; `blocks` receives the first cell of each part that stays together. Null: cells keep their order.
  Permutation (*places)(const Mesh&, std::vector<Index>& blocks) = nullptr;
  /// Brings the cells of a mesh into the form in which a file of this format has them where that follows from
  /// the numbers of vertices: an entry below the diagonal, the edges of a graph by their vertices. Returns
  /// the applied permutation of cells. Null: files keep the cells as they are.
  Permutation (*settle_cells)(Mesh&) = nullptr;
  bool single_file = true;  ///< whether a mesh is one file; others do not fit one stream
  int first_number = 0;     ///< that vertices and cells have by their places where the mesh has no ids
  /// Returns this number for a mesh that came from the format. Null: all files have the same.
  std::int64_t (*first_number_of)(const Mesh&) = nullptr;
  bool holds_ids = true;          ///< whether files can give vertices and cells any numbers
  std::string_view library = {};  ///< that parses the files; empty: meshorder does

  /// Returns the name in lower case, as the public functions take it.
  [[nodiscard]] std::string key() const;
};

/// Returns all formats, in the order of the help text.
std::span<const Format> all_formats();

/// Returns the format that belongs to the extension of `path`, in any case, before a ".gz". Throws
/// InputError, which lists the known extensions, if there is none, and Unavailable for a format of which this
/// build lacks the library.
const Format& format_of(const std::filesystem::path& path);

/// As format_of, of a file to be written. Throws InputError for .pvtu, which lists pieces and is only read.
const Format& output_format_of(const std::filesystem::path& path);

/// Returns the format of that name, in any case. Throws InvalidArgument, which lists the known ones, if there
/// is none, and Unavailable likewise.
const Format& format_named(std::string_view name);

/// Returns the format that the bytes of a file look like, null if they look like none. TetGen's files cannot
/// be distinguished from other columns of numbers.
const Format* format_of_bytes(std::string_view bytes);

/// Prepares a mesh for reordering and writing in a format that is not its own: drops its blocks, which bind
/// cells in their own format only, and groups the cells as the format does: by type, each type a block, or by
/// its own places.
/// Returns the applied permutation of cells. Reordering afterwards describes the cells as they are in the
/// file.
Permutation arrange_cells(Mesh& mesh, const Format& to);

/// Throws InvalidArgument for `Ids::keep` if the format cannot hold ids.
void check_holds_ids(const Format& format, Ids ids);

/// Moves a mesh to the places that `reorder` returned for one that is written in the format `to`; call
/// `check_holds_ids` first. Throws as the public `apply_reordering`.
void apply_reordering(Mesh& mesh, const Format& to, const Permutation& vertices, const Permutation& cells,
                      Ids ids);

/// Moves a mesh that was moved to these places back, to be written in the format `to`; throws likewise. Ids
/// are sorted.
void undo_reordering(Mesh& mesh, const Format& to, const Permutation& vertices, const Permutation& cells);

/// As the public `read_mesh`; a file whose name comes from another one is read only below its folder.
Mesh read_mesh_from(const FilePath& path, const ReadOptions& options = {});

/// As the public `write_mesh`, for a valid mesh; one whose path belongs to a set of outputs is put in place
/// by that.
Permutation write_mesh_to(const Mesh& mesh, const FilePath& path, const WriteOptions& options);

/// As the public function, for a valid mesh; `graph` is the vertex graph of the mesh in its old order, or
/// receives it.
MeshOrder reorder(Mesh& mesh, const ReorderOptions& options, std::optional<CsrGraph>& graph);

}  // namespace meshorder
