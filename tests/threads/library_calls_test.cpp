// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Several threads of the caller use the library at once, for ThreadSanitizer.
#include "mesh/procedural.hpp"
#include "support/files.hpp"
#include "support/sample_meshes.hpp"
#include <meshorder/error.hpp>
#include <meshorder/io.hpp>
#include <meshorder/order.hpp>
#include <meshorder/payoff.hpp>
#include <meshorder/quality.hpp>
#include <meshorder/registry.hpp>

#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

namespace meshorder {
namespace {

using RunOfCall = meshorder::Run;  // gtest's tests have a Run of their own

/// Calls `work(t)` on `count` threads at once, and fails if one throws.
void on_threads(int count, const std::function<void(int)>& work) {
  std::atomic<int> waiting = count;
  std::atomic<int> failed = 0;
  std::vector<std::thread> threads;
  for (int t = 0; t < count; ++t) {
    threads.emplace_back([&, t] {
      --waiting;
      while (waiting > 0) std::this_thread::yield();
      try {
        work(t);
      } catch (const std::exception& error) {
        ++failed;
        ADD_FAILURE() << "thread " << t << ": " << error.what();
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(failed, 0);
}

TEST(LibraryCalls, OrderOneMeshOnSeveralThreadsAtOnce) {
  const Mesh mesh = make_grid({.size = 20});
  const std::vector<std::string> methods{"fiedler", "spectral", "minla", "rcm", "hilbert", "auto"};
  std::vector<Permutation> expected;
  for (const std::string& method : methods) {
    expected.push_back(order_mesh(view(mesh), {method, "lexmax"}).vertices.permutation);
  }
  on_threads(4, [&](int t) {
    for (std::size_t turn = 0; turn < methods.size(); ++turn) {
      const std::size_t m = (turn + static_cast<std::size_t>(t)) % methods.size();
      const MeshOrder order = order_mesh(view(mesh), {methods[m], "lexmax"}, {.run = {.threads = 1 + t}});
      EXPECT_EQ(order.vertices.permutation, expected[m]) << methods[m];
    }
  });
}

TEST(LibraryCalls, ReadAndWriteAllFormatsAtOnce) {
  const Mesh mesh = test::tetrahedral_bar(5);
  const test::TemporaryFolder folder;
  const std::vector<FormatInfo> all = formats();
  on_threads(3, [&](int t) {
    for (std::size_t turn = 0; turn < all.size(); ++turn) {
      const FormatInfo& format = all[(turn + 5 * static_cast<std::size_t>(t)) % all.size()];
      const std::filesystem::path path =
          folder.path() / (std::to_string(t) + format.name + format.extensions.front());
      Notes notes;
      try {
        write_mesh(mesh, path, &notes);
      } catch (const InputError&) {
        continue;  // the format holds no tetrahedra
      }
      EXPECT_EQ(read_mesh(path).vertex_count(), mesh.vertex_count()) << format.name;
      if (!format.single_file) continue;
      std::ostringstream stream;
      write_mesh(mesh, stream, format.name);
      const std::string bytes = stream.str();
      EXPECT_EQ(read_mesh(std::as_bytes(std::span(bytes)), {.format = format.name}).cell_count(),
                mesh.cell_count())
          << format.name;
    }
  });
}

TEST(LibraryCalls, TellTheirProgressAndStopAtOnce) {
  const Mesh mesh = make_grid({.size = 24});
  const Graph graph = vertex_graph(view(mesh).cells, mesh.points.size());
  // methods that never return, however fast the machine: their calls belong to the call that is stopped
  std::vector<Registration> registrations;
  for (const std::string inner : {"minla", "spectral"}) {
    const auto work = [&graph, inner](const VertexProblem&, const OrderOptions&) -> Permutation {
      for (;;) (void)order_vertices(graph, inner, {.tolerance = 1e-6});
    };
    registrations.push_back(register_vertex_method({.name = "endless-" + inner}, work));
  }
  std::atomic<int> stopped = 0;
  on_threads(4, [&](int t) {
    for (int turn = 0; turn < 3; ++turn) {
      int calls = 0;
      const RunOfCall run{.threads = 1 + t % 3, .progress = [&](const Progress&) { return ++calls <= turn; }};
      try {
        (void)order_vertices(graph, t % 2 == 0 ? "endless-minla" : "endless-spectral", {.run = run});
      } catch (const Stopped&) {
        ++stopped;
        EXPECT_EQ(calls, turn + 1);
      }
      (void)order_vertices(graph, "fiedler", {.tolerance = 1e-9, .run = {.threads = 2, .time_limit = 0.01}});
    }
  });
  EXPECT_EQ(stopped, 12);
}

TEST(LibraryCalls, RegisterAndUseMethodsAtOnce) {
  const Mesh mesh = make_grid({.size = 6});
  const Graph graph = vertex_graph(view(mesh).cells, mesh.points.size());
  on_threads(4, [&](int t) {
    for (int turn = 0; turn < 20; ++turn) {
      const std::string name = "own-" + std::to_string(t);
      const Registration registration =
          register_vertex_method({.name = name}, [](const VertexProblem& problem, const OrderOptions&) {
            return Permutation::identity(static_cast<Index>(problem.offsets.size() - 1));
          });
      EXPECT_TRUE(order_vertices(graph, name).permutation.is_identity());
      EXPECT_FALSE(vertex_methods().empty());
    }
  });
}

TEST(LibraryCalls, JudgeOrdersAtOnce) {
  const Mesh mesh = make_grid({.size = 12});
  const Graph graph = vertex_graph(view(mesh).cells, mesh.points.size());
  const Quality expected = quality(graph);
  on_threads(3, [&](int t) {
    EXPECT_EQ(quality(graph, {.threads = 1 + t}), expected);
    const Advice advice = advise(view(mesh), {.measure = t == 0, .budget_seconds = 0.2});
    EXPECT_FALSE(to_string(advice).empty());
  });
}

}  // namespace
}  // namespace meshorder
