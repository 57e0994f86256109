// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Kernels of simulations in single precision, as in programs for graphics processors. Stiffnesses and masses
// are 1. CuPy has NVRTC compile them; the tests compile them with python/tests/emulator.hpp, which runs them
// on a CPU.
//
// n counts rows, elements or springs, one thread each. `corners` are the four vertices of each tetrahedron.
// `rest` has ten arrays of n numbers, one after another: three coordinates of the gradient of corner 1, of
// corner 2 and of corner 3, then the volume. `ends` and `lengths` are the two vertices and the rest length of
// each spring.

#ifndef VECTOR_ADDITIONS  // of four numbers at once: since compute capability 9.0 and CUDA 12.1
#define VECTOR_ADDITIONS (__CUDA_ARCH__ >= 900 && 100 * __CUDACC_VER_MAJOR__ + __CUDACC_VER_MINOR__ >= 1201)
#endif

extern __shared__ float shared[];

struct Vector {
  float x, y, z;
};

static __device__ Vector operator+(Vector a, Vector b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
static __device__ Vector operator-(Vector a, Vector b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
static __device__ Vector operator*(float s, Vector a) { return {s * a.x, s * a.y, s * a.z}; }
static __device__ float dot(Vector a, Vector b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

// Three numbers of each vertex side by side.
template <class Number>
struct Packed {
  Number* numbers;

  __device__ Vector at(int v) const {
    const float* const p = numbers + 3ll * v;
    return {p[0], p[1], p[2]};
  }
  __device__ void add(int v, Vector a) const {
    Number* const p = numbers + 3ll * v;
    atomicAdd(p, a.x);
    atomicAdd(p + 1, a.y);
    atomicAdd(p + 2, a.z);
  }
};

// All x, then all y, then all z, `stride` numbers apart.
template <class Number>
struct Apart {
  Number* numbers;
  long long stride;

  __device__ Vector at(int v) const { return {numbers[v], numbers[stride + v], numbers[2 * stride + v]}; }
  __device__ void add(int v, Vector a) const {
    atomicAdd(numbers + v, a.x);
    atomicAdd(numbers + stride + v, a.y);
    atomicAdd(numbers + 2 * stride + v, a.z);
  }
};

// Four numbers of each vertex side by side, the last of them unused.
template <class Quad>
struct Padded {
  Quad* quads;

  __device__ Vector at(int v) const {
    const float4 p = quads[v];
    return {p.x, p.y, p.z};
  }
  __device__ void add(int v, Vector a) const {
#if VECTOR_ADDITIONS
    atomicAdd(quads + v, make_float4(a.x, a.y, a.z, 0));
#else
    atomicAdd(&quads[v].x, a.x);
    atomicAdd(&quads[v].y, a.y);
    atomicAdd(&quads[v].z, a.z);
#endif
  }
};

struct Forces {
  Vector of[4];
};

// Returns the elastic forces on the corners c of tetrahedron e, for small strains.
template <class Points, class Corners>
static __device__ Forces element_forces(Points points, Corners c, const float* rest, int n, int e) {
  const Vector origin = points.at(c.x);
  const Vector d[3] = {points.at(c.y) - origin, points.at(c.z) - origin, points.at(c.w) - origin};
  Vector m[3];
  for (int k = 0; k < 3; ++k)
    m[k] = {rest[3ll * k * n + e], rest[(3ll * k + 1) * n + e], rest[(3ll * k + 2) * n + e]};
  // rows of the displacement's gradient, then of the stress
  const Vector gx = {d[0].x * m[0].x + d[1].x * m[1].x + d[2].x * m[2].x - 1,
                     d[0].x * m[0].y + d[1].x * m[1].y + d[2].x * m[2].y,
                     d[0].x * m[0].z + d[1].x * m[1].z + d[2].x * m[2].z};
  const Vector gy = {d[0].y * m[0].x + d[1].y * m[1].x + d[2].y * m[2].x,
                     d[0].y * m[0].y + d[1].y * m[1].y + d[2].y * m[2].y - 1,
                     d[0].y * m[0].z + d[1].y * m[1].z + d[2].y * m[2].z};
  const Vector gz = {d[0].z * m[0].x + d[1].z * m[1].x + d[2].z * m[2].x,
                     d[0].z * m[0].y + d[1].z * m[1].y + d[2].z * m[2].y,
                     d[0].z * m[0].z + d[1].z * m[1].z + d[2].z * m[2].z - 1};
  const float trace = gx.x + gy.y + gz.z;
  const Vector sx = {2 * gx.x + trace, gx.y + gy.x, gx.z + gz.x};
  const Vector sy = {gx.y + gy.x, 2 * gy.y + trace, gy.z + gz.y};
  const Vector sz = {gx.z + gz.x, gy.z + gz.y, 2 * gz.z + trace};
  const float volume = rest[9ll * n + e];
  Forces f;
  for (int k = 0; k < 3; ++k) f.of[k + 1] = -volume * Vector{dot(sx, m[k]), dot(sy, m[k]), dot(sz, m[k])};
  f.of[0] = -1 * f.of[1] - f.of[2] - f.of[3];
  return f;
}

template <class Sums, class Corners>
static __device__ void add_forces(Sums sums, Corners c, Forces f) {
  sums.add(c.x, f.of[0]);
  sums.add(c.y, f.of[1]);
  sums.add(c.z, f.of[2]);
  sums.add(c.w, f.of[3]);
}

// Returns the force on the first end of a spring; d leads to its other end.
static __device__ Vector spring_force(Vector d, float length) {
  const float now = sqrtf(dot(d, d));
  return (now > 0 ? 1 - length / now : 0) * d;
}

// Adds the force of a spring to both ends.
template <class Points, class Sums>
static __device__ void add_spring(Points points, Sums sums, int2 ends, float length) {
  const Vector f = spring_force(points.at(ends.y) - points.at(ends.x), length);
  sums.add(ends.x, f);
  sums.add(ends.y, -1 * f);
}

static __device__ int thread_number() { return blockIdx.x * blockDim.x + threadIdx.x; }

// Product of a sparse matrix with a vector, a thread for each row.
extern "C" __global__ void product_rows(int n, const int* __restrict__ offsets,
                                        const int* __restrict__ columns, const float* __restrict__ values,
                                        const float* __restrict__ x, float* y) {
  const int row = thread_number();
  if (row >= n) return;
  float sum = 0;
  for (int k = offsets[row]; k < offsets[row + 1]; ++k) sum += values[k] * x[columns[k]];
  y[row] = sum;
}

// The same product, with eight lanes of a warp for each row.
extern "C" __global__ void product_lanes(int n, const int* __restrict__ offsets,
                                         const int* __restrict__ columns, const float* __restrict__ values,
                                         const float* __restrict__ x, float* y) {
  const int row = thread_number() / 8;
  const int lane = thread_number() % 8;
  float sum = 0;
  if (row < n)
    for (int k = offsets[row] + lane; k < offsets[row + 1]; k += 8) sum += values[k] * x[columns[k]];
  for (int apart = 4; apart > 0; apart /= 2) sum += __shfl_xor_sync(~0u, sum, apart);
  if (row < n && lane == 0) y[row] = sum;
}

// Forces of elements, added atomically.
extern "C" __global__ void forces_packed(int n, const int4* __restrict__ corners,
                                         const float* __restrict__ rest, const float* __restrict__ points,
                                         float* sums) {
  const int e = thread_number();
  if (e >= n) return;
  const int4 c = corners[e];
  add_forces(Packed<float>{sums}, c, element_forces(Packed<const float>{points}, c, rest, n, e));
}

extern "C" __global__ void forces_apart(int n, int stride, const int4* __restrict__ corners,
                                        const float* __restrict__ rest, const float* __restrict__ points,
                                        float* sums) {
  const int e = thread_number();
  if (e >= n) return;
  const int4 c = corners[e];
  add_forces(Apart<float>{sums, stride}, c,
             element_forces(Apart<const float>{points, stride}, c, rest, n, e));
}

extern "C" __global__ void forces_padded(int n, const int4* __restrict__ corners,
                                         const float* __restrict__ rest, const float4* __restrict__ points,
                                         float4* sums) {
  const int e = thread_number();
  if (e >= n) return;
  const int4 c = corners[e];
  add_forces(Padded<float4>{sums}, c, element_forces(Padded<const float4>{points}, c, rest, n, e));
}

// One block for each patch, one thread for each element of the patch. The points of the patch and the sums of
// the forces on them are in shared memory, 24 bytes for each vertex of the patch.
extern "C" __global__ void forces_patches(int n, const int* __restrict__ offsets,
                                          const int* __restrict__ vertices, const ushort4* __restrict__ local,
                                          const float* __restrict__ rest, const float* __restrict__ points,
                                          float* sums) {
  const int begin = offsets[blockIdx.x];
  const int numbers = 3 * (offsets[blockIdx.x + 1] - begin);
  float* const own = shared + numbers;
  for (int i = threadIdx.x; i < numbers; i += blockDim.x) {
    shared[i] = points[3ll * vertices[begin + i / 3] + i % 3];
    own[i] = 0;
  }
  __syncthreads();
  const int e = thread_number();
  if (e < n) {
    const ushort4 c = local[e];
    add_forces(Packed<float>{own}, c, element_forces(Packed<const float>{shared}, c, rest, n, e));
  }
  __syncthreads();
  for (int i = threadIdx.x; i < numbers; i += blockDim.x)
    atomicAdd(sums + 3ll * vertices[begin + i / 3] + i % 3, own[i]);
}

// Without atomic additions: first the forces on the corners of each element …
extern "C" __global__ void corner_forces(int n, const int4* __restrict__ corners,
                                         const float* __restrict__ rest, const float* __restrict__ points,
                                         float4* forces) {
  const int e = thread_number();
  if (e >= n) return;
  const Forces f = element_forces(Packed<const float>{points}, corners[e], rest, n, e);
  for (int k = 0; k < 4; ++k) forces[4ll * e + k] = make_float4(f.of[k].x, f.of[k].y, f.of[k].z, 0);
}

// … then the sum of the forces on each of n vertices. Their places in `forces` are `gathered[offsets[v]]` to
// below `gathered[offsets[v + 1]]`.
extern "C" __global__ void sum_corners(int n, const int* __restrict__ offsets,
                                       const int* __restrict__ gathered, const float4* __restrict__ forces,
                                       float* sums) {
  const int v = thread_number();
  if (v >= n) return;
  Vector sum = {0, 0, 0};
  for (int k = offsets[v]; k < offsets[v + 1]; ++k) {
    const float4 f = forces[gathered[k]];
    sum = sum + Vector{f.x, f.y, f.z};
  }
  sums[3ll * v] = sum.x;
  sums[3ll * v + 1] = sum.y;
  sums[3ll * v + 2] = sum.z;
}

// Forces of springs, added atomically.
extern "C" __global__ void springs_packed(int n, const int2* __restrict__ ends,
                                          const float* __restrict__ lengths, const float* __restrict__ points,
                                          float* sums) {
  const int s = thread_number();
  if (s < n) add_spring(Packed<const float>{points}, Packed<float>{sums}, ends[s], lengths[s]);
}

extern "C" __global__ void springs_padded(int n, const int2* __restrict__ ends,
                                          const float* __restrict__ lengths,
                                          const float4* __restrict__ points, float4* sums) {
  const int s = thread_number();
  if (s < n) add_spring(Padded<const float4>{points}, Padded<float4>{sums}, ends[s], lengths[s]);
}

// Without atomic additions: each of n vertices sums the forces of its springs. `lengths` are their rest
// lengths, one for each neighbour.
extern "C" __global__ void springs_gathered(int n, const int* __restrict__ offsets,
                                            const int* __restrict__ neighbours,
                                            const float* __restrict__ lengths,
                                            const float* __restrict__ points, float* sums) {
  const int v = thread_number();
  if (v >= n) return;
  const Packed<const float> at{points};
  Vector sum = {0, 0, 0};
  for (int k = offsets[v]; k < offsets[v + 1]; ++k)
    sum = sum + spring_force(at.at(neighbours[k]) - at.at(v), lengths[k]);
  sums[3ll * v] = sum.x;
  sums[3ll * v + 1] = sum.y;
  sums[3ll * v + 2] = sum.z;
}

// Moves both ends of the n springs of a colour, from spring `begin` on, to the rest lengths: distance
// constraints of extended position-based dynamics without compliance. The fourth number of a point is its
// inverse mass.
extern "C" __global__ void distances(int n, int begin, const int2* __restrict__ ends,
                                     const float* __restrict__ lengths, float4* points) {
  const int s = begin + thread_number();
  if (s >= begin + n) return;
  const int2 v = ends[s];
  float4 p = points[v.x];
  float4 q = points[v.y];
  const Vector f = 1 / (p.w + q.w) * spring_force({q.x - p.x, q.y - p.y, q.z - p.z}, lengths[s]);
  points[v.x] = make_float4(p.x + p.w * f.x, p.y + p.w * f.y, p.z + p.w * f.z, p.w);
  points[v.y] = make_float4(q.x - q.w * f.x, q.y - q.w * f.y, q.z - q.w * f.z, q.w);
}

// Keeps the device busy until all launches of the timed kernels wait in its queue.
extern "C" __global__ void hold(long long cycles) {
  const long long begin = clock64();
  while (clock64() - begin < cycles) {
  }
}
