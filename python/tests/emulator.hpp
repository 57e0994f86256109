// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Runs CUDA kernels on a CPU, to test them without a graphics processor. Include this file before the
// kernels' source and compile both with a C++ compiler. Blocks run one after another. The threads of a block
// are fibres: each runs up to a barrier or a shuffle, then the next one runs. The atomic additions to global
// memory are counted as a GPU's memory receives them.
#pragma once

#include <ucontext.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <deque>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#define __global__
#define __device__
#define __shared__

struct int2 {
  int x, y;
};
struct int4 {
  int x, y, z, w;
};
struct ushort4 {
  unsigned short x, y, z, w;
};
struct alignas(16) float4 {
  float x, y, z, w;
};
inline float4 make_float4(float x, float y, float z, float w) { return {x, y, z, w}; }

struct Place {
  int x;
};
static Place threadIdx, blockIdx, blockDim;
static constexpr std::size_t kSharedNumbers = 48 * 1024 / sizeof(float);
alignas(16) float shared[kSharedNumbers];

namespace emulator {

constexpr int kLanes = 32;
constexpr std::uintptr_t kSector = 32;
constexpr std::size_t kStack = 64 * 1024;

enum class State { ready, at_shuffle, at_barrier, ended };

struct Fibre {
  ucontext_t context;
  std::unique_ptr<char[]> stack;
  State state;
  int line;                               ///< of the barrier or shuffle
  float given, received;                  ///< by the shuffle
  std::vector<std::uintptr_t> additions;  ///< addresses, in the order of the program
};

struct Counts {
  long long requests = 0;  ///< atomic additions, each of a warp at once
  /// Sectors of 32 bytes. A sector counts t times, where t is the largest number of additions that a request
  /// makes to one number in the sector.
  long long sectors = 0;
};

static std::deque<Fibre> fibres;  // one per thread of the largest block so far
static ucontext_t scheduler;
static std::function<void()> kernel;
static Counts counts;
static char fault[120];

static void wait(State state, int line) {
  Fibre& fibre = fibres[threadIdx.x];
  fibre.state = state;
  fibre.line = line;
  swapcontext(&fibre.context, &scheduler);
}

static void run_fibre() {
  for (;;) {
    kernel();
    wait(State::ended, 0);
  }
}

static void make_fibres(std::size_t count) {
  while (fibres.size() < count) {
    Fibre& fibre = fibres.emplace_back();
    fibre.stack.reset(new char[kStack]);
    getcontext(&fibre.context);
    fibre.context.uc_stack.ss_sp = fibre.stack.get();
    fibre.context.uc_stack.ss_size = kStack;
    makecontext(&fibre.context, run_fibre, 0);
  }
}

/// Returns whether fibres `begin` to `end` have come to the same line in this state.
static bool all_wait(int begin, int end, State state) {
  return std::all_of(fibres.begin() + begin, fibres.begin() + end, [&](const Fibre& fibre) {
    return fibre.state == state && fibre.line == fibres[begin].line;
  });
}

static void release(int begin, int end) {
  for (int i = begin; i < end; ++i) fibres[i].state = State::ready;
}

/// Runs the fibres of a warp up to a barrier or their end. `run_block` reports a shuffle at which only some
/// fibres arrive.
static void run_warp(int begin, int end) {
  for (;;) {
    for (int i = begin; i < end; ++i) {
      if (fibres[i].state != State::ready) continue;
      threadIdx.x = i;
      swapcontext(&scheduler, &fibres[i].context);
    }
    if (!all_wait(begin, end, State::at_shuffle)) return;
    for (int i = begin; i < end; ++i) fibres[i].received = fibres[i].given;
    release(begin, end);
  }
}

/// Counts the additions of a warp: the k-th additions of all its lanes are one request.
static void count_warp(int begin, int end) {
  for (std::size_t k = 0;; ++k) {
    std::vector<std::uintptr_t> to;
    for (int i = begin; i < end; ++i)
      if (k < fibres[i].additions.size()) to.push_back(fibres[i].additions[k]);
    if (to.empty()) return;
    std::sort(to.begin(), to.end());
    ++counts.requests;
    for (std::size_t i = 0, most = 0, same = 0; i < to.size(); ++i) {
      same = i > 0 && to[i] == to[i - 1] ? same + 1 : 1;
      most = std::max(most, same);
      if (i + 1 < to.size() && to[i] / kSector == to[i + 1] / kSector) continue;
      counts.sectors += static_cast<long long>(most);
      most = 0;
    }
  }
}

/// Returns whether all threads came to the same barriers and ended.
static bool run_block() {
  const int count = blockDim.x;
  std::memset(shared, 0xff, sizeof shared);  // NaN until a thread writes numbers
  for (Fibre& fibre : fibres) fibre.additions.clear();
  do {
    release(0, count);
    for (int begin = 0; begin < count; begin += kLanes) run_warp(begin, std::min(begin + kLanes, count));
  } while (all_wait(0, count, State::at_barrier));
  for (int begin = 0; begin < count; begin += kLanes) count_warp(begin, std::min(begin + kLanes, count));
  return all_wait(0, count, State::ended);
}

/// Runs a kernel and returns its fault, or an empty text.
template <class... Arguments, std::size_t... I>
const char* launch(void (*function)(Arguments...), int blocks, int threads, void** arguments,
                   std::index_sequence<I...>) {
  kernel = [=] { function(*static_cast<Arguments*>(arguments[I])...); };
  fault[0] = '\0';
  blockDim.x = threads;
  make_fibres(threads);
  for (blockIdx.x = 0; blockIdx.x < blocks; ++blockIdx.x) {
    if (run_block()) continue;
    const auto waits =
        std::find_if(fibres.begin(), fibres.end(), [](const Fibre& f) { return f.state != State::ended; });
    std::snprintf(fault, sizeof fault, "line %d: not all threads of block %d come here", waits->line,
                  blockIdx.x);
    fibres.clear();
    break;
  }
  return fault;
}

template <class... Arguments>
const char* launch(void (*function)(Arguments...), int blocks, int threads, void** arguments) {
  return launch(function, blocks, threads, arguments, std::index_sequence_for<Arguments...>{});
}

static void note_addition(const void* to) {
  if (to >= shared && to < shared + kSharedNumbers) return;
  fibres[threadIdx.x].additions.push_back(reinterpret_cast<std::uintptr_t>(to));
}

}  // namespace emulator

inline void __syncthreads(int line = __builtin_LINE()) { emulator::wait(emulator::State::at_barrier, line); }

inline float __shfl_xor_sync(unsigned, float value, int lanes, int line = __builtin_LINE()) {
  const int thread = threadIdx.x;
  emulator::fibres[thread].given = value;
  emulator::wait(emulator::State::at_shuffle, line);
  return emulator::fibres[thread ^ lanes].received;
}

inline void atomicAdd(float* to, float value) {
  emulator::note_addition(to);
  *to += value;
}

inline void atomicAdd(float4* to, float4 value) {
  emulator::note_addition(to);
  *to = {to->x + value.x, to->y + value.y, to->z + value.z, to->w + value.w};
}

inline long long clock64() {
  static long long time = 0;
  return time += 1000;
}

/// Returns requests and sectors since the last call.
extern "C" void take_counts(long long* requests_and_sectors) {
  requests_and_sectors[0] = emulator::counts.requests;
  requests_and_sectors[1] = emulator::counts.sectors;
  emulator::counts = {};
}
