// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/scenario/frames.hpp"

#include "io/format.hpp"
#include "io/stream/output_file.hpp"
#include "io/vtk/vtk.hpp"
#include "lab/scenario/scenario_obstacles.hpp"
#include "lab/scenario/vertex_choice.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <iterator>
#include <memory>
#include <system_error>
#include <utility>

namespace meshorder {
namespace {
namespace fs = std::filesystem;

// the frame's own arrays come first: of arrays with one name, the writer renames all but the first
enum OwnArray : std::uint8_t { kDisplacement, kVelocity, kOriginalVertex, kOriginalCell };

std::vector<Index> old_places(const Permutation& order) {
  return {order.new_to_old().begin(), order.new_to_old().end()};
}

std::vector<DataArray> own_arrays(const Mesh& mesh, const MeshOrder& order) {
  std::vector<float> zeros(3 * mesh.points.size(), 0.0F);
  std::vector<DataArray> arrays(4);
  arrays[kDisplacement] = {"displacement", Association::vertices, 3, zeros, {}, {}};
  arrays[kVelocity] = {"velocity", Association::vertices, 3, std::move(zeros), {}, {}};
  arrays[kOriginalVertex] = {
      "original_vertex", Association::vertices, 1, old_places(order.vertices.permutation), {}, {}};
  arrays[kOriginalCell] = {
      "original_cell", Association::cells, 1, old_places(order.cells.permutation), {}, {}};
  return arrays;
}

/// Returns metadata for compressed .vtu files, based on the mesh's own metadata if it was read from VTK.
std::shared_ptr<vtk::VtkMetadata> metadata_of(const Mesh& mesh) {
  const auto* const own = dynamic_cast<const vtk::VtkMetadata*>(mesh.format_metadata.get());
  auto metadata =
      own != nullptr ? std::make_shared<vtk::VtkMetadata>(*own) : std::make_shared<vtk::VtkMetadata>();
  metadata->legacy.reset();
  metadata->float_points = true;
  // raw bytes would be a quarter smaller but are not XML: meshio 5.0 misreads one file in some hundreds
  metadata->vtu =
      VtuEncoding{.mode = VtuEncoding::Mode::appended_base64, .compressor = VtuEncoding::Compressor::zlib};
  return metadata;
}

}  // namespace

FrameWriter::FrameWriter(const Simulation& simulation, fs::path folder, Index every)
    : folder_(std::move(folder)),
      name_(simulation.scenario.name),
      every_(every),
      fluid_(dynamic_cast<const Fluid*>(simulation.body.get())),
      collection_(folder_ / (name_ + ".pvd")),
      rest_(simulation.mesh.points),
      embedded_(embed_vertices(simulation.mesh, cut_into_simplices(simulation.mesh))),
      frame_(simulation.mesh) {
  if (every < 1)
    throw InvalidArgument("frames: the number of steps from one to the next is " + std::to_string(every) +
                          ", not 1 or more");
  std::error_code code;
  fs::create_directories(folder_, code);
  if (code)
    throw InputError(folder_.string(), "cannot be made: " + code.message(), "name a folder for the frames");
  (void)OutputFile(FilePath::derived(collection_));  // fail before the work if it cannot be written
  frame_.format_metadata = metadata_of(simulation.mesh);
  if (fluid_ != nullptr) return;
  std::vector<DataArray> arrays = own_arrays(frame_, simulation.order);
  arrays.insert(arrays.end(), std::make_move_iterator(frame_.data.begin()),
                std::make_move_iterator(frame_.data.end()));
  frame_.data = std::move(arrays);
  frame_.vertex_ids.clear();  // ids would only repeat the order
  frame_.cell_ids.clear();
  write_obstacles(simulation);
}

void FrameWriter::write_obstacles(const Simulation& simulation) const {
  if (!simulation.scenario.is_projective() || simulation.scenario.projective().obstacles.empty()) return;
  const double extent = bounding_box(rest_, simulation.vertices).longest_side();
  write_mesh_to(surfaces_of(simulation.scenario.projective().obstacles, extent),
                FilePath::derived(folder_ / (name_ + "-obstacles.vtu")), {});
}

std::string FrameWriter::file_name(Index step) const { return fmt::format("{}-{:06}.vtu", name_, step); }

void FrameWriter::list(Index step, double time) { entries_.push_back({time, file_name(step)}); }

void FrameWriter::resume_after(const MotionRecord& record) {
  std::error_code code;
  double time = 0;
  for (Index step = 0; step <= index_size(record.steps); ++step) {
    const double last = step > 0 ? record.steps[step - 1].report.time_step : 0;
    time = fluid_ != nullptr ? time + last : step * last;
    if (is_due(step) && fs::exists(folder_ / file_name(step), code)) list(step, time);
  }
}

void FrameWriter::take(const MotionState& state) {
  auto& displacement = std::get<std::vector<float>>(frame_.data[kDisplacement].values);
  auto& velocity = std::get<std::vector<float>>(frame_.data[kVelocity].values);
  for (std::size_t v = 0; v < rest_.size(); ++v) {
    for (std::size_t c = 0; c < 3; ++c) {
      displacement[3 * v + c] = static_cast<float>(state.positions[v][c] - rest_[v][c]);
      velocity[3 * v + c] = static_cast<float>(state.velocities[v][c]);
      frame_.points[v][c] = static_cast<float>(state.positions[v][c]);
    }
  }
}

void FrameWriter::take(const Fluid& fluid, const MotionState& state) {
  const std::vector<Index>& numbers = fluid.numbers();
  std::vector<float> velocity(3 * numbers.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      velocity[3 * i + c] = static_cast<float>(state.velocities[numbers[i]][c]);
      frame_.points[i][c] = static_cast<float>(state.positions[numbers[i]][c]);
    }
  }
  const std::vector<double>& pressures = fluid.pressures();
  frame_.data = {
      {"velocity", Association::vertices, 3, std::move(velocity), {}, {}},
      {"pressure", Association::vertices, 1, std::vector<float>(pressures.begin(), pressures.end()), {}, {}},
      {"original_vertex", Association::vertices, 1, numbers, {}, {}}};
  frame_.cells = fluid.mesh().cells();
}

void FrameWriter::write(MotionState state) {
  if (fluid_ != nullptr) {
    take(*fluid_, state);
  } else {
    move_embedded(embedded_, rest_, state);
    take(state);
  }
  Notes notes;
  write_mesh_to(frame_, FilePath::derived(folder_ / file_name(state.step)), {.notes = &notes});
  if (entries_.empty()) notes_ = std::move(notes);
  list(state.step, state.time);
  write_pvd(entries_, FilePath::derived(collection_));
}

}  // namespace meshorder
