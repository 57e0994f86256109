// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Measures the gain of orders in DOLFINx: −Δu + u = 1 + x by linear tetrahedra, on a mesh of TetGen.
//
//   dolfinx_measure PREFIX ROUNDS
#include "problem.hpp"
#include "reaction.h"
#include <meshorder/dolfinx.hpp>

#include <basix/finite-element.h>
#include <dolfinx/common/log.h>
#include <dolfinx/graph/ordering.h>

#include <array>
#include <cstdio>
#include <deque>
#include <memory>
#include <string>
#include <utility>
#include <vector>

int main(int argc, char** argv) {
  if (argc < 3) {
    std::printf("usage: %s PREFIX ROUNDS\n", argv[0]);
    return 2;
  }
  MPI_Init(&argc, &argv);
  dolfinx::init_logging(argc, argv);  // warnings only
  {
    const measuring::Tetrahedra tetrahedra = measuring::read_tetgen(argv[1]);
    std::printf("%zu vertices, %zu tetrahedra\n\n", tetrahedra.points.size(), tetrahedra.cells.size());
    const problem::Reorder gps = [](const auto& graph) { return dolfinx::graph::reorder_gps(graph); };
    struct Orders {
      std::string name;
      problem::Reorder cells;
      problem::Reorder unknowns;
    };
    const std::vector<Orders> orders{
        {"`reorder_gps`, its own", gps, gps},
        {"none", problem::stay, problem::stay},
        {"rcm", meshorder::dolfinx_reorder("rcm"), meshorder::dolfinx_reorder("rcm")},
        {"auto", meshorder::dolfinx_reorder(), meshorder::dolfinx_reorder()},
        {"spectral", meshorder::dolfinx_reorder("spectral"), meshorder::dolfinx_reorder("spectral")},
        {"cells spectral, unknowns as they meet", meshorder::dolfinx_reorder("spectral"), problem::stay},
        {"scrambled", meshorder::dolfinx_reorder("scrambled"), meshorder::dolfinx_reorder("scrambled")},
    };
    std::deque<problem::System> systems;
    std::vector<measuring::Case> cases;
    for (const Orders& order : orders) {
      // seconds that the orders take, summed over all calls
      double seconds = 0;
      const auto counted = [&seconds](const problem::Reorder& reorder) -> problem::Reorder {
        return [&seconds, &reorder](const auto& graph) {
          std::vector<int> map;
          seconds += measuring::processor_seconds([&] { map = reorder(graph); });
          return map;
        };
      };
      const auto mesh = problem::create_mesh(tetrahedra, counted(order.cells), counted(order.unknowns));
      const auto element =
          basix::create_element(basix::element::family::P, basix::cell::type::tetrahedron, 1);
      const auto space = std::make_shared<dolfinx::fem::FunctionSpace>(
          dolfinx::fem::create_functionspace(mesh, element, 1, counted(order.unknowns)));
      problem::System& system = systems.emplace_back(space, *form_reaction_a, *form_reaction_L);
      system.assemble();
      std::vector<double> u;
      std::array<char, 100> facts{};
      (void)std::snprintf(facts.data(), facts.size(), "%.0f | %d | %.2f s", system.mean_span(),
                          system.solve(u, 1e-8), seconds);
      cases.push_back({order.name,
                       facts.data(),
                       {[&system] { system.assemble(); },
                        [&system] {
                          std::vector<double> again;
                          system.solve(again, 1e-8);
                        }}});
    }
    measuring::measure(cases, {"assembly", "CG"}, "mean span | iterations | orders", std::stoi(argv[2]));
  }
  MPI_Finalize();
  return 0;
}
