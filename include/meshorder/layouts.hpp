// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

// Layouts for graphics processors, where many threads work on elements at once, and what kernels cost there.
// Order the mesh first: a layout keeps the order of cells and vertices, and is better if elements that share
// vertices are near each other.

#include <meshorder/export.hpp>
#include <meshorder/options.hpp>
#include <meshorder/view.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace meshorder {
inline namespace v0_3 {

/// Cells in patches of `size`, one patch for each block of threads. The block loads the patch's vertices into
/// shared memory, uses their local numbers, adds up its results there, and then adds the sums to the results
/// in global memory.
struct Patches {
  int size = 0;                      ///< cells of each patch; the last may have fewer
  int corners_per_cell = 0;          ///< k
  std::vector<Index> cells = {};     ///< old numbers of the m cells; those of patch p begin at p · size
  std::vector<Offset> offsets{0};    ///< patches + 1: where the vertices of each patch begin
  std::vector<Index> vertices = {};  ///< the vertices of each patch, ascending
  /// m · k: corner a of `cells[i]` is vertex local[i · k + a] of its patch.
  std::vector<std::uint16_t> local = {};

  /// Returns the number of patches.
  [[nodiscard]] std::size_t count() const noexcept { return offsets.size() - 1; }
  /// Returns the vertices of a patch.
  [[nodiscard]] std::span<const Index> vertices_of(std::size_t patch) const& MESHORDER_LIFETIMEBOUND {
    return {vertices.data() + offsets[patch], vertices.data() + offsets[patch + 1]};
  }
  [[nodiscard]] std::span<const Index> vertices_of(std::size_t patch) const&& = delete;
};

/// Cuts cells into patches of `size` consecutive cells. Within a patch, neighbouring cells are spread over
/// the warps of 32 threads, so that few threads of a warp add to the same vertex in shared memory.
///
/// @param cells         cells with the same number of vertices k; edges are lines
/// @param vertex_count  n
/// @param size          cells of a patch, 2 … 65,535 / k; multiples of 32 fill all warps
/// @param run           threads
/// @throws InvalidArgument for faulty cells, cells of several types, and a size out of range
/// @throws TooLarge for more than 2,147,483,647 vertices or cells
/// @note O(m k log(size · k) + n · threads) time. Memory besides the result: 2 n bytes for each thread, and
///       for a while a second copy of `vertices`. The same result on any number of threads.
[[nodiscard]] MESHORDER_API Patches patches(const CellsView& cells, std::size_t vertex_count, int size = 256,
                                            const Run& run = {});

/// The cells at each vertex. Instead of adding to vertices, a first pass stores the contribution of each cell
/// to each corner, and a second pass sums the contributions to each vertex. No two threads write to the same
/// place.
struct GatherLists {
  std::vector<Offset> offsets{0};          ///< n + 1: where the entries of each vertex begin
  std::vector<Index> cells = {};           ///< the cells of each vertex, ascending
  std::vector<std::uint8_t> corners = {};  ///< position of the vertex in each of these cells
};

/// Returns the gather lists of cells, which may be of several types, with at most 256 vertices each.
///
/// @throws InvalidArgument for faulty cells and for cells with more vertices; TooLarge as `patches`
/// @note O(Σ vertices of a cell + n) on one thread. If a cell names a vertex twice, the list of that vertex
///       has the cell twice.
[[nodiscard]] MESHORDER_API GatherLists gather_lists(const CellsView& cells, std::size_t vertex_count,
                                                     const Run& run = {});

/// Cells by colour: no two cells of a colour share a vertex, so that threads may work on them at once.
struct Colours {
  std::vector<Index> starts{0};   ///< colours + 1: where the cells of each colour begin
  std::vector<Index> cells = {};  ///< all cells, colour after colour, in their old order within a colour

  [[nodiscard]] std::size_t count() const noexcept { return starts.size() - 1; }
};

/// Colours cells in their order; edges are lines. Each cell gets the first of 256 colours that no cell at its
/// vertices has. If all 256 are taken, it gets the first colour after all colours at its vertices.
///
/// @throws InvalidArgument for faulty cells; TooLarge as `patches`
/// @note O(Σ vertices of a cell + n) on one thread. Memory besides the result: 40 bytes a vertex, 4 bytes a
///       cell. The number of colours is at least the largest number of cells at a vertex.
[[nodiscard]] MESHORDER_API Colours colours(const CellsView& cells, std::size_t vertex_count,
                                            const Run& run = {});

/// Sorts the vertices of each linear triangle or tetrahedron as far as its orientation allows. A triangle
/// begins with its smallest vertex. The vertices of a tetrahedron ascend; the last two are swapped if
/// ascending order would reverse the orientation. The threads of a warp then read from and add to places that
/// are nearer each other.
///
/// @return m · k vertices
/// @throws InvalidArgument for faulty cells and for other types; TooLarge as `patches`
/// @note O(m), on all threads.
[[nodiscard]] MESHORDER_API std::vector<Index> sort_corners(const CellsView& cells, std::size_t vertex_count,
                                                            const Run& run = {});

/// How a kernel stores the 4-byte values of vertices: the values that it reads for its cells, and the values
/// that it adds to. `patches` and `gathered` have the three values of a vertex side by side.
enum class GpuLayout {
  packed,   ///< the three values of a vertex side by side, each added separately
  apart,    ///< three arrays, one for each of a vertex's values
  padded,   ///< four values of a vertex side by side, added at once
  patches,  ///< as `packed`, in patches of 256 cells: each block adds once to each of its vertices
  gathered  ///< two passes: cells store 16 bytes per corner, then vertices sum these by their gather lists
};

/// All values of `GpuLayout`.
inline constexpr std::array kGpuLayouts{GpuLayout::packed, GpuLayout::apart, GpuLayout::padded,
                                        GpuLayout::patches, GpuLayout::gathered};

/// Returns "packed", "apart", "padded", "patches" or "gathered". Valid for the life of the program.
MESHORDER_API std::string_view to_string(GpuLayout layout);

/// Returns the layout of that name; throws InvalidArgument for an unknown one.
MESHORDER_API GpuLayout parse_gpu_layout(std::string_view name);

/// Bytes of the last cache of an NVIDIA H100.
inline constexpr std::size_t kGpuCacheBytes = std::size_t{50} << 20;

/// Cost of a kernel on a graphics processor.
struct GpuCost {
  Offset requests = 0;  ///< additions, or loads and stores; one request serves the 32 threads of a warp
  /// 32-byte sectors that these requests touch. If t threads of a warp add to the same value, they wait for
  /// each other: the sector counts t times, with the largest t of its values.
  Offset sectors = 0;
  /// What `sectors` would be if the values that each warp touches at once were all different and side by side
  /// and, for patches, no vertex were in two patches.
  Offset floor = 0;
  Offset dram_bytes = 0;  ///< bytes that the last cache reads from memory
  Offset dram_floor = 0;  ///< what `dram_bytes` would be if each number were read once

  bool operator==(const GpuCost&) const = default;
};

/// Counts what adding to the vertices of cells costs on a graphics processor, with one thread for each cell.
/// Of two orders of the same cells, the one with fewer sectors is faster there. The counters of an NVIDIA
/// H100 agree within 1.2 % for tetrahedra; docs/gpu.md has all figures.
///
/// `sectors` counts the sectors of atomic additions; for `gathered`, the sectors that the first pass stores
/// and the second pass loads. `dram_bytes` counts two things:
/// - the cells' vertex numbers, of 4 bytes each, or 2 bytes within patches;
/// - the values of each vertex in two arrays: one array is read, the other is added to.
///
/// Other data of the cells is not counted.
///
/// @param cells         cells with the same number of vertices; edges are lines
/// @param vertex_count  n
/// @param layout        where the values of vertices are
/// @param cache_bytes   size of the last cache, ≥ 1
/// @param run           threads
/// @throws InvalidArgument for faulty cells, cells of several types and a cache of 0 bytes; for the layouts
///                         `patches` and `gathered`, also as the functions `patches` and `gather_lists`;
///                         TooLarge as `patches`
/// @note O(Σ vertices of a cell), on all threads except for `dram_bytes` and `gathered`.
[[nodiscard]] MESHORDER_API GpuCost gpu_cost(const CellsView& cells, std::size_t vertex_count,
                                             GpuLayout layout, std::size_t cache_bytes = kGpuCacheBytes,
                                             const Run& run = {});

/// Counts what the product of a sparse matrix with a vector costs on a graphics processor. The matrix has an
/// entry for each neighbour in the graph, and a diagonal, in compressed sparse rows with numbers of 4 bytes.
///
/// `sectors` and `dram_bytes` count the loads of offsets, columns, values and the vector. Loops are unrolled
/// as by NVIDIA's compiler. The counters of an NVIDIA H100 showed the same numbers (docs/gpu.md).
///
/// @param graph        the pattern of the matrix, which is symmetric
/// @param lanes        threads per row: 1, 2, 4, 8, 16 or 32
/// @param cache_bytes  size of the last cache, ≥ 1
/// @param run          threads
/// @throws InvalidArgument for another value of `lanes`, for a cache of 0 bytes, and as `quality`; TooLarge
///         as `quality`
/// @note O(n + entries), on all threads except for `dram_bytes`. Memory: a copy of the graph.
[[nodiscard]] MESHORDER_API GpuCost gpu_product_cost(const GraphView& graph, int lanes = 1,
                                                     std::size_t cache_bytes = kGpuCacheBytes,
                                                     const Run& run = {});

}  // namespace v0_3
}  // namespace meshorder
