// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/files/exodus_slices.hpp"
#include "distributed/files/file_head.hpp"
#include "distributed/files/grid_rows.hpp"
#include "distributed/files/nemesis.hpp"
#include "distributed/files/pieces.hpp"
#include "distributed/order/order.hpp"
#include "io/stream/output_set.hpp"
#include "mesh_files.hpp"
#include "nemesis_outputs.hpp"
#include "piece_outputs.hpp"

#include <optional>
#include <string>
#include <vector>

namespace meshorder::command {

/// The files of a mesh: input, and as output a file, pieces, or both.
struct OrderFiles : MeshFiles {
  std::string pieces;  ///< a folder, a .vtkhdf file or an Exodus II name; empty: no pieces
  int ghosts = 1;      ///< layers of ghost cells in pieces, 0 or 1

  /// Returns the files. If there is no output, `output` is a name with the extension of the pieces, which
  /// sets the format.
  [[nodiscard]] MeshFiles with_output() const;
  /// Returns whether the pieces are the partitions of one file.
  [[nodiscard]] bool has_pieces_in_one_file() const;
  /// Returns whether the pieces are files of Nemesis, which have no ghost cells.
  [[nodiscard]] bool has_nemesis_pieces() const { return names_nemesis_pieces(pieces); }
  /// Returns the pieces' name: that of the output, or else of the input, without folder and extension.
  [[nodiscard]] std::string name_of_pieces() const;
};

/// Outputs of an order by all ranks. All files are put in place at `commit`, or none is. Every rank has to
/// call all functions but the last three.
class OrderOutputs {
 public:
  /// Checks, before the work, that the files can be written.
  ///
  /// @param files  outlives this object
  /// @throws SharedError if the files cannot be written or do not fit together
  OrderOutputs(const distributed::Communicator& communicator, const OrderFiles& files);

  /// Checks, before the work, that pieces can hold the cells of a mesh that the root has read.
  ///
  /// @throws SharedError if they cannot
  void check(const Mesh& mesh) const;

  /// Writes the outputs of a mesh that all ranks have read: the mesh in its new order, pieces and maps.
  ///
  /// @param before  checksums of the mesh in its old order; used for maps only
  void write(const distributed::FileHead& head, const distributed::DistributedOrder& order,
             const MeshChecksums& before, Notes& notes);

  /// Writes the pieces and the maps of a mesh that all ranks read in parts.
  void write(const distributed::ExodusSlices& slices, const distributed::DistributedOrder& order,
             const MeshChecksums& before, Notes& notes);

  /// Writes the outputs of a mesh that the root holds in its new order: the mesh, pieces and maps.
  void write(const MeshToOrder& whole, const distributed::DistributedOrder& order, Notes& notes);

  void commit(Notes& notes);

  /// Returns, at the root, the paths of all files but the pieces.
  [[nodiscard]] const WrittenFiles& written() const noexcept { return written_; }
  /// Returns, at the root, the path of the file that lists or contains the pieces, or of the first piece in
  /// Nemesis; empty without pieces.
  [[nodiscard]] std::string pieces_file() const {
    return pieces_                           ? pieces_->index().string()
           : nemesis_                        ? nemesis_->first()
           : files_.has_pieces_in_one_file() ? files_.pieces
                                             : "";
  }
  /// Returns the counts and notes on the pieces.
  [[nodiscard]] const distributed::PiecesReport& pieces() const noexcept { return pieces_report_; }

 private:
  void write_pieces(const distributed::GridRows& grid, const distributed::DistributedReport& report,
                    Notes& notes);
  void write_nemesis(const MeshToOrder& whole, const distributed::DistributedReport& report, Notes& notes);
  void write_nemesis(distributed::MovedPart moved, const distributed::ExodusSlices& slices,
                     const distributed::DistributedReport& report);
  /// Throws InputError, at the root, if there are losses but --strict forbids them.
  void refuse_losses(const Notes& losses) const;

  const distributed::Communicator& communicator_;
  const OrderFiles& files_;
  /// At the root. Destroyed after `set_`: the destructor removes the folder if no piece was put in place.
  std::optional<PieceOutputs> pieces_;
  std::optional<NemesisOutputs> nemesis_;  ///< at the root
  OutputSet set_;
  WrittenFiles written_;
  distributed::PiecesReport pieces_report_;
};

}  // namespace meshorder::command
