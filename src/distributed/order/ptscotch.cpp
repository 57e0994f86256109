// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// Chevalier, Pellegrini: PT-Scotch, a tool for efficient parallel graph ordering (2008).
#include "distributed/order/partition.hpp"
#include <meshorder/error.hpp>

#include <ptscotch.h>

#include <cstdio>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

static_assert(std::is_same_v<SCOTCH_Num, meshorder::distributed::GlobalIndex>,
              "the header is that of a PT-Scotch with other than 64-bit numbers");

// Silences the error messages of PT-Scotch. Its functions also return errors, which are reported once for all
// ranks.
extern "C" {
void SCOTCH_errorProg(const char* /*program*/) {}
void SCOTCH_errorPrint(const char* /*format*/, ...) {}
void SCOTCH_errorPrintW(const char* /*format*/, ...) {}
}

namespace meshorder::distributed {
namespace {

constexpr double kImbalance = 0.02;  // largest part / mean part − 1

/// Deleter that frees the contents of a PT-Scotch object.
template <class Object, void (*Exit)(Object*)>
struct End {
  void operator()(Object* object) const noexcept { Exit(object); }
};
using Context = std::unique_ptr<SCOTCH_Context, End<SCOTCH_Context, SCOTCH_contextExit>>;
using Strategy = std::unique_ptr<SCOTCH_Strat, End<SCOTCH_Strat, SCOTCH_stratExit>>;
using Graph = std::unique_ptr<SCOTCH_Dgraph, End<SCOTCH_Dgraph, SCOTCH_dgraphExit>>;

/// Sets up `context` for repeatable results: a fixed seed, one thread, and its own random numbers, which do
/// not depend on earlier calls. Returns whether that succeeded.
bool make_deterministic(SCOTCH_Context* context) {
  return SCOTCH_contextOptionSetNum(context, SCOTCH_OPTIONNUMDETERMINISTIC, 1) == 0 &&
         SCOTCH_contextOptionSetNum(context, SCOTCH_OPTIONNUMRANDOMFIXEDSEED, 1) == 0 &&
         SCOTCH_contextRandomClone(context) == 0 && SCOTCH_contextThreadSpawn(context, 1, nullptr) == 0;
}

/// Returns whether `done` is true on all ranks.
bool all(const Communicator& communicator, bool done) {
  const std::vector<char> others = communicator.gathered(static_cast<char>(done ? 1 : 0));
  return std::find(others.begin(), others.end(), 0) == others.end();
}

}  // namespace

bool cut_by_ptscotch(const Communicator& communicator, const GlobalGraph& graph, Index parts,
                     const std::vector<GlobalIndex>& weights, ScotchStrategy strategy,
                     std::vector<Index>& part_of) {
  if (SCOTCH_numSizeof() != static_cast<int>(sizeof(SCOTCH_Num))) {
    throw SharedError(Code::unavailable, "this program runs with a PT-Scotch of " +
                                             std::to_string(8 * SCOTCH_numSizeof()) +
                                             "-bit numbers; build it with that of scotch-int64");
  }
  const SCOTCH_Num vertices = graph.rows.size();
  // PT-Scotch takes non-const arrays, but does not change these
  std::vector<SCOTCH_Num> starts;
  std::vector<SCOTCH_Num> result;
  std::vector<SCOTCH_Num> loads;  // weights; passed by all ranks (also those without vertices) or by none
  const bool is_weighted = communicator.sum(static_cast<GlobalIndex>(weights.size())) > 0;
  communicator.together([&] {
    starts.assign(graph.rows.offsets.begin(), graph.rows.offsets.end());
    result.resize(static_cast<std::size_t>(vertices) + 1);
    loads.assign(weights.begin(), weights.end());
    loads.resize(result.size());
  });
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-const-cast)
  auto* const neighbours = const_cast<SCOTCH_Num*>(graph.rows.entries.data());
  const auto entries = static_cast<SCOTCH_Num>(graph.rows.entries.size());

  SCOTCH_Context context_memory;
  if (!all(communicator, SCOTCH_contextInit(&context_memory) == 0)) return false;
  const Context context(&context_memory);
  SCOTCH_Strat strategy_memory;
  if (!all(communicator, make_deterministic(context.get()) && SCOTCH_stratInit(&strategy_memory) == 0))
    return false;
  const Strategy how(&strategy_memory);
  const SCOTCH_Num flags = strategy == ScotchStrategy::speed ? SCOTCH_STRATSPEED : SCOTCH_STRATQUALITY;
  SCOTCH_Dgraph graph_memory;
  if (!all(communicator,
           SCOTCH_stratDgraphMapBuild(how.get(), flags, communicator.size(), parts, kImbalance) == 0 &&
               SCOTCH_dgraphInit(&graph_memory, communicator.handle()) == 0))
    return false;
  const Graph own(&graph_memory);
  if (!all(communicator, SCOTCH_dgraphBuild(own.get(), 0, vertices, vertices, starts.data(),
                                            starts.data() + 1, is_weighted ? loads.data() : nullptr, nullptr,
                                            entries, entries, neighbours, nullptr, nullptr) == 0))
    return false;
  SCOTCH_Dgraph bound_memory;
  if (!all(communicator, SCOTCH_contextBindDgraph(context.get(), own.get(), &bound_memory) == 0))
    return false;
  const Graph bound(&bound_memory);
  if (!all(communicator, SCOTCH_dgraphPart(bound.get(), parts, how.get(), result.data()) == 0)) return false;
  communicator.together([&] { part_of.assign(result.begin(), result.begin() + vertices); });
  return true;
}

}  // namespace meshorder::distributed
