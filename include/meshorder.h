/* Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT */
#ifndef MESHORDER_H
#define MESHORDER_H

/**
 * @file
 * The C interface of meshorder (C99): orders graphs and meshes, computes Fiedler vectors, makes layouts for
 * graphics processors, adds a user's own methods. Its binary interface is stable: structures only grow at
 * their end; functions and the values of constants do not change.
 *
 * Every function returns MO_OK or the status of its failure, unless stated otherwise. After a failure
 * `mo_last_error` returns the reason as a sentence, and outputs are unspecified. Several threads may call
 * functions at once. No function throws, and a callback must not throw or longjmp.
 */

#include <stddef.h>
#include <stdint.h>

#if defined(_WIN32)
#if defined(MESHORDER_BUILDING)
#define MO_API __declspec(dllexport)
#else
#define MO_API __declspec(dllimport)
#endif
#define MO_EXPORT __declspec(dllexport)
#elif defined(__GNUC__)
#define MO_API __attribute__((visibility("default")))
#define MO_EXPORT __attribute__((visibility("default")))
#else
#define MO_API
#define MO_EXPORT
#endif

#ifdef __cplusplus
extern "C" {
#endif

/** Status of a call. */
typedef int32_t mo_status;
enum {
  MO_OK = 0,
  MO_INVALID_ARGUMENT = 1, /**< a mistake of the caller, such as an unknown method or a NaN */
  MO_BAD_INPUT = 2,        /**< a faulty file */
  MO_TOO_LARGE = 3,        /**< a size beyond a limit, such as 2^31 vertices, or beyond an output's type */
  MO_UNAVAILABLE = 4,      /**< a method that this build lacks */
  MO_STOPPED = 5,          /**< the progress callback returned non-zero */
  MO_IO = 6,               /**< the operating system refused an operation on a file */
  MO_INTERNAL = 7,         /**< meshorder, a library that it uses, or a user's method failed */
  MO_OUT_OF_MEMORY = 8
};

/** Type of the numbers of an array. MO_UINT8 is for `vtk_types` only. Data of vertices and cells need no
 * type: `mo_move` moves rows of any number of bytes. */
typedef int32_t mo_type;
enum { MO_INT32 = 0, MO_UINT32 = 1, MO_INT64 = 2, MO_UINT64 = 3, MO_FLOAT = 4, MO_DOUBLE = 5, MO_UINT8 = 6 };

/** An array that the call reads; `data` must be aligned for `type`. A null pointer to this structure, or size
 * 0, means no array. */
typedef struct mo_in {
  const void* data;
  int64_t size; /**< number of numbers, not of bytes; >= 0 */
  mo_type type;
} mo_in;

/** An array that the call writes; `data` must be aligned for `type`. A null pointer to this structure means
 * that the result is not wanted. */
typedef struct mo_out {
  void* data;
  int64_t size; /**< number of numbers; must be that of the result */
  mo_type type;
} mo_out;

/** Values of mo_options.check. */
enum {
  MO_CHECK_FULL = 0, /**< everything */
  MO_CHECK_FAST = 1, /**< everything but symmetry: accepts an asymmetric graph */
  MO_CHECK_NONE = 2  /**< nothing: faulty input is undefined behaviour */
};

/** Options of a call. `mo_options_init` fills in the defaults; a null pointer means the defaults. */
typedef struct mo_options {
  size_t struct_size;         /**< sizeof(mo_options) of the caller */
  const char* method;         /**< vertex method; null: "auto" */
  const char* element_method; /**< element method; null: "auto" */
  const char* workload; /**< what "auto" optimises: "all" (null), "element", "spmv", "assembly", "springs",
                             "bandwidth", "fill", "gpu" */
  uint64_t seed;        /**< default 0 */
  double tolerance;     /**< of Fiedler vectors, relative to lambda2, > 0; default 0.1 */
  double time_limit;    /**< seconds, after which the best order so far is returned; default infinity */
  int32_t threads;      /**< most threads; 0 (default): as many as TBB would use */
  int32_t base;         /**< first offset and first vertex number, of inputs and outputs; 0 (default) or 1 */
  int32_t check;        /**< MO_CHECK_...; default MO_CHECK_FULL */
  int32_t symmetrize;   /**< non-zero: order the pattern of A + A^T; default 0: refuse asymmetric input */
  mo_in start;          /**< an estimate of the Fiedler vector: n numbers, or none */
  mo_in groups;         /**< group of each vertex, or none; groups stay together and ascend */
  /** Called now and then on the calling thread, with the name of the stage and the fraction done: 0 ... 1, or
   * -1 if unknown. A non-zero result stops the call. */
  int32_t (*progress)(void* user, const char* stage, double fraction);
  void* user;             /**< passed to `progress` */
  int32_t max_iterations; /**< of the eigensolver, >= 1; default 500 */
  int32_t reserved;       /**< 0 */
  mo_in cell_groups;      /**< group of each cell, or none; kept together within each dimension */
} mo_options;

/** Report on a call. Set `struct_size` to sizeof(mo_result) before the call. Pass null for no report. */
typedef struct mo_result {
  size_t struct_size;
  int32_t complete;   /**< 0: the time limit ended the call early */
  int32_t components; /**< number of connected components if Fiedler vectors were computed, else 0 */
  double seconds;     /**< wall-clock time */
  double lambda2;     /**< of the largest component, if Fiedler vectors were computed; else 0 */
  char method[32];    /**< the method that was used, null-terminated; cut if longer */
} mo_result;

/** Returns the version of the library: 10000 major + 100 minor + patch. Never fails. */
MO_API uint32_t mo_version(void);

/** Returns the one-line message of this thread's last failure; "" if there was none. Valid until this
 * thread's next call. */
MO_API const char* mo_last_error(void);

/** Fills in the defaults. `struct_size` is sizeof(mo_options) of the caller. Does nothing for a null pointer.
 */
MO_API void mo_options_init(mo_options* options, size_t struct_size);

/**
 * Orders the vertices of an undirected graph or the rows of a matrix, given in compressed sparse rows.
 *
 * @param offsets     n + 1, ascending, the first is `base`
 * @param neighbours  (offsets[n] - base) vertex numbers, from `base` on; loops and repeats are ignored
 * @param weights     one positive number for each neighbour, or null; fiedler uses them
 * @param points      dimension * n coordinates x y z x y z ..., or null; geometric methods need them
 * @param dimension   1 to 3; not used without points
 * @param options     or null
 * @param new_to_old  n integers, or null: the old number of the vertex at each new place, from `base` on
 * @param old_to_new  n integers, or null: the new number of each old vertex, from `base` on
 * @param result      or null
 */
MO_API mo_status mo_order_graph(const mo_in* offsets, const mo_in* neighbours, const mo_in* weights,
                                const mo_in* points, int32_t dimension, const mo_options* options,
                                const mo_out* new_to_old, const mo_out* old_to_new, mo_result* result);

/**
 * Orders the vertices and cells of a mesh.
 *
 * @param cell_offsets       cells + 1, ascending, the first is `base`
 * @param cell_vertices      vertices of the cells, from `base` on
 * @param vtk_types          VTK's type of each cell, in integers of any type (VTK's are MO_UINT8); null: all
 *                           cells have one dimension
 * @param vertex_count       n; 0: as many as there are points
 * @param points             dimension * n coordinates, or null
 * @param dimension          1 to 3; not used without points
 * @param options            or null
 * @param vertex_new_to_old  n integers, or null
 * @param vertex_old_to_new  n integers, or null
 * @param cell_new_to_old    one integer for each cell, or null
 * @param cell_old_to_new    one integer for each cell, or null
 * @param vertex_result      or null
 * @param cell_result        or null
 */
MO_API mo_status mo_order_mesh(const mo_in* cell_offsets, const mo_in* cell_vertices, const mo_in* vtk_types,
                               int64_t vertex_count, const mo_in* points, int32_t dimension,
                               const mo_options* options, const mo_out* vertex_new_to_old,
                               const mo_out* vertex_old_to_new, const mo_out* cell_new_to_old,
                               const mo_out* cell_old_to_new, mo_result* vertex_result,
                               mo_result* cell_result);

/**
 * Orders edges by the larger of the new places of their two ends, then by the smaller place. A loop over the
 * edges then reaches the vertices nearly in their new order. The function does not change `ends`.
 *
 * @param ends               2 for each edge, from `base` on: old numbers, so call this function before you
 *                           renumber the ends. If the ends are renumbered already, pass the identity
 *                           (base, base + 1, ...) as `vertex_new_to_old`
 * @param vertex_new_to_old  the order of the vertices, a bijection from `base` on
 * @param base               0 or 1
 * @param new_to_old         one integer for each edge: the old number of the edge at each new place
 */
MO_API mo_status mo_order_edges(const mo_in* ends, const mo_in* vertex_new_to_old, int32_t base,
                                const mo_out* new_to_old);

/** Keeps the order of a changing graph, mesh or set of particles up to date. One update at a time. */
typedef struct mo_reorderer mo_reorderer;

/** How an update found its order, the cheapest first. */
enum {
  MO_REPAIR_NONE = 0,    /**< nothing moves */
  MO_REPAIR_CARRIED = 1, /**< vertices that stayed keep their order, new ones come next to their neighbours */
  MO_REPAIR_WARM = 2,    /**< computed again, from the last Fiedler vector */
  MO_REPAIR_FRESH = 3    /**< computed again from the start */
};

/**
 * Makes a reorderer. Destroy it by `mo_reorderer_destroy`.
 *
 * @param options         options of every order, or null; `start`, `groups` and `cell_groups` must be empty,
 *                        and `progress` and `user` must stay valid until the reorderer is destroyed
 * @param slack           >= 0; usual: 0.02. A new order is sought if the mean log2 of the edges' spans is
 *                        above 1 + slack times its value after the last search for a new order. For points
 *                        without edges, the limit is that value + slack * log2(number of points + 1)
 * @param budget_seconds  >= 0; no new order is computed if the last computation took longer. Infinity: no
 *                        limit
 * @param reorderer       written; null after a failure
 */
MO_API mo_status mo_reorderer_create(const mo_options* options, double slack, double budget_seconds,
                                     mo_reorderer** reorderer);

/** Destroys a reorderer; does nothing for a null pointer. */
MO_API void mo_reorderer_destroy(mo_reorderer* reorderer);

/**
 * Brings the order up to date. Call this function when connectivity or positions have changed, and move all
 * arrays by the result.
 *
 * @param reorderer   made by `mo_reorderer_create`
 * @param offsets     n + 1, ascending, the first is the base of the options; null if there are only points
 * @param neighbours  (offsets[n] - base) vertex numbers, from the base on; or null
 * @param points      dimension * n coordinates, or null
 * @param dimension   1 to 3; not used without points
 * @param previous    place of each vertex after the last update, from the base on, no place twice; base - 1
 *                    for a new vertex; null: the same vertices in the same places
 * @param new_to_old  n integers, or null: the present place of the vertex at each new place, from the base on
 * @param old_to_new  n integers, or null: the new place of each vertex, from the base on
 * @param repair      how the order was found, MO_REPAIR_...; or null
 */
MO_API mo_status mo_reorderer_update(mo_reorderer* reorderer, const mo_in* offsets, const mo_in* neighbours,
                                     const mo_in* points, int32_t dimension, const mo_in* previous,
                                     const mo_out* new_to_old, const mo_out* old_to_new, int32_t* repair);

/** Reports how many seconds, >= 0, the step after the last update took. From the fifth report on, a new order
 * is computed once slower steps have lost more time than a new order costs. Optional. */
MO_API mo_status mo_reorderer_observe(mo_reorderer* reorderer, double step_seconds);

/**
 * Computes the Fiedler vector of every connected component. Each vector has norm 1 and sum 0; isolated
 * vertices have 0.
 *
 * @param offsets     n + 1, ascending, the first is `base`
 * @param neighbours  (offsets[n] - base) vertex numbers, from `base` on; loops and repeats are ignored
 * @param weights     one positive number for each neighbour, or null
 * @param options     or null
 * @param values      n numbers of type MO_DOUBLE or MO_FLOAT
 * @param result      or null; its lambda2 is that of the largest component
 */
MO_API mo_status mo_fiedler(const mo_in* offsets, const mo_in* neighbours, const mo_in* weights,
                            const mo_options* options, const mo_out* values, mo_result* result);

/**
 * Copies rows to their new places: row k of `to` becomes row new_to_old[k] - base of `from`.
 *
 * @param new_to_old  a bijection, n integers
 * @param base        0 or 1
 * @param from        n rows
 * @param to          n rows that do not overlap those of `from`
 * @param row_bytes   bytes of a row, >= 0
 */
MO_API mo_status mo_move(const mo_in* new_to_old, int32_t base, const void* from, void* to,
                         int64_t row_bytes);

/*
 * Layouts for graphics processors, where many threads work on cells at once. Order the mesh first: layouts
 * keep the order of cells and vertices.
 *
 * Cells are given as to `mo_order_mesh`; `vertex_count` is >= 0, and `options` may be null. Of the options,
 * `base`, `threads`, `progress` and `user` are used. Edges are cells with two vertices. Cell numbers,
 * vertex numbers and offsets start at the base; `local` and `corners` start at 0. The library owns the
 * structures and their arrays, which are valid until the call that destroys them. Do not write to them.
 */

/** Cells in patches of `size`, one patch for each block of threads. The block loads the patch's vertices into
 * shared memory, uses their local numbers, and adds its sums to global memory once for each vertex. */
typedef struct mo_patches {
  int64_t count;             /**< patches */
  int32_t size;              /**< cells of a patch; the last may have fewer */
  int32_t vertices_per_cell; /**< k */
  const int32_t* cells;      /**< old numbers of the cells; those of patch p begin at place p * size */
  const int64_t* offsets;    /**< count + 1: where the vertices of each patch begin */
  const int32_t* vertices;   /**< vertices of each patch, ascending */
  const uint16_t* local;     /**< corner a of cells[i] is vertex local[i * k + a] of its patch */
} mo_patches;

/**
 * Cuts cells into patches of `size` consecutive cells. Within a patch, neighbouring cells are spread over the
 * warps of 32 threads.
 *
 * @param cell_offsets   cells + 1, ascending, the first is `base`
 * @param cell_vertices  vertices of the cells, from `base` on
 * @param vtk_types      VTK's type of each cell; null: all cells have one dimension
 * @param vertex_count   n
 * @param size           cells of a patch, 2 ... 65535 / vertices of a cell; usual: 256
 * @param options        or null
 * @param made           written; null after a failure
 */
MO_API mo_status mo_patches_create(const mo_in* cell_offsets, const mo_in* cell_vertices,
                                   const mo_in* vtk_types, int64_t vertex_count, int32_t size,
                                   const mo_options* options, const mo_patches** made);

/** Destroys patches; does nothing for a null pointer. */
MO_API void mo_patches_destroy(const mo_patches* made);

/** The cells at each vertex, so that each vertex sums the contributions of its cells without atomics. */
typedef struct mo_gather_lists {
  const int64_t* offsets; /**< vertex_count + 1: where the entries of each vertex begin */
  const int32_t* cells;   /**< the cells of each vertex, ascending */
  const uint8_t* corners; /**< position of the vertex in each of these cells */
} mo_gather_lists;

/**
 * Makes the gather lists of cells with at most 256 vertices each.
 *
 * @param cell_offsets   cells + 1, ascending, the first is `base`
 * @param cell_vertices  vertices of the cells, from `base` on
 * @param vtk_types      VTK's type of each cell; null: all cells have one dimension
 * @param vertex_count   n
 * @param options        or null
 * @param made           written; null after a failure
 */
MO_API mo_status mo_gather_lists_create(const mo_in* cell_offsets, const mo_in* cell_vertices,
                                        const mo_in* vtk_types, int64_t vertex_count,
                                        const mo_options* options, const mo_gather_lists** made);

/** Destroys gather lists; does nothing for a null pointer. */
MO_API void mo_gather_lists_destroy(const mo_gather_lists* made);

/** Cells by colour: no two cells of a colour share a vertex. */
typedef struct mo_colours {
  int64_t count;         /**< colours */
  const int32_t* starts; /**< count + 1: where the cells of each colour begin */
  const int32_t* cells;  /**< all cells, colour after colour, in their old order within a colour */
} mo_colours;

/**
 * Colours cells.
 *
 * @param cell_offsets   cells + 1, ascending, the first is `base`
 * @param cell_vertices  vertices of the cells, from `base` on
 * @param vtk_types      VTK's type of each cell; null: all cells have one dimension
 * @param vertex_count   n
 * @param options        or null
 * @param made           written; null after a failure
 */
MO_API mo_status mo_colours_create(const mo_in* cell_offsets, const mo_in* cell_vertices,
                                   const mo_in* vtk_types, int64_t vertex_count, const mo_options* options,
                                   const mo_colours** made);

/** Destroys colours; does nothing for a null pointer. */
MO_API void mo_colours_destroy(const mo_colours* made);

/**
 * Sorts the vertices of each cell as far as the cell's orientation allows. All cells must be linear triangles
 * or tetrahedra.
 *
 * @param cell_offsets   cells + 1, ascending, the first is `base`
 * @param cell_vertices  vertices of the cells, from `base` on
 * @param vtk_types      VTK's type of each cell
 * @param vertex_count   n
 * @param options        or null
 * @param sorted         integers, as many as `cell_vertices`
 */
MO_API mo_status mo_sort_corners(const mo_in* cell_offsets, const mo_in* cell_vertices,
                                 const mo_in* vtk_types, int64_t vertex_count, const mo_options* options,
                                 const mo_out* sorted);

/** Cost of a kernel on a graphics processor. Set `struct_size` to sizeof(mo_gpu_counts) before the call. */
typedef struct mo_gpu_counts {
  size_t struct_size;
  int64_t requests; /**< additions, or loads and stores; one request serves the 32 threads of a warp */
  int64_t sectors;  /**< 32-byte sectors that requests touch; counted t times if t threads add to one value */
  /** What `sectors` would be if the values that each warp touches at once were all different and side by side
   * and, for "patches", no vertex were in two patches. */
  int64_t floor;
  int64_t dram_bytes; /**< bytes that the last cache reads from memory */
  int64_t dram_floor; /**< what `dram_bytes` would be if each number were read once */
} mo_gpu_counts;

/**
 * Counts what adding to the vertices of cells costs on a graphics processor. Of two orders of the same cells,
 * the one with fewer sectors is faster there.
 *
 * @param cell_offsets   cells + 1, ascending, the first is `base`
 * @param cell_vertices  vertices of the cells, from `base` on
 * @param vtk_types      VTK's type of each cell; null: all cells have one dimension
 * @param vertex_count   n
 * @param layout         "packed": three values of a vertex side by side; "apart": in three arrays; "padded":
 *                       four values of a vertex side by side, added at once; "patches": as "packed", in
 *                       patches of 256 cells; "gathered": two passes by gather lists
 * @param cache_bytes    size of the last cache; 0: 50 MiB
 * @param options        or null
 * @param counts         written
 */
MO_API mo_status mo_gpu_cost(const mo_in* cell_offsets, const mo_in* cell_vertices, const mo_in* vtk_types,
                             int64_t vertex_count, const char* layout, int64_t cache_bytes,
                             const mo_options* options, mo_gpu_counts* counts);

/**
 * Counts what the product of a sparse matrix with a vector costs on a graphics processor. The matrix has an
 * entry for each neighbour, and a diagonal.
 *
 * @param offsets      n + 1, ascending, the first is the base
 * @param neighbours   (offsets[n] - base) vertex numbers, from the base on; a symmetric pattern
 * @param lanes        threads per row: 1, 2, 4, 8, 16 or 32
 * @param cache_bytes  size of the last cache; 0: 50 MiB
 * @param options      or null
 * @param counts       written
 */
MO_API mo_status mo_gpu_product_cost(const mo_in* offsets, const mo_in* neighbours, int32_t lanes,
                                     int64_t cache_bytes, const mo_options* options, mo_gpu_counts* counts);

/** Returns the number of vertex methods, including registered ones. Never fails. */
MO_API int32_t mo_method_count(void);

/** Returns the name of vertex method k, 0 <= k < mo_method_count(); null for other k. Valid for the life of
 * the process. */
MO_API const char* mo_method_name(int32_t k);

/**
 * A vertex method that a user defines.
 *
 * @param user        the `user` of `mo_register`
 * @param n           number of vertices
 * @param offsets     n + 1, from 0
 * @param neighbours  ascending in each row, no loops, no repeats, symmetric
 * @param xyz         3 n coordinates, or null
 * @param new_to_old  n numbers, written by the method: a bijection of 0 ... n-1
 * @return 0 for success; after any other number, the call that requested the order fails with MO_INTERNAL
 */
typedef int32_t (*mo_method)(void* user, int64_t n, const int64_t* offsets, const int32_t* neighbours,
                             const double* xyz, int32_t* new_to_old);

/** Type of the function that meshorder passes to a plug-in; it has the parameters of `mo_register`. */
typedef mo_status (*mo_register_fn)(const char* name, const char* description, int32_t needs_points,
                                    mo_method method, void* user);

/**
 * Adds a vertex method for the rest of the process.
 *
 * @param name          lower case letters, digits, '-' and '_'; not taken yet; copied
 * @param description   one line; copied
 * @param needs_points  non-zero: a call without coordinates is refused
 * @param method        may be called by several threads at once
 * @param user          passed to `method`
 */
MO_API mo_status mo_register(const char* name, const char* description, int32_t needs_points,
                             mo_method method, void* user);

/**
 * The function that a plug-in defines. It registers its methods by `add` and returns MO_OK, or the status
 * that `add` returned. `meshorder --plugin FILE` and `load_methods` of the C++ interface call it.
 */
MO_EXPORT mo_status meshorder_plugin_v1(mo_register_fn add);

#ifdef __cplusplus
}
#endif

#endif /* MESHORDER_H */
