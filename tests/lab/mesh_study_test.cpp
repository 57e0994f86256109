// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/study/mesh_study.hpp"

#include "mesh/graphs.hpp"
#include "mesh/procedural.hpp"
#include "mesh/reorder.hpp"
#include "payoff/access_stream.hpp"
#include "payoff/machine.hpp"
#include <meshorder/error.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <list>
#include <unordered_map>

namespace meshorder {
namespace {

const std::vector<OrderingSpec> kOrderings{{"original", "Original", "original", "original"},
                                           {"vf-fiedler", "VF Fiedler", "fiedler", "fiedler"},
                                           {"scrambled", "Scrambled", "scrambled", "original"},
                                           {"chosen", "Chosen", "auto", "auto"}};

MeshStudyOptions without_clock() {
  MeshStudyOptions options;
  options.measure = false;
  options.hierarchies = {{"small", parse_caches("4K,64K")}, {"large", parse_caches("32K,256K,10M")}};
  return options;
}

/// The misses of a simulated LRU cache in the second of two runs.
Offset lru_misses(const AccessStream& stream, Offset bytes) {
  const auto lines = static_cast<std::size_t>(bytes / kLineBytes);
  std::list<Index> by_recency;
  std::unordered_map<Index, std::list<Index>::iterator> place;
  Offset misses = 0;
  for (int run = 0; run < 2; ++run) {
    misses = 0;
    stream.visit([&](Index line, Access /*how*/) {
      const auto found = place.find(line);
      if (found != place.end()) {
        by_recency.splice(by_recency.begin(), by_recency, found->second);
        return;
      }
      ++misses;
      by_recency.push_front(line);
      place[line] = by_recency.begin();
      if (by_recency.size() <= lines) return;
      place.erase(by_recency.back());
      by_recency.pop_back();
    });
  }
  return misses;
}

/// A mesh in one of its orders.
Mesh moved(Mesh mesh, const MeshOrder& order) {
  apply_reordering(mesh, order);
  return mesh;
}

TEST(MeshStudy, CountsTheMeshAndItsEdges) {
  const Mesh mesh = make_grid({.size = 5});
  const OrderedMesh study = study_mesh(mesh, kOrderings, without_clock());
  EXPECT_EQ(study.record.vertices, 6 * 6 * 6);
  EXPECT_EQ(study.record.tetrahedra, 6 * 5 * 5 * 5);
  EXPECT_EQ(study.record.edges, vertex_graph(mesh).edge_count());
  EXPECT_EQ(study.record.span_bin, 50);
  ASSERT_EQ(study.record.orders.size(), kOrderings.size());
  ASSERT_EQ(study.orders.size(), kOrderings.size());
}

TEST(MeshStudy, SpansAreThoseOfTheMovedMesh) {
  const Mesh mesh = make_grid({.size = 9});
  const OrderedMesh study = study_mesh(mesh, kOrderings, without_clock());
  for (std::size_t i = 0; i < kOrderings.size(); ++i) {
    const MeshOrderRecord& order = study.record.orders[i];
    EXPECT_EQ(order.ordering, kOrderings[i].name);
    const CsrGraph graph = vertex_graph(moved(mesh, study.orders[i]));
    EXPECT_EQ(order.span, edge_span(graph, Permutation::identity(graph.size())));
    EXPECT_EQ(order.span_histogram, span_histogram(graph, Permutation::identity(graph.size()), 50));
  }
  EXPECT_LT(study.record.orders[1].span.mean, study.record.orders[0].span.mean);
  EXPECT_GT(study.record.orders[2].span.mean, 2 * study.record.orders[0].span.mean);
}

TEST(MeshStudy, MissesAreThoseOfLeastRecentlyUsedCaches) {
  const Mesh mesh = make_grid({.size = 7});
  const OrderedMesh study = study_mesh(mesh, kOrderings, without_clock());
  const std::vector<NamedCaches> hierarchies = without_clock().hierarchies;
  for (std::size_t i = 0; i < kOrderings.size(); ++i) {
    const Mesh ordered = moved(mesh, study.orders[i]);
    const CsrGraph graph = vertex_graph(ordered);
    const Simplices simplices = cut_into_simplices(ordered);
    for (const Kernel kernel : kKernels) {
      const KernelRecord& record = study.record.orders[i].kernels[static_cast<std::size_t>(kernel)];
      const AccessStream stream(kernel, graph, simplices);
      Offset accesses = 0;
      stream.visit([&](Index /*line*/, Access /*how*/) { ++accesses; });
      EXPECT_EQ(record.accesses, accesses);
      ASSERT_EQ(record.misses.size(), hierarchies.size());
      for (std::size_t h = 0; h < hierarchies.size(); ++h) {
        const std::vector<Offset>& levels = hierarchies[h].caches.level_bytes;
        ASSERT_EQ(record.misses[h].size(), levels.size());
        for (std::size_t level = 0; level < levels.size(); ++level)
          EXPECT_EQ(record.misses[h][level], lru_misses(stream, levels[level])) << to_string(kernel);
      }
      EXPECT_GT(record.predicted_ms, 0);
      EXPECT_EQ(record.measured_ms, 0);
    }
  }
}

TEST(MeshStudy, HierarchiesAreThisMachinesAndThePapersUnlessSaidOtherwise) {
  MeshStudyOptions options = without_clock();
  options.hierarchies.clear();
  const OrderedMesh study = study_mesh(make_grid({.size = 3}), kOrderings, options);
  ASSERT_EQ(study.record.hierarchies.size(), 2U);
  EXPECT_EQ(study.record.hierarchies[0], (NamedCaches{"this machine", caches_of_this_machine()}));
  EXPECT_EQ(study.record.hierarchies[1], (NamedCaches{"the paper's Xeon E5-1620 v4", caches_of_the_paper()}));
}

TEST(MeshStudy, WhatMovesNothingCostsNothing) {
  const OrderedMesh study = study_mesh(make_grid({.size = 6}), kOrderings, without_clock());
  EXPECT_EQ(study.record.orders[0].seconds, 0);
  EXPECT_GT(study.record.orders[1].seconds, 0);
  EXPECT_GT(study.record.orders[2].seconds, 0);
}

TEST(MeshStudy, SaysWhichMethodsWereTaken) {
  const OrderedMesh study = study_mesh(make_grid({.size = 6}), kOrderings, without_clock());
  EXPECT_EQ(study.record.orders[2].vertex_method, "scrambled");
  EXPECT_EQ(study.record.orders[2].element_method, "original");
  EXPECT_EQ(study.record.orders[3].vertex_method, study.orders[3].vertices.method.name);
  EXPECT_NE(study.record.orders[3].vertex_method, "auto");
}

TEST(MeshStudy, MeasuresEveryKernelInEveryOrder) {
  MeshStudyOptions options = without_clock();
  options.measure = true;
  options.timing = {.budget_seconds = 0, .min_rounds = 1, .max_rounds = 1, .sample_seconds = 1e-4};
  std::vector<double> fractions;
  options.progress = [&](std::string_view what, double fraction) {
    EXPECT_FALSE(what.empty());
    fractions.push_back(fraction);
  };
  const OrderedMesh study = study_mesh(make_grid({.size = 6}), kOrderings, options);
  for (const MeshOrderRecord& order : study.record.orders) {
    for (const KernelRecord& kernel : order.kernels) {
      EXPECT_GT(kernel.measured_ms, 0);
      EXPECT_LT(kernel.measured_ms, 1000);
    }
  }
  EXPECT_GE(fractions.size(), kOrderings.size() + 1);
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  EXPECT_LE(fractions.back(), 1);
}

TEST(MeshStudy, GivesTheSameOnEveryRun) {
  const Mesh mesh = make_ball({.size = 8});
  OrderedMesh one = study_mesh(mesh, kOrderings, without_clock());
  OrderedMesh other = study_mesh(mesh, kOrderings, without_clock());
  for (OrderedMesh* study : {&one, &other}) {
    for (MeshOrderRecord& order : study->record.orders) order.seconds = 0;
  }
  EXPECT_EQ(one.record, other.record);
}

TEST(MeshStudy, OrdersAreTheSameOnOneThread) {
  const Mesh mesh = make_ball({.size = 12});
  MeshStudyOptions options = without_clock();
  const OrderedMesh on_all = study_mesh(mesh, kOrderings, options);
  options.threads = 1;
  const OrderedMesh on_one = study_mesh(mesh, kOrderings, options);
  for (std::size_t i = 0; i < kOrderings.size(); ++i) {
    EXPECT_EQ(on_all.orders[i].vertices.permutation, on_one.orders[i].vertices.permutation);
    EXPECT_EQ(on_all.orders[i].cells.permutation, on_one.orders[i].cells.permutation);
  }
}

TEST(MeshStudy, RefusesUnknownMethods) {
  EXPECT_THROW(study_mesh(make_grid({.size = 2}), {{"a", "A", "sorted", "original"}}, without_clock()),
               InvalidArgument);
}

TEST(MeshStudy, BinsOfSpansAreThePapersUpTo200000Vertices) {
  EXPECT_EQ(span_bin_width(0), 50);
  EXPECT_EQ(span_bin_width(200'000), 50);
  EXPECT_EQ(span_bin_width(200'001), 100);
  EXPECT_EQ(span_bin_width(2'000'000), 500);
  EXPECT_EQ(span_bin_width(kMaxIndex), 536'900);
}

}  // namespace
}  // namespace meshorder
