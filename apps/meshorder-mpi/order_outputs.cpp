// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "order_outputs.hpp"

#include "base/text.hpp"
#include "distributed/files/moved_file.hpp"
#include "distributed/files/moved_part.hpp"
#include "io/format.hpp"
#include "io/kept_cells.hpp"
#include "io/stream/output_file.hpp"
#include "shared_output.hpp"
#include "sliced_maps.hpp"
#include <meshorder/error.hpp>

#include <algorithm>
#include <array>
#include <filesystem>
#include <iterator>
#include <utility>

namespace meshorder::command {
namespace {

using distributed::Communicator;
using distributed::GridRows;

/// Opens the files of the pieces at the root. Returns their temporary paths, and their names for messages.
template <class Outputs>
std::array<std::vector<std::string>, 2> opened(const Communicator& communicator,
                                               std::optional<Outputs>& outputs, Index parts) {
  std::vector<std::string> paths =
      communicator.broadcast(communicator.at_root([&] { return outputs->open(parts); }));
  return {std::move(paths), communicator.broadcast(outputs ? outputs->names() : std::vector<std::string>{})};
}

/// Adds the notes of `found` that are new: two writers may report the same loss.
void add_new(const Notes& found, Notes& notes) {
  std::copy_if(found.begin(), found.end(), std::back_inserter(notes), [&](const std::string& note) {
    return std::find(notes.begin(), notes.end(), note) == notes.end();
  });
}

}  // namespace

std::string OrderFiles::name_of_pieces() const {
  const std::string name = without_gz(output.empty() ? input : output).stem().string();
  return name.empty() || name == "." || name == ".." ? "mesh" : name;
}

bool OrderFiles::has_pieces_in_one_file() const {
  return same_but_for_case(std::filesystem::path(pieces).extension().string(), ".vtkhdf");
}

MeshFiles OrderFiles::with_output() const {
  auto result = static_cast<const MeshFiles&>(*this);
  if (!output.empty()) return result;
  result.output = pieces;
  if (!has_pieces_in_one_file() && !has_nemesis_pieces())
    result.output = (std::filesystem::path(pieces) / (name_of_pieces() + ".vtu")).string();
  return result;
}

OrderOutputs::OrderOutputs(const Communicator& communicator, const OrderFiles& files)
    : communicator_(communicator), files_(files) {
  communicator.together([&] {
    if (files.output.empty() && files.pieces.empty())
      throw InvalidArgument("there is nothing to write; give -o FILE, --pieces FOLDER or both");
    if (files.has_nemesis_pieces() && files.ghosts > 0)
      throw InvalidArgument("pieces of Exodus II have no ghost cells: leave --ghosts out, or give 0");
  });
  communicator.at_root([&] {
    if (!files.output.empty()) (void)OutputFile(files.output);
    if (!files.maps.empty()) check_can_write_maps(files.maps);
    if (files.has_pieces_in_one_file()) {
      (void)format_of(files.pieces);  // throws if this build lacks the format
      (void)OutputFile(files.pieces);
      if (!files.output.empty() &&
          std::filesystem::weakly_canonical(files.output) == std::filesystem::weakly_canonical(files.pieces))
        throw InvalidArgument("the output and the pieces cannot be one file");
    } else if (files.has_nemesis_pieces()) {
      nemesis_.emplace(files.pieces);
    } else if (!files.pieces.empty()) {
      pieces_.emplace(files.pieces, files.name_of_pieces());
    }
  });
}

void OrderOutputs::check(const Mesh& mesh) const {
  communicator_.at_root([&] {
    if (files_.pieces.empty()) return;
    Notes none;
    const Format& format = format_named(files_.has_nemesis_pieces() ? "exodus" : "vtu");
    (void)cells_to_write(mesh, pieces_file(), format, true, none);
  });
}

void OrderOutputs::write(const distributed::FileHead& head, const distributed::DistributedOrder& order,
                         const MeshChecksums& before, Notes& notes) {
  distributed::MovedFile moved(communicator_, head, order);
  if (!files_.output.empty()) {
    SharedOutput file(communicator_, set_, files_.output);
    std::optional<SharedOutput> data;
    const std::string name_of_data = moved.new_data(files_.output);
    if (!name_of_data.empty()) data.emplace(communicator_, set_, FilePath::derived(name_of_data));
    moved.write({file.path(), files_.output, data ? data->path() : "", name_of_data});
    file.commit();
    if (data) data->commit();
    written_.mesh = files_of_mesh(set_, files_.output);
    if (!files_.maps.empty()) {
      written_.maps =
          write_sliced_maps(communicator_, {order.new_vertices, moved.new_cells(), order.report.part_starts},
                            before, moved.slice(), files_.maps, set_);
    }
  }
  if (!files_.pieces.empty()) write_pieces(moved.grid(), order.report, notes);
}

void OrderOutputs::write(const distributed::ExodusSlices& slices, const distributed::DistributedOrder& order,
                         const MeshChecksums& before, Notes& notes) {
  distributed::MovedPart moved(
      communicator_, slices.read_part(communicator_, notes), order,
      files_.has_nemesis_pieces() ? slices.block_ends() : std::vector<distributed::GlobalIndex>(), notes);
  if (!files_.maps.empty()) {
    written_.maps =
        write_sliced_maps(communicator_,
                          {order.new_vertices, moved.new_places(Association::cells), order.report.part_starts,
                           moved.ids(Association::vertices), moved.ids(Association::cells)},
                          before, moved.slice(), files_.maps, set_);
  }
  if (files_.has_nemesis_pieces()) return write_nemesis(std::move(moved), slices, order.report);
  Notes of_pieces;
  write_pieces(moved_grid(communicator_, moved, of_pieces), order.report, notes);
  add_new(of_pieces, notes);
}

void OrderOutputs::write(const MeshToOrder& whole, const distributed::DistributedOrder& order, Notes& notes) {
  communicator_.at_root([&] { written_ = write_ordered(whole, files_, set_, notes); });
  if (files_.pieces.empty()) return;
  if (files_.has_nemesis_pieces()) return write_nemesis(whole, order.report, notes);
  Notes of_pieces;
  const GridRows grid = scattered_grid(communicator_, whole.mesh, of_pieces);
  communicator_.at_root([&] { refuse_losses(of_pieces); });
  write_pieces(grid, order.report, notes);
  add_new(of_pieces, notes);
}

void OrderOutputs::write_nemesis(const MeshToOrder& whole, const distributed::DistributedReport& report,
                                 Notes& notes) {
  communicator_.at_root([&] {
    Notes of_pieces;
    const std::vector<std::string> paths = nemesis_->open(report.parts);
    pieces_report_.ghost_vertices = distributed::write_nemesis_pieces(whole.mesh, report.part_starts, paths,
                                                                      nemesis_->names(), of_pieces);
    nemesis_->add_to(set_);
    refuse_losses(of_pieces);
    add_new(of_pieces, notes);
  });
}

void OrderOutputs::write_nemesis(distributed::MovedPart moved, const distributed::ExodusSlices& slices,
                                 const distributed::DistributedReport& report) {
  const auto [paths, names] = opened(communicator_, nemesis_, report.parts);
  pieces_report_.ghost_vertices = distributed::write_nemesis_pieces(
      communicator_, std::move(moved), slices.block_ends(), report.part_starts, paths, names);
  communicator_.at_root([&] { nemesis_->add_to(set_); });
}

void OrderOutputs::write_pieces(const GridRows& grid, const distributed::DistributedReport& report,
                                Notes& notes) {
  const distributed::PieceSchema schema = schema_of_pieces(communicator_, grid, files_.ghosts);
  Notes lacking;
  if (!schema.replaced().empty())
    lacking = {"the pieces have other arrays of the names " + join(schema.replaced())};
  if (files_.has_pieces_in_one_file()) {
    const Notes losses = losses_in_vtkhdf(schema);
    lacking.insert(lacking.end(), losses.begin(), losses.end());
  }
  communicator_.at_root([&] { refuse_losses(lacking); });
  if (files_.has_pieces_in_one_file()) {
    SharedOutput file(communicator_, set_, files_.pieces);
    pieces_report_ = distributed::write_pieces_to_vtkhdf(communicator_, grid, schema, report.part_starts,
                                                         files_.ghosts > 0, file.path(), files_.pieces);
    file.commit();
    communicator_.at_root([&] {
      refuse_losses(pieces_report_.notes);
      add_new(lacking, notes);
      add_new(pieces_report_.notes, notes);
    });
    return;
  }
  const auto [paths, names] = opened(communicator_, pieces_, report.parts);
  pieces_report_ = distributed::write_pieces(communicator_, grid, schema, report.part_starts,
                                             files_.ghosts > 0, paths, names);
  communicator_.at_root([&] {
    pieces_->add_to(set_, schema.index(pieces_->names()));
    add_new(lacking, notes);
  });
}

void OrderOutputs::refuse_losses(const Notes& losses) const {
  if (files_.keeping.strict && !losses.empty())
    throw InputError(pieces_file(), losses.front(), "file not written: --strict forbids data loss");
}

void OrderOutputs::commit(Notes& notes) {
  communicator_.at_root([&] {
    set_.commit();
    notes.insert(notes.end(), set_.notes().begin(), set_.notes().end());
  });
}

}  // namespace meshorder::command
