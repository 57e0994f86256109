// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// The C interface for MPI. Copies the caller's arrays, checks them on all ranks, and turns exceptions into
// statuses.
#include "base/status.hpp"
#include "c/structures.hpp"
#include "distributed/comm/communicator.hpp"
#include "distributed/order/owned_order.hpp"
#include <meshorder/error.hpp>

#include <meshorder_mpi.h>
#include <mpi.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

namespace meshorder {
namespace {

using distributed::Communicator;
using distributed::DistributedOptions;
using distributed::GlobalIndex;
using distributed::Layout;
using distributed::OwnedMesh;

/// The largest number of vertices that a rank may own, so that sums over ranks do not overflow.
constexpr std::int64_t kMostVertices = std::int64_t{1} << 40;

// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): the error of each thread
thread_local std::string last_mpi_error;

void require(bool holds, const std::string& fault) {
  if (!holds) throw InvalidArgument(fault);
}

void require_mpi() {
  int is_on = 0;
  int is_off = 0;
  MPI_Initialized(&is_on);
  MPI_Finalized(&is_off);
  require(is_on != 0 && is_off == 0, "MPI is not initialised");
}

bool lets_threads_call() {
  int given = MPI_THREAD_SINGLE;
  MPI_Query_thread(&given);
  return given >= MPI_THREAD_MULTIPLE;
}

mo_mpi_options default_mpi_options() {
  mo_mpi_options options{};
  options.struct_size = sizeof options;
  options.threads = 1;
  return options;
}

/// Copies the fields of options, except `struct_size`, that lie within the first `size` bytes.
void copy_options(const mo_mpi_options& from, mo_mpi_options& to, std::size_t size) {
  c::copy_fields(from, to, size, &mo_mpi_options::method, &mo_mpi_options::partition,
                 &mo_mpi_options::balance, &mo_mpi_options::seed, &mo_mpi_options::parts,
                 &mo_mpi_options::threads, &mo_mpi_options::interface_last, &mo_mpi_options::reserved);
}

/// An option by its name, with its value as text.
struct NamedOption {
  const char* name;
  std::string value;
};

/// Returns the options that the order depends on and that must be the same on all ranks.
std::array<NamedOption, 6> in_words(const DistributedOptions& options) {
  return {
      {{"method", options.vertices},
       {"partition", std::string(to_string(options.partitioner))},
       {"balance", std::string(to_string(options.balance))},
       {"interface_last", options.interface_place == distributed::InterfacePlace::last ? "true" : "false"},
       {"seed", std::to_string(options.order.seed)},
       {"parts", std::to_string(options.parts)}}};
}

/// Throws on all ranks if an option differs between ranks; otherwise the ranks could wait for each other.
void check_same_options(const Communicator& communicator, const DistributedOptions& options) {
  const std::array<NamedOption, 6> own = in_words(options);
  std::vector<std::string> values(own.size());
  std::ranges::transform(own, values.begin(), &NamedOption::value);
  const std::vector<std::string> at_root = communicator.broadcast(values);
  communicator.together([&] {
    for (std::size_t k = 0; k < own.size(); ++k) {
      require(own[k].value == at_root[k], std::string("options: ") + own[k].name + " is '" + own[k].value +
                                              "', and on rank 0 '" + at_root[k] +
                                              "'; all ranks must give the same options");
    }
  });
}

/// Returns the caller's options. Throws on all ranks if an option is invalid or the ranks' options differ.
DistributedOptions options_of(const Communicator& communicator, const mo_mpi_options* given) {
  DistributedOptions options;
  communicator.together([&] {
    mo_mpi_options all = default_mpi_options();
    if (given != nullptr) {
      c::check_struct_size(given->struct_size, "options");
      copy_options(*given, all, given->struct_size);
    }
    if (all.method != nullptr) options.vertices = all.method;
    if (all.partition != nullptr) options.partitioner = parse<distributed::Partitioner>(all.partition);
    if (all.balance != nullptr) options.balance = parse<distributed::Balance>(all.balance);
    if (all.interface_last != 0) options.interface_place = distributed::InterfacePlace::last;
    require(all.reserved == 0, "options: reserved must be 0; mo_mpi_options_init makes it so");
    require(all.parts >= 0, "options: there cannot be " + std::to_string(all.parts) + " parts");
    options.parts = all.parts;
    options.order.seed = all.seed;
    options.order.run.threads = all.threads;
  });
  check_same_options(communicator, options);
  return options;
}

/// Returns the caller's mesh. Lengths that the caller's older header lacks are 0.
mo_mpi_mesh complete_mesh(const mo_mpi_mesh& given) {
  c::check_struct_size(given.struct_size, "mesh", offsetof(mo_mpi_mesh, cell_vertex_count));
  mo_mpi_mesh mesh{};
  mesh.struct_size = given.struct_size;
  c::copy_fields(given, mesh, given.struct_size, &mo_mpi_mesh::vertex_count, &mo_mpi_mesh::cell_count,
                 &mo_mpi_mesh::cell_offsets, &mo_mpi_mesh::cell_vertices, &mo_mpi_mesh::points,
                 &mo_mpi_mesh::cell_vertex_count, &mo_mpi_mesh::coordinate_count);
  return mesh;
}

/// Copies a rank's arrays to `mesh` and checks the arrays; `mesh.vertices` must be set.
void copy_arrays(const mo_mpi_mesh& given, OwnedMesh& mesh) {
  const GlobalIndex n = mesh.vertices.size();
  const bool has_lengths = given.struct_size >= sizeof given;
  require(given.cell_count >= 0, "cell_count: " + std::to_string(given.cell_count));
  mesh.cells.offsets.reserve(static_cast<std::size_t>(given.cell_count) + 1);
  if (given.cell_count > 0) {
    require(given.cell_offsets != nullptr && given.cell_vertices != nullptr, "cells: an array is null");
    require(given.cell_offsets[0] == 0, "cell_offsets: the first must be 0");
  }
  // check all offsets before using any: the last one is the length of cell_vertices
  for (std::int64_t c = 0; c < given.cell_count; ++c) {
    require(given.cell_offsets[c] < given.cell_offsets[c + 1],
            "cell_offsets: element " + std::to_string(c) + " has no vertices");
  }
  const std::int64_t end = given.cell_count == 0 ? 0 : given.cell_offsets[given.cell_count];
  require(!has_lengths || given.cell_vertex_count == end,
          "cell_vertices: there are " + std::to_string(given.cell_vertex_count) +
              ", and cell_offsets end at " + std::to_string(end));
  for (std::int64_t c = 0; c < given.cell_count; ++c) {
    for (std::int64_t k = given.cell_offsets[c]; k < given.cell_offsets[c + 1]; ++k) {
      const std::int64_t vertex = given.cell_vertices[k];
      require(vertex >= 0 && vertex < n, "cell_vertices: element " + std::to_string(c) + " has the vertex " +
                                             std::to_string(vertex) + ", and there are " + std::to_string(n));
      mesh.cells.entries.push_back(vertex);
    }
    mesh.cells.end_row();
  }
  const std::int64_t coordinates = given.points == nullptr ? 0 : 3 * given.vertex_count;
  require(!has_lengths || given.coordinate_count == coordinates,
          "points: there are " + std::to_string(given.coordinate_count) + " coordinates instead of " +
              std::to_string(coordinates) + "; each vertex needs x y z, with z = 0 in the plane");
  if (given.points == nullptr) return;
  mesh.points.resize(static_cast<std::size_t>(given.vertex_count));
  std::memcpy(mesh.points.data(), given.points, mesh.points.size() * sizeof(Point));
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    const Point& point = mesh.points[v];
    require(std::all_of(point.begin(), point.end(), [](double x) { return std::isfinite(x); }),
            "points: a coordinate of own vertex " + std::to_string(v) + " is not finite");
  }
}

OwnedMesh mesh_of(const Communicator& communicator, const mo_mpi_mesh* given) {
  mo_mpi_mesh whole{};
  communicator.together([&] {
    require(given != nullptr, "mesh: null");
    whole = complete_mesh(*given);
    require(whole.vertex_count >= 0 && whole.vertex_count <= kMostVertices,
            "vertex_count: " + std::to_string(whole.vertex_count));
  });
  const std::vector<std::int64_t> counts = communicator.gathered(whole.vertex_count);
  OwnedMesh mesh;
  communicator.together([&] {
    std::vector<GlobalIndex> starts{0};
    for (const std::int64_t count : counts) starts.push_back(starts.back() + count);
    mesh.vertices = Layout(std::move(starts));
    copy_arrays(whole, mesh);
  });
  return mesh;
}

/// Writes numbers to the caller's array; does nothing if the array is null.
///
/// @param wanted  name of the array if it is required: a rank with numbers but a null array then makes all
///                ranks throw. Null: the array is optional
void write(const Communicator& communicator, const std::vector<GlobalIndex>& numbers, std::int64_t* to,
           const char* wanted = nullptr) {
  communicator.together([&] {
    require(to != nullptr || wanted == nullptr || numbers.empty(),
            std::string(wanted ? wanted : "") + ": null");
    if (to != nullptr) std::copy(numbers.begin(), numbers.end(), to);
  });
}

}  // namespace
}  // namespace meshorder

using namespace meshorder;

void mo_mpi_options_init(mo_mpi_options* options, size_t struct_size) {
  c::fill_struct(options, struct_size,
                 [&](mo_mpi_options& to) { copy_options(default_mpi_options(), to, struct_size); });
}

mo_status mo_mpi_order_ranks(int32_t communicator, const mo_mpi_mesh* mesh, const mo_mpi_options* options,
                             int64_t* new_numbers, int64_t* cell_order) {
  return status_of(
      [&] {
        require_mpi();
        const Communicator ranks(MPI_Comm_f2c(communicator));
        const DistributedOptions wanted = options_of(ranks, options);
        const distributed::OwnedOrder order = order_owned(ranks, mesh_of(ranks, mesh), wanted);
        write(ranks, order.new_numbers, new_numbers, "new_numbers");
        write(ranks, order.cells, cell_order);
      },
      last_mpi_error);
}

mo_status mo_mpi_order_parts(int32_t communicator, const mo_mpi_mesh* mesh, const mo_mpi_options* options,
                             int64_t* new_numbers, int64_t* part_starts, int64_t* cell_parts) {
  return status_of(
      [&] {
        require_mpi();
        const Communicator ranks(MPI_Comm_f2c(communicator));
        DistributedOptions wanted = options_of(ranks, options);
        if (wanted.partitioner == distributed::Partitioner::ptscotch && !lets_threads_call())
          wanted.partitioner = distributed::Partitioner::hilbert;
        OwnedMesh owned = mesh_of(ranks, mesh);
        ranks.together([&] {
          const GlobalIndex vertices = owned.vertices.size();
          require(wanted.parts <= vertices, "options: the mesh has " + std::to_string(vertices) +
                                                " vertices, too few for " + std::to_string(wanted.parts) +
                                                " parts");
        });
        const distributed::OwnedParts parts = order_parts_of_owned(ranks, std::move(owned), wanted);
        write(ranks, parts.new_numbers, new_numbers, "new_numbers");
        write(ranks, parts.starts, part_starts, "part_starts");
        write(ranks, parts.cells, cell_parts);
      },
      last_mpi_error);
}

const char* mo_mpi_last_error() { return last_mpi_error.c_str(); }
