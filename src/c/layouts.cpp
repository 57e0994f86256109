// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// The C interface to layouts for graphics processors.
#include "c/arguments.hpp"
#include <meshorder/layouts.hpp>

#include <algorithm>
#include <memory>
#include <span>
#include <utility>

namespace meshorder::c {
namespace {

// The structures that callers get, each with the arrays to which the structure points.

struct OwnedPatches : mo_patches {
  Patches arrays;
};
struct OwnedGatherLists : mo_gather_lists {
  GatherLists arrays;
};
struct OwnedColours : mo_colours {
  Colours arrays;
};

/// A caller's cells, and the options of the call.
struct GivenCells {
  GivenCells(const mo_in* offsets, const mo_in* vertices, const mo_in* vtk_types, std::int64_t n,
             const mo_options* options)
      : GivenCells(offsets, vertices, vtk_types, n, complete_options(options)) {}
  GivenCells(const mo_in* offsets, const mo_in* vertices, const mo_in* vtk_types, std::int64_t n,
             const mo_options& options)
      : types(types_of(vtk_types)),
        base(base_of(options.base)),
        cells(CellsView::mixed(offsets_of(offsets, "cell_offsets"), integers(vertices, "cell_vertices"),
                               std::span(std::as_const(types)), base)),
        vertex_count(static_cast<std::size_t>(n)),
        run(order_options(options).run) {
    if (n < 0) fail("vertex_count", "must not be negative");
  }

  std::vector<std::uint8_t> types;
  int base;
  CellsView cells;
  std::size_t vertex_count;
  Run run;
};

/// Adds the base, 0 or 1, to numbers that count from 0.
template <class T>
void count_from(int base, std::vector<T>& numbers) {
  if (base == 0) return;
  for (T& number : numbers) ++number;
}

/// Sets `*place` to null, then to what `make()` returns. Returns the status.
template <class Made, class Make>
mo_status create(const Made** place, const char* name, const Make& make) {
  if (place != nullptr) *place = nullptr;
  return guarded([&] {
    if (place == nullptr) fail(name, "the pointer to the result is null");
    *place = make().release();
  });
}

template <class Owned, class Made>
void destroy(const Made* made) {
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-static-cast-downcast): `create` made an `Owned`
  const std::unique_ptr<const Owned> ends_here(static_cast<const Owned*>(made));
}

std::size_t cache_of(std::int64_t bytes) {
  if (bytes < 0) fail("cache_bytes", "must not be negative");
  return bytes == 0 ? kGpuCacheBytes : static_cast<std::size_t>(bytes);
}

/// Writes those counts for which the caller's structure has room.
void write_counts(const GpuCost& cost, mo_gpu_counts* counts) {
  mo_gpu_counts all{};
  all.requests = cost.requests;
  all.sectors = cost.sectors;
  all.floor = cost.floor;
  all.dram_bytes = cost.dram_bytes;
  all.dram_floor = cost.dram_floor;
  copy_fields(all, *counts, counts->struct_size, &mo_gpu_counts::requests, &mo_gpu_counts::sectors,
              &mo_gpu_counts::floor, &mo_gpu_counts::dram_bytes, &mo_gpu_counts::dram_floor);
}

void check_counts(const mo_gpu_counts* counts) {
  if (counts == nullptr) fail("counts", "the pointer to the result is null");
  check_struct_size(counts->struct_size, "counts");
}

}  // namespace
}  // namespace meshorder::c

using namespace meshorder;
using namespace meshorder::c;

mo_status mo_patches_create(const mo_in* cell_offsets, const mo_in* cell_vertices, const mo_in* vtk_types,
                            int64_t vertex_count, int32_t size, const mo_options* options,
                            const mo_patches** made) {
  return create(made, "patches", [&] {
    const GivenCells given(cell_offsets, cell_vertices, vtk_types, vertex_count, options);
    auto owned = std::make_unique<OwnedPatches>();
    Patches& arrays = owned->arrays;
    arrays = patches(given.cells, given.vertex_count, size, given.run);
    count_from(given.base, arrays.cells);
    count_from(given.base, arrays.offsets);
    count_from(given.base, arrays.vertices);
    owned->count = std::ssize(arrays.offsets) - 1;
    owned->size = arrays.size;
    owned->vertices_per_cell = arrays.corners_per_cell;
    owned->cells = arrays.cells.data();
    owned->offsets = arrays.offsets.data();
    owned->vertices = arrays.vertices.data();
    owned->local = arrays.local.data();
    return owned;
  });
}

void mo_patches_destroy(const mo_patches* made) { destroy<OwnedPatches>(made); }

mo_status mo_gather_lists_create(const mo_in* cell_offsets, const mo_in* cell_vertices,
                                 const mo_in* vtk_types, int64_t vertex_count, const mo_options* options,
                                 const mo_gather_lists** made) {
  return create(made, "gather_lists", [&] {
    const GivenCells given(cell_offsets, cell_vertices, vtk_types, vertex_count, options);
    auto owned = std::make_unique<OwnedGatherLists>();
    GatherLists& arrays = owned->arrays;
    arrays = gather_lists(given.cells, given.vertex_count, given.run);
    count_from(given.base, arrays.cells);
    count_from(given.base, arrays.offsets);
    owned->offsets = arrays.offsets.data();
    owned->cells = arrays.cells.data();
    owned->corners = arrays.corners.data();
    return owned;
  });
}

void mo_gather_lists_destroy(const mo_gather_lists* made) { destroy<OwnedGatherLists>(made); }

mo_status mo_colours_create(const mo_in* cell_offsets, const mo_in* cell_vertices, const mo_in* vtk_types,
                            int64_t vertex_count, const mo_options* options, const mo_colours** made) {
  return create(made, "colours", [&] {
    const GivenCells given(cell_offsets, cell_vertices, vtk_types, vertex_count, options);
    auto owned = std::make_unique<OwnedColours>();
    Colours& arrays = owned->arrays;
    arrays = colours(given.cells, given.vertex_count, given.run);
    count_from(given.base, arrays.cells);
    count_from(given.base, arrays.starts);
    owned->count = std::ssize(arrays.starts) - 1;
    owned->starts = arrays.starts.data();
    owned->cells = arrays.cells.data();
    return owned;
  });
}

void mo_colours_destroy(const mo_colours* made) { destroy<OwnedColours>(made); }

mo_status mo_sort_corners(const mo_in* cell_offsets, const mo_in* cell_vertices, const mo_in* vtk_types,
                          int64_t vertex_count, const mo_options* options, const mo_out* sorted) {
  return guarded([&] {
    const GivenCells given(cell_offsets, cell_vertices, vtk_types, vertex_count, options);
    check_integers(sorted, given.cells.vertices().size(), "sorted");
    c::write(sort_corners(given.cells, given.vertex_count, given.run), given.vertex_count, given.base, sorted,
             "sorted");
  });
}

mo_status mo_gpu_cost(const mo_in* cell_offsets, const mo_in* cell_vertices, const mo_in* vtk_types,
                      int64_t vertex_count, const char* layout, int64_t cache_bytes,
                      const mo_options* options, mo_gpu_counts* counts) {
  return guarded([&] {
    check_counts(counts);
    if (layout == nullptr) fail("layout", "the name is null; give one such as \"packed\"");
    const GivenCells given(cell_offsets, cell_vertices, vtk_types, vertex_count, options);
    write_counts(
        gpu_cost(given.cells, given.vertex_count, parse_gpu_layout(layout), cache_of(cache_bytes), given.run),
        counts);
  });
}

mo_status mo_gpu_product_cost(const mo_in* offsets, const mo_in* neighbours, int32_t lanes,
                              int64_t cache_bytes, const mo_options* options, mo_gpu_counts* counts) {
  return guarded([&] {
    check_counts(counts);
    const mo_options given = complete_options(options);
    const GraphView graph = graph_of(offsets, neighbours, nullptr, base_of(given.base));
    write_counts(gpu_product_cost(graph, lanes, cache_of(cache_bytes), order_options(given).run), counts);
  });
}
