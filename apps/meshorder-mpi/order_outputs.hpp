// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "distributed/comm/communicator.hpp"
#include "distributed/files/exodus_slices.hpp"
#include "distributed/files/file_slices.hpp"
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

/// Where a mesh comes from and goes to: to a file, to pieces, or both.
struct OrderFiles : MeshFiles {
  std::string pieces;  ///< folder, a .vtkhdf file, or a name of Exodus II; empty: none are written
  int ghosts = 1;      ///< layers of ghost cells in pieces, 0 or 1

  /// Returns the files with an output that gives the format, also where there are pieces only.
  [[nodiscard]] MeshFiles with_output() const;
  /// Returns whether the pieces are the partitions of one file.
  [[nodiscard]] bool has_pieces_in_one_file() const;
  /// Returns whether the pieces are files of Nemesis, which have no ghost cells.
  [[nodiscard]] bool has_nemesis_pieces() const { return names_nemesis_pieces(pieces); }
  /// Returns the pieces' name: that of the output, or else of the input, without folder and extension.
  [[nodiscard]] std::string name_of_pieces() const;
};

/// What an order by all ranks writes. All files take their places at `commit`, or none does. All functions
/// but the last three have to be called by every rank.
class OrderOutputs {
 public:
  /// Looks, before the work, whether the files can be written.
  ///
  /// @param files  outlives this object
  /// @throws SharedError where they cannot
  OrderOutputs(const distributed::Communicator& communicator, const OrderFiles& files);

  /// Looks, before the work, whether pieces can hold the cells of a mesh that the root has read.
  ///
  /// @throws SharedError where they cannot
  void check(const Mesh& mesh) const;

  /// Writes a mesh that all ranks read, in its new order, and its maps.
  ///
  /// @param before  of the mesh in its old order; looked at for maps only
  void write(const distributed::FileSlices& slices, const distributed::DistributedOrder& order,
             const MeshChecksums& before, Notes& notes);

  /// Writes the pieces and the maps of a mesh that all ranks read in parts.
  void write(const distributed::ExodusSlices& slices, const distributed::DistributedOrder& order,
             const MeshChecksums& before, Notes& notes);

  /// Writes a mesh that the root has, and that is in its new order, and its maps.
  void write(const MeshToOrder& whole, const distributed::DistributedOrder& order, Notes& notes);

  /// Puts all files in place.
  void commit(Notes& notes);

  /// Returns, at the root, the paths of all files but the output and the pieces.
  [[nodiscard]] const std::vector<std::string>& maps() const noexcept { return maps_; }
  /// Returns the path of the file that names the pieces, or has them in it, or of the first piece in Nemesis,
  /// at the root; empty without pieces.
  [[nodiscard]] std::string pieces_file() const {
    return pieces_                           ? pieces_->index().string()
           : nemesis_                        ? nemesis_->first()
           : files_.has_pieces_in_one_file() ? files_.pieces
                                             : "";
  }
  /// Returns what is reported of the pieces.
  [[nodiscard]] const distributed::PiecesReport& pieces() const noexcept { return pieces_report_; }

 private:
  void write_pieces(const distributed::GridRows& grid, const distributed::DistributedReport& report,
                    Notes& notes);
  void write_nemesis(const MeshToOrder& whole, const distributed::DistributedReport& report, Notes& notes);
  void write_nemesis(const distributed::NemesisShare& share, const distributed::DistributedReport& report);
  /// Throws InputError, at the root, for what pieces do not hold, where no loss is allowed.
  void refuse_losses(const Notes& losses) const;

  const distributed::Communicator& communicator_;
  const OrderFiles& files_;
  std::optional<PieceOutputs> pieces_;  ///< at the root; its folder is removed after what the set left there
  std::optional<NemesisOutputs> nemesis_;  ///< at the root
  OutputSet set_;
  std::vector<std::string> maps_;
  distributed::PiecesReport pieces_report_;
};

}  // namespace meshorder::command
