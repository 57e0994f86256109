/* Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT */
/* A caller in C99: orders, Fiedler vectors, methods of its own, and the statuses of mistakes. */
#include <math.h>
#include <meshorder.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

static int failures = 0;

static void check(int holds, const char* what, int line) {
  if (holds) return;
  printf("line %d: not true: %s (last error: \"%s\")\n", line, what, mo_last_error());
  ++failures;
}
#define CHECK(condition) check((condition), #condition, __LINE__)

#define COUNT(array) ((int64_t)(sizeof(array) / sizeof((array)[0])))

/* The path 0 - 3 - 1 - 4 - 2. */
enum { N = 5 };
static const int32_t offsets32[N + 1] = {0, 1, 3, 4, 6, 8};
static const int32_t neighbours32[8] = {3, 3, 4, 4, 0, 1, 1, 2};

static mo_in in32(const int32_t* data, int64_t size) {
  mo_in array;
  array.data = data;
  array.size = size;
  array.type = MO_INT32;
  return array;
}

static mo_out out32(int32_t* data, int64_t size) {
  mo_out array;
  array.data = data;
  array.size = size;
  array.type = MO_INT32;
  return array;
}

static mo_options options_of(const char* method) {
  mo_options options;
  mo_options_init(&options, sizeof options);
  options.method = method;
  return options;
}

static mo_status order_path(const mo_options* options, int32_t* new_to_old, mo_result* result) {
  const mo_in offsets = in32(offsets32, N + 1);
  const mo_in neighbours = in32(neighbours32, 8);
  const mo_out order = out32(new_to_old, N);
  return mo_order_graph(&offsets, &neighbours, NULL, NULL, 0, options, &order, NULL, result);
}

/* Both maps are bijections, each the inverse of the other, and neighbours of the path are next to each other.
 */
static void check_path_order(const int64_t* new_to_old, const int64_t* old_to_new) {
  int64_t k;
  int row;
  for (k = 0; k < N; ++k) {
    CHECK(new_to_old[k] >= 0 && new_to_old[k] < N);
    CHECK(old_to_new[k] >= 0 && old_to_new[k] < N);
    if (new_to_old[k] < 0 || new_to_old[k] >= N) return;
    CHECK(old_to_new[new_to_old[k]] == k);
  }
  for (row = 0; row < N; ++row) {
    int32_t entry;
    for (entry = offsets32[row]; entry < offsets32[row + 1]; ++entry) {
      const int64_t step = old_to_new[row] - old_to_new[neighbours32[entry]];
      CHECK(step == 1 || step == -1);
    }
  }
}

static void test_order_of_any_integers(void) {
  int64_t first_new_to_old[N];
  int32_t base;
  for (base = 0; base <= 1; ++base) {
    int32_t narrow_offsets[N + 1];
    int32_t narrow_neighbours[8];
    int32_t narrow_new_to_old[N];
    int32_t narrow_old_to_new[N];
    int64_t wide_offsets[N + 1];
    int64_t wide_neighbours[8];
    int64_t new_to_old[N];
    uint64_t old_to_new[N];
    int64_t from_zero[N];
    int64_t inverse_from_zero[N];
    mo_options options = options_of("rcm");
    mo_result result;
    int k;
    options.base = base;
    for (k = 0; k <= N; ++k) narrow_offsets[k] = offsets32[k] + base;
    for (k = 0; k < 8; ++k) narrow_neighbours[k] = neighbours32[k] + base;
    for (k = 0; k <= N; ++k) wide_offsets[k] = narrow_offsets[k];
    for (k = 0; k < 8; ++k) wide_neighbours[k] = narrow_neighbours[k];

    {
      const mo_in offsets = in32(narrow_offsets, N + 1);
      const mo_in neighbours = in32(narrow_neighbours, 8);
      const mo_out order = out32(narrow_new_to_old, N);
      const mo_out inverse = out32(narrow_old_to_new, N);
      result.struct_size = sizeof result;
      CHECK(mo_order_graph(&offsets, &neighbours, NULL, NULL, 0, &options, &order, &inverse, &result) ==
            MO_OK);
      CHECK(result.complete == 1);
      CHECK(result.components == 0);
      CHECK(result.seconds >= 0);
      CHECK(strcmp(result.method, "rcm") == 0);
    }
    {
      const mo_in offsets = {wide_offsets, N + 1, MO_INT64};
      const mo_in neighbours = {wide_neighbours, 8, MO_INT64};
      mo_out order;
      mo_out inverse;
      order.data = new_to_old;
      order.size = N;
      order.type = MO_INT64;
      inverse.data = old_to_new;
      inverse.size = N;
      inverse.type = MO_UINT64;
      CHECK(mo_order_graph(&offsets, &neighbours, NULL, NULL, 0, &options, &order, &inverse, NULL) == MO_OK);
    }
    for (k = 0; k < N; ++k) {
      CHECK(narrow_new_to_old[k] == new_to_old[k]);
      CHECK(narrow_old_to_new[k] == (int64_t)old_to_new[k]);
      from_zero[k] = new_to_old[k] - base;
      inverse_from_zero[k] = (int64_t)old_to_new[k] - base;
      if (base == 0) first_new_to_old[k] = from_zero[k];
      CHECK(from_zero[k] == first_new_to_old[k]);
    }
    check_path_order(from_zero, inverse_from_zero);
  }
}

static void test_defaults(void) {
  int32_t new_to_old[N];
  mo_options options;
  CHECK(order_path(NULL, new_to_old, NULL) == MO_OK);
  mo_options_init(&options, sizeof options);
  CHECK(options.struct_size == sizeof options);
  CHECK(options.tolerance > 0.09 && options.tolerance < 0.11);
  CHECK(options.max_iterations == 500);
  CHECK(options.time_limit > 1e300);
  CHECK(options.method == NULL && options.progress == NULL && options.start.data == NULL);
  mo_options_init(NULL, sizeof options);
}

/* Two triangles of a square, and mo_move by the order of its vertices. */
static void test_mesh(void) {
  static const int32_t cell_offsets[3] = {1, 4, 7};
  static const int32_t cell_vertices[6] = {1, 2, 3, 2, 4, 3};
  static const int32_t types[2] = {5, 5};
  static const uint8_t bytes[2] = {5, 5};
  static const double xy[8] = {0, 0, 1, 0, 0, 1, 1, 1};
  const mo_in offsets = in32(cell_offsets, COUNT(cell_offsets));
  const mo_in vertices = in32(cell_vertices, COUNT(cell_vertices));
  mo_in vtk_types = in32(types, COUNT(types));
  const mo_in points = {xy, 8, MO_DOUBLE};
  int32_t vertex_new_to_old[4];
  int32_t cell_new_to_old[2];
  int32_t cell_old_to_new[2];
  double moved[8];
  const mo_out vertex_order = out32(vertex_new_to_old, 4);
  const mo_out cell_order = out32(cell_new_to_old, 2);
  const mo_out cell_inverse = out32(cell_old_to_new, 2);
  const mo_in map = in32(vertex_new_to_old, 4);
  mo_options options = options_of("hilbert");
  mo_result vertex_result;
  mo_result cell_result;
  int k;
  options.base = 1;
  options.element_method = "lexmax";
  vertex_result.struct_size = sizeof vertex_result;
  cell_result.struct_size = sizeof cell_result;
  CHECK(mo_order_mesh(&offsets, &vertices, &vtk_types, 0, &points, 2, &options, &vertex_order, NULL,
                      &cell_order, &cell_inverse, &vertex_result, &cell_result) == MO_OK);
  CHECK(strcmp(vertex_result.method, "hilbert") == 0);
  CHECK(strcmp(cell_result.method, "lexmax") == 0);
  CHECK(cell_new_to_old[0] + cell_new_to_old[1] == 3);
  CHECK(cell_old_to_new[cell_new_to_old[0] - 1] == 1);

  vtk_types.data = bytes;
  vtk_types.type = MO_UINT8;
  CHECK(mo_order_mesh(&offsets, &vertices, &vtk_types, 0, &points, 2, &options, NULL, NULL, NULL,
                      &cell_inverse, NULL, NULL) == MO_OK);
  CHECK(cell_old_to_new[cell_new_to_old[0] - 1] == 1);
  CHECK(mo_order_mesh(&offsets, &vtk_types, NULL, 0, &points, 2, &options, NULL, NULL, NULL, &cell_inverse,
                      NULL, NULL) == MO_INVALID_ARGUMENT);
  CHECK(strstr(mo_last_error(), "cell_vertices: the type is 6") != NULL);

  CHECK(mo_move(&map, 1, xy, moved, (int64_t)(2 * sizeof(double))) == MO_OK);
  for (k = 0; k < 4; ++k) {
    const int old = vertex_new_to_old[k] - 1;
    CHECK(memcmp(moved + 2 * k, xy + 2 * old, 2 * sizeof(double)) == 0);
  }
  CHECK(mo_move(&map, 2, xy, moved, 16) == MO_INVALID_ARGUMENT);
  CHECK(mo_move(&map, 1, xy, moved, -1) == MO_INVALID_ARGUMENT);
  CHECK(mo_move(&map, 1, xy, NULL, 16) == MO_INVALID_ARGUMENT);
  CHECK(mo_move(NULL, 1, xy, moved, 16) == MO_INVALID_ARGUMENT);
  vertex_new_to_old[0] = vertex_new_to_old[1];
  CHECK(mo_move(&map, 1, xy, moved, 16) == MO_INVALID_ARGUMENT);
  CHECK(mo_order_mesh(&offsets, &vertices, &vtk_types, -1, &points, 2, &options, &vertex_order, NULL, NULL,
                      NULL, NULL, NULL) == MO_INVALID_ARGUMENT);
  CHECK(mo_order_mesh(&offsets, &vertices, &vtk_types, 0, &points, 4, &options, &vertex_order, NULL, NULL,
                      NULL, NULL, NULL) == MO_INVALID_ARGUMENT);
}

/* A path of edges, from vertex 0 to 1, from 1 to 2 and so on, with scrambled vertices and edges. */
static void test_maps_of_a_mesh(void) {
  enum { CELLS = 7, VERTICES = CELLS + 1 };
  static const int32_t name_of_vertex[VERTICES] = {4, 0, 7, 2, 5, 1, 3, 6};
  static const int32_t name_of_cell[CELLS] = {3, 5, 0, 6, 1, 4, 2};
  int32_t cell_offsets[CELLS + 1] = {0};
  int32_t cell_vertices[2 * CELLS] = {0};
  int32_t vertices[2][VERTICES] = {{0}}; /* new to old, old to new */
  int32_t cells[2][CELLS] = {{0}};
  const mo_in offsets = in32(cell_offsets, CELLS + 1);
  const mo_in ends = in32(cell_vertices, 2 * CELLS);
  const mo_out vertex_order = out32(vertices[0], VERTICES);
  const mo_out vertex_inverse = out32(vertices[1], VERTICES);
  const mo_out cell_order = out32(cells[0], CELLS);
  const mo_out cell_inverse = out32(cells[1], CELLS);
  mo_options options = options_of("rcm");
  int k;
  for (k = 0; k <= CELLS; ++k) cell_offsets[k] = 2 * k;
  for (k = 0; k < 2 * CELLS; ++k)
    cell_vertices[2 * name_of_cell[k / 2] + k % 2] = name_of_vertex[k / 2 + k % 2];
  options.element_method = "lexmax";
  CHECK(mo_order_mesh(&offsets, &ends, NULL, VERTICES, NULL, 0, &options, &vertex_order, &vertex_inverse,
                      &cell_order, &cell_inverse, NULL, NULL) == MO_OK);
  for (k = 0; k < VERTICES; ++k) CHECK(vertices[1][vertices[0][k]] == k);
  /* the vertices follow each other along the path, and so do the edges */
  for (k = 0; k < CELLS; ++k) {
    const int32_t* const edge = cell_vertices + 2 * cells[0][k];
    const int32_t a = vertices[1][edge[0]];
    const int32_t b = vertices[1][edge[1]];
    CHECK((a == k && b == k + 1) || (a == k + 1 && b == k));
    CHECK(cells[1][cells[0][k]] == k);
  }
}

/* A path 1 - 2 - 3 - 4 whose vertices are taken in the order 2, 4, 1, 3. */
static void test_edges(void) {
  static const int64_t pairs[6] = {1, 2, 3, 2, 3, 4};
  static const int32_t order[4] = {2, 4, 1, 3};
  const mo_in ends = {pairs, COUNT(pairs), MO_INT64};
  const mo_in odd = {pairs, 5, MO_INT64};
  const mo_in outside = {pairs, COUNT(pairs), MO_INT64};
  const mo_in vertices = in32(order, COUNT(order));
  int32_t new_to_old[3];
  const mo_out edges = out32(new_to_old, 3);
  CHECK(mo_order_edges(&ends, &vertices, 1, &edges) == MO_OK);
  /* the larger and the smaller place of the ends: (2, 0), (3, 0), (3, 1) */
  CHECK(new_to_old[0] == 1 && new_to_old[1] == 2 && new_to_old[2] == 3);
  CHECK(mo_order_edges(&odd, &vertices, 1, &edges) == MO_INVALID_ARGUMENT);
  CHECK(mo_order_edges(&outside, &vertices, 0, &edges) == MO_INVALID_ARGUMENT);
  CHECK(mo_order_edges(&ends, NULL, 1, &edges) == MO_INVALID_ARGUMENT);
}

/* A path of six vertices, 0 - 2 - 4 - 1 - 3 - 5, numbered from 1; then the third one along it is removed and
 * a new one is added at the end. */
static void test_reorderer(void) {
  static const int32_t path_offsets[] = {1, 2, 4, 6, 8, 10, 11};
  static const int32_t path_neighbours[] = {3, 4, 5, 1, 5, 2, 6, 2, 3, 4};
  const mo_in offsets = in32(path_offsets, COUNT(path_offsets));
  const mo_in neighbours = in32(path_neighbours, COUNT(path_neighbours));
  static const int32_t all_new[] = {0, 0, 0, 0, 0, 0};
  static const int32_t twice[] = {1, 1, 3, 4, 5, 6};
  const mo_in previous = in32(all_new, COUNT(all_new));
  const mo_in faulty = in32(twice, COUNT(twice));
  mo_options options = options_of("rcm");
  mo_reorderer* reorderer = NULL;
  int32_t new_to_old[6];
  int32_t repair = -1;
  int v;
  const mo_out places = out32(new_to_old, 6);
  options.base = 1;
  CHECK(mo_reorderer_create(&options, 0.02, INFINITY, &reorderer) == MO_OK);
  CHECK(mo_reorderer_update(reorderer, &offsets, &neighbours, NULL, 0, &previous, &places, NULL, &repair) ==
        MO_OK);
  CHECK(repair == MO_REPAIR_FRESH);
  for (v = 0; v < 6; ++v) {
    static const int32_t along[] = {1, 3, 5, 2, 4, 6};
    CHECK(new_to_old[v] == along[v] || new_to_old[v] == along[5 - v]);
  }
  CHECK(mo_reorderer_update(reorderer, &offsets, &neighbours, NULL, 0, &faulty, NULL, NULL, NULL) ==
        MO_INVALID_ARGUMENT);
  CHECK(strstr(mo_last_error(), "entries 0 and 1 are both 0") != NULL);
  CHECK(mo_reorderer_observe(reorderer, 0.5) == MO_OK);
  CHECK(mo_reorderer_observe(reorderer, -1) == MO_INVALID_ARGUMENT);
  mo_reorderer_destroy(reorderer);
  mo_reorderer_destroy(NULL);
  CHECK(mo_reorderer_create(&options, -1, INFINITY, &reorderer) == MO_INVALID_ARGUMENT);
  CHECK(reorderer == NULL);
  CHECK(mo_reorderer_create(&options, 0.02, INFINITY, NULL) == MO_INVALID_ARGUMENT);
  CHECK(mo_reorderer_update(NULL, &offsets, &neighbours, NULL, 0, NULL, NULL, NULL, NULL) ==
        MO_INVALID_ARGUMENT);
}

/* A misaligned address. */
static void test_alignment(void) {
  static int32_t room[9];
  const mo_in offsets = {(const char*)room + 1, 3, MO_INT32};
  const mo_in none = {NULL, 0, MO_INT32};
  CHECK(mo_order_graph(&offsets, &none, NULL, NULL, 0, NULL, NULL, NULL, NULL) == MO_INVALID_ARGUMENT);
  CHECK(strstr(mo_last_error(), "offsets: the address is not a multiple of 4") != NULL);
}

static void test_fiedler(void) {
  enum { LENGTH = 10 };
  const double lambda2 = 0.0978869674096928558; /* 2 - 2 cos(pi / 10) */
  int32_t path_offsets[LENGTH + 1] = {0};
  int32_t path_neighbours[2 * LENGTH - 2] = {0};
  double values[LENGTH] = {0};
  float narrow[LENGTH] = {0};
  mo_in offsets = in32(path_offsets, LENGTH + 1);
  mo_in neighbours = in32(path_neighbours, 2 * LENGTH - 2);
  mo_out output;
  mo_options options = options_of(NULL);
  mo_result result;
  double sum = 0;
  double squares = 0;
  int32_t entries = 0;
  int v;
  for (v = 0; v < LENGTH; ++v) {
    path_offsets[v] = entries;
    if (v > 0) path_neighbours[entries++] = v - 1;
    if (v + 1 < LENGTH) path_neighbours[entries++] = v + 1;
  }
  path_offsets[LENGTH] = entries;
  options.tolerance = 1e-8;
  result.struct_size = sizeof result;
  output.data = values;
  output.size = LENGTH;
  output.type = MO_DOUBLE;
  CHECK(mo_fiedler(&offsets, &neighbours, NULL, &options, &output, &result) == MO_OK);
  CHECK(result.components == 1);
  CHECK(result.complete == 1);
  CHECK(result.lambda2 > lambda2 - 1e-8 && result.lambda2 < lambda2 + 1e-8);
  for (v = 0; v < LENGTH; ++v) {
    sum += values[v];
    squares += values[v] * values[v];
    CHECK(v == 0 || (values[v] > values[v - 1]) == (values[1] > values[0]));
  }
  CHECK(sum > -1e-8 && sum < 1e-8);
  CHECK(squares > 1 - 1e-8 && squares < 1 + 1e-8);

  output.data = narrow;
  output.type = MO_FLOAT;
  CHECK(mo_fiedler(&offsets, &neighbours, NULL, &options, &output, NULL) == MO_OK);
  for (v = 0; v < LENGTH; ++v) CHECK(narrow[v] == (float)values[v]);
  output.type = MO_INT32;
  CHECK(mo_fiedler(&offsets, &neighbours, NULL, &options, &output, NULL) == MO_INVALID_ARGUMENT);
  options.tolerance = 0;
  output.type = MO_FLOAT;
  CHECK(mo_fiedler(&offsets, &neighbours, NULL, &options, &output, NULL) == MO_INVALID_ARGUMENT);
}

/* Cycles of six vertices whose edges are strong but for two opposite ones: each half stays together. */
static void test_weights(void) {
  static const int32_t cycle_offsets[7] = {0, 2, 4, 6, 8, 10, 12};
  static const int32_t cycle_neighbours[12] = {5, 1, 0, 2, 1, 3, 2, 4, 3, 5, 4, 0};
  const mo_in offsets = in32(cycle_offsets, 7);
  const mo_in neighbours = in32(cycle_neighbours, 12);
  mo_options options = options_of("fiedler");
  int first;
  options.tolerance = 1e-6;
  for (first = 0; first < 3; ++first) {
    double strengths[12];
    float narrow[12];
    int32_t old_to_new[6];
    const mo_in weights = {strengths, 12, MO_DOUBLE};
    const mo_in narrow_weights = {narrow, 12, MO_FLOAT};
    const mo_out order = out32(old_to_new, 6);
    mo_result result;
    int v;
    for (v = 0; v < 6; ++v) { /* the edges to the vertex before and to the vertex after */
      strengths[2 * v] = (v + 5) % 3 == first ? 1 : 100;
      strengths[2 * v + 1] = v % 3 == first ? 1 : 100;
    }
    for (v = 0; v < 12; ++v) narrow[v] = (float)strengths[v];
    result.struct_size = sizeof result;
    CHECK(mo_order_graph(&offsets, &neighbours, first == 0 ? &weights : &narrow_weights, NULL, 0, &options,
                         NULL, &order, &result) == MO_OK);
    for (v = 1; v < 6; ++v) {
      const int is_cut = (v - 1) % 3 == first; /* between v - 1 and v */
      CHECK(is_cut == ((old_to_new[v - 1] < 3) != (old_to_new[v] < 3)));
    }
    CHECK(result.lambda2 > 1.2);
    CHECK(mo_fiedler(&offsets, &neighbours, &weights, &options, NULL, &result) == MO_OK);
    CHECK(result.lambda2 > 1.2);
    CHECK(mo_fiedler(&offsets, &neighbours, NULL, &options, NULL, &result) == MO_OK);
    CHECK(result.lambda2 < 1.2); /* 1 */
  }
}

/* A triangle and a path of four vertices. */
static void test_largest_component(void) {
  const double lambda2 = 0.585786437626904951; /* of the path: 2 - 2 cos(pi / 4) */
  static const int32_t two_offsets[8] = {0, 2, 4, 6, 7, 9, 11, 12};
  static const int32_t two_neighbours[12] = {1, 2, 0, 2, 0, 1, 4, 3, 5, 4, 6, 5};
  const mo_in offsets = in32(two_offsets, 8);
  const mo_in neighbours = in32(two_neighbours, 12);
  mo_options options = options_of("fiedler");
  mo_result results[2];
  int k;
  options.tolerance = 1e-8;
  for (k = 0; k < 2; ++k) results[k].struct_size = sizeof results[k];
  CHECK(mo_fiedler(&offsets, &neighbours, NULL, &options, NULL, &results[0]) == MO_OK);
  CHECK(mo_order_graph(&offsets, &neighbours, NULL, NULL, 0, &options, NULL, NULL, &results[1]) == MO_OK);
  for (k = 0; k < 2; ++k) {
    CHECK(results[k].components == 2);
    CHECK(results[k].lambda2 > lambda2 - 1e-6 && results[k].lambda2 < lambda2 + 1e-6);
  }
}

/* Numbers that are as large as their count. */
static void test_numbers_beyond(void) {
  int32_t neighbours[8] = {0};
  static const int32_t cell_offsets[2] = {0, 3};
  const mo_in offsets = in32(offsets32, N + 1);
  const mo_in beyond = in32(neighbours, 8);
  const mo_in cells = in32(cell_offsets, 2);
  const mo_in corners = in32(neighbours, 3);
  int32_t numbers[N];
  const mo_out order = out32(numbers, N);
  mo_options options = options_of("rcm");
  memcpy(neighbours, neighbours32, sizeof neighbours);
  neighbours[2] = N;
  CHECK(mo_order_graph(&offsets, &beyond, NULL, NULL, 0, &options, &order, NULL, NULL) ==
        MO_INVALID_ARGUMENT);
  CHECK(strstr(mo_last_error(), "neighbour 1 of row 1 is 5, outside 0 … 4") != NULL);
  CHECK(mo_order_mesh(&cells, &corners, NULL, N, NULL, 0, &options, &order, NULL, NULL, NULL, NULL, NULL) ==
        MO_INVALID_ARGUMENT);
  neighbours[2] = 1;
  CHECK(mo_order_mesh(&cells, &corners, NULL, N, NULL, 0, &options, &order, NULL, NULL, NULL, NULL, NULL) ==
        MO_OK);
}

/* Messages name the argument that is wrong, and a call that returns nothing is refused. */
static void test_messages(void) {
  static const int32_t cell_offsets[2] = {0, 3};
  static const int32_t triangle[3] = {0, 1, 2};
  const double xy[8] = {0};
  const mo_in offsets = in32(offsets32, N + 1);
  const mo_in neighbours = in32(neighbours32, 8);
  const mo_in cells = in32(cell_offsets, 2);
  const mo_in vertices = in32(triangle, 3);
  const mo_in one_edge = in32(triangle, 2);
  const mo_in four_points = {xy, 8, MO_DOUBLE};
  int32_t numbers[N];
  const mo_out order = out32(numbers, 4);
  mo_options options = options_of("rcm");
  mo_result result;
  mo_reorderer* reorderer = NULL;
  int v;
  CHECK(mo_order_graph(&offsets, &neighbours, NULL, &four_points, 2, NULL, &order, NULL, NULL) ==
        MO_INVALID_ARGUMENT);
  CHECK(strcmp(mo_last_error(), "points: there are 4, but the offsets are those of 5 vertices") == 0);
  CHECK(mo_reorderer_create(&options, 0.02, INFINITY, &reorderer) == MO_OK);
  CHECK(mo_reorderer_update(reorderer, &offsets, &neighbours, &four_points, 2, NULL, &order, NULL, NULL) ==
        MO_INVALID_ARGUMENT);
  CHECK(strncmp(mo_last_error(), "points: there are 4", 19) == 0);
  mo_reorderer_destroy(reorderer);
  CHECK(mo_order_mesh(&cells, &vertices, NULL, 3, &four_points, 2, NULL, &order, NULL, NULL, NULL, NULL,
                      NULL) == MO_INVALID_ARGUMENT);
  CHECK(strcmp(mo_last_error(), "points: there are 4, but vertex_count is 3") == 0);

  CHECK(mo_order_mesh(&cells, &vertices, NULL, 3, NULL, 0, NULL, NULL, NULL, NULL, NULL, NULL, NULL) ==
        MO_INVALID_ARGUMENT);
  CHECK(strstr(mo_last_error(), "all outputs are null") != NULL);
  CHECK(mo_order_graph(&offsets, &neighbours, NULL, NULL, 0, NULL, NULL, NULL, NULL) == MO_INVALID_ARGUMENT);
  CHECK(strstr(mo_last_error(), "all outputs are null") != NULL);
  result.struct_size = sizeof result;
  CHECK(mo_order_mesh(&cells, &vertices, NULL, 3, NULL, 0, NULL, NULL, NULL, NULL, NULL, NULL, &result) ==
        MO_OK);
  CHECK(mo_order_edges(&one_edge, &vertices, 0, NULL) == MO_INVALID_ARGUMENT);
  CHECK(strcmp(mo_last_error(), "new_to_old: the output is null") == 0);

  for (v = 0; v < N; ++v) numbers[v] = v;
  {
    const mo_in map = in32(numbers, 3);
    int32_t rows[4] = {0};
    CHECK(mo_move(&map, 0, rows, rows + 1, 4) == MO_INVALID_ARGUMENT);
    CHECK(strcmp(mo_last_error(), "to: the rows overlap those of from; give another array") == 0);
    CHECK(mo_move(&map, 0, rows, rows, 0) == MO_OK);
  }
}

static void test_mistakes(void) {
  static const int32_t lonely[8] = {3, 3, 4, 4, 1, 1, 1, 2}; /* row 3 lacks its neighbour 0 */
  int32_t new_to_old[N];
  mo_in offsets = in32(offsets32, N + 1);
  mo_in neighbours = in32(neighbours32, 8);
  const mo_in asymmetric = in32(lonely, 8);
  mo_out order = out32(new_to_old, N);
  mo_options options = options_of("rcm");
  mo_result result;

  CHECK(mo_order_graph(&offsets, &asymmetric, NULL, NULL, 0, &options, &order, NULL, NULL) ==
        MO_INVALID_ARGUMENT);
  CHECK(strlen(mo_last_error()) > 0);
  options.symmetrize = 1;
  CHECK(mo_order_graph(&offsets, &asymmetric, NULL, NULL, 0, &options, &order, NULL, NULL) == MO_OK);
  options = options_of("rcm");

  CHECK(mo_order_graph(NULL, &neighbours, NULL, NULL, 0, &options, &order, NULL, NULL) ==
        MO_INVALID_ARGUMENT);
  CHECK(mo_order_graph(&offsets, NULL, NULL, NULL, 0, &options, &order, NULL, NULL) == MO_INVALID_ARGUMENT);
  neighbours.data = NULL;
  CHECK(mo_order_graph(&offsets, &neighbours, NULL, NULL, 0, &options, &order, NULL, NULL) ==
        MO_INVALID_ARGUMENT);
  neighbours = in32(neighbours32, -8);
  CHECK(mo_order_graph(&offsets, &neighbours, NULL, NULL, 0, &options, &order, NULL, NULL) ==
        MO_INVALID_ARGUMENT);
  neighbours = in32(neighbours32, 8);
  neighbours.type = MO_DOUBLE;
  CHECK(mo_order_graph(&offsets, &neighbours, NULL, NULL, 0, &options, &order, NULL, NULL) ==
        MO_INVALID_ARGUMENT);
  neighbours.type = MO_INT32;
  order.data = NULL;
  CHECK(mo_order_graph(&offsets, &neighbours, NULL, NULL, 0, &options, &order, NULL, NULL) ==
        MO_INVALID_ARGUMENT);
  order = out32(new_to_old, N - 1);
  CHECK(mo_order_graph(&offsets, &neighbours, NULL, NULL, 0, &options, &order, NULL, NULL) ==
        MO_INVALID_ARGUMENT);
  order = out32(new_to_old, N);
  order.type = MO_DOUBLE;
  CHECK(mo_order_graph(&offsets, &neighbours, NULL, NULL, 0, &options, &order, NULL, NULL) ==
        MO_INVALID_ARGUMENT);

  options.method = "no-such-method";
  CHECK(order_path(&options, new_to_old, NULL) == MO_INVALID_ARGUMENT);
  CHECK(strstr(mo_last_error(), "no-such-method") != NULL);
  options.method = "hilbert"; /* needs points */
  CHECK(order_path(&options, new_to_old, NULL) == MO_INVALID_ARGUMENT);
  options = options_of("rcm");
  options.base = 2;
  CHECK(order_path(&options, new_to_old, NULL) == MO_INVALID_ARGUMENT);
  options = options_of("rcm");
  options.check = 3;
  CHECK(order_path(&options, new_to_old, NULL) == MO_INVALID_ARGUMENT);
  options = options_of("rcm");
  options.threads = -1;
  CHECK(order_path(&options, new_to_old, NULL) == MO_INVALID_ARGUMENT);
  options = options_of("auto");
  options.workload = "no-such-workload";
  CHECK(order_path(&options, new_to_old, NULL) == MO_INVALID_ARGUMENT);

  options = options_of("rcm");
  result.struct_size = 0;
  CHECK(order_path(&options, new_to_old, &result) == MO_INVALID_ARGUMENT);
  options.struct_size = 0;
  CHECK(order_path(&options, new_to_old, NULL) == MO_INVALID_ARGUMENT);
  options.struct_size = (size_t)-1;
  CHECK(order_path(&options, new_to_old, NULL) == MO_INVALID_ARGUMENT);
}

/* Fields beyond struct_size are neither read nor written. */
static void test_smaller_structures(void) {
  int32_t new_to_old[N];
  mo_options options = options_of("rcm");
  mo_result result;
  options.cell_groups.size = -1;
  CHECK(order_path(&options, new_to_old, NULL) == MO_INVALID_ARGUMENT);
  options.struct_size = offsetof(mo_options, cell_groups);
  CHECK(order_path(&options, new_to_old, NULL) == MO_OK);

  memset(&result, 'x', sizeof result);
  result.struct_size = offsetof(mo_result, method);
  CHECK(order_path(&options, new_to_old, &result) == MO_OK);
  CHECK(result.complete == 1);
  CHECK(result.method[0] == 'x' && result.method[31] == 'x');

  memset(&options, 'x', sizeof options);
  mo_options_init(&options, offsetof(mo_options, cell_groups));
  CHECK(options.struct_size == offsetof(mo_options, cell_groups));
  CHECK(options.max_iterations == 500);
  CHECK(*(const char*)&options.cell_groups == 'x');
}

static int32_t reversed(void* user, int64_t n, const int64_t* offsets, const int32_t* neighbours,
                        const double* xyz, int32_t* new_to_old) {
  int64_t k;
  (void)neighbours;
  if (offsets[0] != 0 || xyz != NULL) return 1;
  for (k = 0; k < n; ++k) new_to_old[k] = (int32_t)(n - 1 - k);
  ++*(int*)user;
  return 0;
}

static int32_t failing(void* user, int64_t n, const int64_t* offsets, const int32_t* neighbours,
                       const double* xyz, int32_t* new_to_old) {
  (void)user, (void)n, (void)offsets, (void)neighbours, (void)xyz, (void)new_to_old;
  return 42;
}

static int32_t constant(void* user, int64_t n, const int64_t* offsets, const int32_t* neighbours,
                        const double* xyz, int32_t* new_to_old) {
  int64_t k;
  (void)user, (void)offsets, (void)neighbours, (void)xyz;
  for (k = 0; k < n; ++k) new_to_old[k] = 0;
  return 0;
}

static void test_own_methods(void) {
  static int calls = 0;
  const int32_t before = mo_method_count();
  int32_t new_to_old[N];
  mo_options options = options_of("reversed");
  mo_result result;
  int k;
  CHECK(before > 0);
  CHECK(mo_register("reversed", "from the last to the first", 0, reversed, &calls) == MO_OK);
  CHECK(mo_method_count() == before + 1);
  CHECK(strcmp(mo_method_name(0), "auto") == 0);
  CHECK(mo_method_name(before) != NULL && strcmp(mo_method_name(before), "reversed") == 0);
  CHECK(mo_method_name(before) == mo_method_name(before));
  CHECK(mo_method_name(-1) == NULL && mo_method_name(before + 1) == NULL);
  result.struct_size = sizeof result;
  CHECK(order_path(&options, new_to_old, &result) == MO_OK);
  CHECK(calls == 1);
  CHECK(strcmp(result.method, "reversed") == 0);
  for (k = 0; k < N; ++k) CHECK(new_to_old[k] == N - 1 - k);

  CHECK(mo_register("reversed", "again", 0, reversed, &calls) == MO_INVALID_ARGUMENT);
  CHECK(mo_register("Upper Case", "", 0, reversed, &calls) == MO_INVALID_ARGUMENT);
  CHECK(mo_register(NULL, "", 0, reversed, &calls) == MO_INVALID_ARGUMENT);
  CHECK(mo_register("nothing", "", 0, NULL, NULL) == MO_INVALID_ARGUMENT);
  CHECK(strlen(mo_last_error()) > 0);

  CHECK(mo_register("failing", NULL, 0, failing, NULL) == MO_OK);
  options.method = "failing";
  CHECK(order_path(&options, new_to_old, NULL) == MO_INTERNAL);
  CHECK(strstr(mo_last_error(), "42") != NULL);
  CHECK(mo_register("constant", NULL, 0, constant, NULL) == MO_OK);
  options.method = "constant";
  CHECK(order_path(&options, new_to_old, NULL) == MO_INTERNAL);
  CHECK(mo_register("pointed", NULL, 1, reversed, &calls) == MO_OK);
  options.method = "pointed";
  CHECK(order_path(&options, new_to_old, NULL) == MO_INVALID_ARGUMENT);
}

typedef struct Reports {
  int count;
  int good; /* all reports had a stage and a fraction in range */
} Reports;

/* Stops at the second report. */
static int32_t on_progress(void* user, const char* stage, double fraction) {
  Reports* const reports = user;
  ++reports->count;
  if (strlen(stage) == 0 || fraction < -1 || fraction > 1) reports->good = 0;
  return reports->count >= 2;
}

/* A grid, large enough for several reports. */
static void test_progress(void) {
  enum { SIDE = 300, VERTICES = SIDE * SIDE };
  static int32_t grid_offsets[VERTICES + 1];
  static int32_t grid_neighbours[4 * VERTICES];
  static int32_t new_to_old[VERTICES];
  Reports reports = {0, 1};
  mo_options options = options_of("spectral");
  mo_in offsets = in32(grid_offsets, VERTICES + 1);
  mo_in neighbours;
  const mo_out order = out32(new_to_old, VERTICES);
  int32_t entries = 0;
  int32_t v;
  for (v = 0; v < VERTICES; ++v) {
    if (v >= SIDE) grid_neighbours[entries++] = v - SIDE;
    if (v % SIDE > 0) grid_neighbours[entries++] = v - 1;
    if (v % SIDE + 1 < SIDE) grid_neighbours[entries++] = v + 1;
    if (v + SIDE < VERTICES) grid_neighbours[entries++] = v + SIDE;
    grid_offsets[v + 1] = entries;
  }
  neighbours = in32(grid_neighbours, entries);
  options.progress = on_progress;
  options.user = &reports;
  CHECK(mo_order_graph(&offsets, &neighbours, NULL, NULL, 0, &options, &order, NULL, NULL) == MO_STOPPED);
  CHECK(reports.count == 2 && reports.good);
  CHECK(strlen(mo_last_error()) > 0);
}

/* Two tetrahedra with a common facet, numbered from 1. */
static const int32_t pair_offsets[3] = {1, 5, 9};
static const int32_t pair_vertices[8] = {4, 2, 3, 1, 2, 3, 4, 5};
static const int32_t pair_types[2] = {10, 10};

static mo_options from_one(void) {
  mo_options options = options_of(NULL);
  options.base = 1;
  return options;
}

static void test_patches(void) {
  const mo_in offsets = in32(pair_offsets, 3);
  const mo_in vertices = in32(pair_vertices, 8);
  const mo_options options = from_one();
  const mo_patches* made = NULL;
  int k;
  CHECK(mo_patches_create(&offsets, &vertices, NULL, 5, 2, &options, &made) == MO_OK);
  if (made == NULL) return;
  CHECK(made->count == 1 && made->size == 2 && made->vertices_per_cell == 4);
  CHECK(made->offsets[0] == 1 && made->offsets[1] == 6);
  for (k = 0; k < 5; ++k) CHECK(made->vertices[k] == k + 1);
  CHECK(made->cells[0] + made->cells[1] == 3);
  for (k = 0; k < 8; ++k) {
    const int32_t cell = made->cells[k / 4] - 1;
    CHECK(made->vertices[made->local[k]] == pair_vertices[4 * cell + k % 4]);
  }
  mo_patches_destroy(made);
  mo_patches_destroy(NULL);
  CHECK(mo_patches_create(&offsets, &vertices, NULL, 5, 1, &options, &made) == MO_INVALID_ARGUMENT);
  CHECK(made == NULL);
  CHECK(mo_patches_create(&offsets, &vertices, NULL, 4, 2, &options, &made) == MO_INVALID_ARGUMENT);
  CHECK(mo_patches_create(&offsets, &vertices, NULL, -1, 2, &options, &made) == MO_INVALID_ARGUMENT);
  CHECK(strstr(mo_last_error(), "vertex_count") != NULL);
  CHECK(mo_patches_create(&offsets, &vertices, NULL, 5, 2, &options, NULL) == MO_INVALID_ARGUMENT);
}

static void test_gather_lists_and_colours(void) {
  static const int32_t entries[6] = {1, 2, 4, 6, 8, 9};
  const mo_in offsets = in32(pair_offsets, 3);
  const mo_in vertices = in32(pair_vertices, 8);
  const mo_options options = from_one();
  const mo_gather_lists* lists = NULL;
  const mo_colours* colours = NULL;
  int v;
  CHECK(mo_gather_lists_create(&offsets, &vertices, NULL, 5, &options, &lists) == MO_OK);
  CHECK(mo_colours_create(&offsets, &vertices, NULL, 5, &options, &colours) == MO_OK);
  if (lists == NULL || colours == NULL) return;
  for (v = 0; v < 5; ++v) {
    int64_t entry;
    CHECK(lists->offsets[v] == entries[v] && lists->offsets[v + 1] == entries[v + 1]);
    for (entry = lists->offsets[v] - 1; entry < lists->offsets[v + 1] - 1; ++entry) {
      CHECK(pair_vertices[4 * (lists->cells[entry] - 1) + lists->corners[entry]] == v + 1);
    }
  }
  CHECK(colours->count == 2);
  CHECK(colours->starts[0] == 1 && colours->starts[1] == 2 && colours->starts[2] == 3);
  CHECK(colours->cells[0] == 1 && colours->cells[1] == 2);
  mo_gather_lists_destroy(lists);
  mo_gather_lists_destroy(NULL);
  mo_colours_destroy(colours);
  mo_colours_destroy(NULL);
  CHECK(mo_gather_lists_create(&offsets, NULL, NULL, 5, &options, &lists) == MO_INVALID_ARGUMENT);
  CHECK(mo_colours_create(NULL, &vertices, NULL, 5, &options, &colours) == MO_INVALID_ARGUMENT);
  CHECK(lists == NULL && colours == NULL);
}

static void test_sorted_corners(void) {
  static const int32_t expected[8] = {1, 2, 4, 3, 2, 3, 4, 5}; /* 4 2 3 1 is an odd permutation of 1 2 3 4 */
  const mo_in offsets = in32(pair_offsets, 3);
  const mo_in vertices = in32(pair_vertices, 8);
  const mo_in types = in32(pair_types, 2);
  const mo_options options = from_one();
  int32_t corners[8];
  mo_out sorted = out32(corners, 8);
  CHECK(mo_sort_corners(&offsets, &vertices, &types, 5, &options, &sorted) == MO_OK);
  CHECK(memcmp(corners, expected, sizeof corners) == 0);
  CHECK(mo_sort_corners(&offsets, &vertices, NULL, 5, &options, &sorted) == MO_INVALID_ARGUMENT);
  sorted.size = 7;
  CHECK(mo_sort_corners(&offsets, &vertices, &types, 5, &options, &sorted) == MO_INVALID_ARGUMENT);
}

/* 32 edges without a common vertex: the first ends of a warp's edges are side by side, and so are the second
 * ends. The matrix is that of the path.
 */
static void test_gpu_costs(void) {
  int32_t edge_offsets[33];
  int32_t edge_ends[64];
  mo_in offsets = in32(edge_offsets, 33);
  mo_in ends = in32(edge_ends, 64);
  mo_gpu_counts counts;
  int k;
  for (k = 0; k <= 32; ++k) edge_offsets[k] = 2 * k;
  for (k = 0; k < 64; ++k) edge_ends[k] = k / 2 + 32 * (k % 2);
  memset(&counts, 0, sizeof counts);
  counts.struct_size = sizeof counts;
  CHECK(mo_gpu_cost(&offsets, &ends, NULL, 64, "padded", 0, NULL, &counts) == MO_OK);
  CHECK(counts.requests == 2 && counts.sectors == 32 && counts.floor == 32);
  CHECK(counts.dram_bytes == 64 * 4 + 2 * 64 * 16 && counts.dram_floor == counts.dram_bytes);
  CHECK(mo_gpu_cost(&offsets, &ends, NULL, 64, "paded", 0, NULL, &counts) == MO_INVALID_ARGUMENT);
  CHECK(strstr(mo_last_error(), "padded") != NULL);
  CHECK(mo_gpu_cost(&offsets, &ends, NULL, 64, NULL, 0, NULL, &counts) == MO_INVALID_ARGUMENT);
  CHECK(mo_gpu_cost(&offsets, &ends, NULL, 64, "padded", -1, NULL, &counts) == MO_INVALID_ARGUMENT);
  CHECK(mo_gpu_cost(&offsets, &ends, NULL, 64, "padded", 0, NULL, NULL) == MO_INVALID_ARGUMENT);

  counts.dram_floor = -1;
  counts.struct_size = offsetof(mo_gpu_counts, dram_floor);
  offsets = in32(offsets32, N + 1);
  ends = in32(neighbours32, 8);
  CHECK(mo_gpu_product_cost(&offsets, &ends, 1, 0, NULL, &counts) == MO_OK);
  CHECK(counts.dram_bytes == 13 * 8 + 6 * 4 + 32 && counts.dram_floor == -1);
  CHECK(mo_gpu_product_cost(&offsets, &ends, 3, 0, NULL, &counts) == MO_INVALID_ARGUMENT);
  counts.struct_size = 0;
  CHECK(mo_gpu_product_cost(&offsets, &ends, 1, 0, NULL, &counts) == MO_INVALID_ARGUMENT);
}

int main(void) {
  CHECK(mo_version() > 0);
  CHECK(strcmp(mo_last_error(), "") == 0);
  test_order_of_any_integers();
  test_defaults();
  test_mesh();
  test_maps_of_a_mesh();
  test_edges();
  test_reorderer();
  test_alignment();
  test_fiedler();
  test_weights();
  test_largest_component();
  test_numbers_beyond();
  test_messages();
  test_mistakes();
  test_smaller_structures();
  test_own_methods();
  test_progress();
  test_patches();
  test_gather_lists_and_colours();
  test_sorted_corners();
  test_gpu_costs();
  return failures == 0 ? 0 : 1;
}
