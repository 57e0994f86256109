// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
// measure MESH BUDGET THREADS MACHINES VERTICES/ELEMENTS…: times the plain kernels in these orders and in
// those that `auto` takes for each kernel, and predicts the times. Rounds are interleaved, in two halves on
// different pages of memory. MACHINES are names separated by commas: "zen3", "this", "prior" (the costs
// assumed for this machine without a calibration), or the file of a calibration, with a slash in its path. Of
// a calibration, uses the costs of all threads if THREADS equals their number, else those of one thread; a
// colon after the path selects those of one thread. Prints mesh, vertices, order, kernel, the best
// milliseconds of each half, then the milliseconds predicted for each machine; and mesh, vertices, "auto",
// kernel, the order that `auto` takes.
//
// MESH is the name of a model, "grid-20", "dragon", or a file; with "-skin" after it, the triangles on its
// surface. judge.py calls this.
#include "io/format.hpp"
#include "lab/models/catalogue.hpp"
#include "mesh/graphs.hpp"
#include "mesh/reorder.hpp"
#include "payoff/access_stream.hpp"
#include "payoff/calibration_store.hpp"
#include "payoff/kernel_bench.hpp"
#include "payoff/kernel_timing.hpp"
#include "payoff/machine.hpp"
#include "payoff/machine_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace mo = meshorder;

namespace {

constexpr std::string_view kSkin = "-skin";

/// Returns the surface: the triangles that belong to only one tetrahedron, in the order of the tetrahedra.
/// The vertices of the surface keep their order in the mesh.
mo::Mesh skin(const mo::Mesh& mesh) {
  const auto for_each_face = [&](const auto& visit) {
    for (mo::Index cell = 0; cell < mesh.cell_count(); ++cell) {
      for (const std::vector<int>& facet :
           mo::facets(mesh.cells.shapes[cell], mesh.cells.vertex_count(cell))) {
        visit(std::array{mesh.cells[cell][facet[0]], mesh.cells[cell][facet[1]], mesh.cells[cell][facet[2]]});
      }
    }
  };
  const auto key = [](std::array<mo::Index, 3> face) {
    std::sort(face.begin(), face.end());
    return face;
  };
  std::map<std::array<mo::Index, 3>, int> uses;
  for_each_face([&](const auto& face) { ++uses[key(face)]; });
  std::vector<mo::Index> number(mesh.points.size(), -1);
  for_each_face([&](const auto& face) {
    if (uses[key(face)] > 1) return;
    for (const mo::Index v : face) number[v] = 0;
  });
  mo::Mesh result;
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] < 0) continue;
    number[v] = result.vertex_count();
    result.points.push_back(mesh.points[v]);
  }
  for_each_face([&](const auto& face) {
    if (uses[key(face)] > 1) return;
    result.cells.push_back(mo::Shape::triangle,
                           std::array{number[face[0]], number[face[1]], number[face[2]]});
  });
  return result;
}

mo::Mesh mesh_of(std::string name) {
  const bool skinned = name.ends_with(kSkin);
  if (skinned) name.resize(name.size() - kSkin.size());
  const bool file = name.find_first_of("./") != std::string::npos;
  mo::Mesh mesh = mo::read_mesh(file ? name : mo::make_model(name).path.string());
  mesh.cell_blocks.clear();
  return skinned ? skin(mesh) : mesh;
}

/// Returns the costs of a machine by its name; of a calibration, those of one thread or of all threads.
mo::CostModel machine_named(const std::string& name, int threads) {
  if (name.ends_with(':')) return machine_named(name.substr(0, name.size() - 1), 1);
  if (name.find('/') != std::string::npos) {
    std::ifstream in(name);
    const mo::Calibration calibration =
        mo::parse_calibration({std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()});
    return threads == calibration.threads ? calibration.all_threads : calibration.model;
  }
  return name == "prior" ? mo::not_calibrated().model : mo::choose_machine(name).model;
}

/// Prints the order that `auto` chooses for each kernel, and adds it to `orders` if it is not there.
void add_auto(const std::string& name, const mo::Mesh& mesh, const mo::CsrGraph& graph,
              std::vector<std::string>& orders) {
  for (const mo::Kernel kernel : mo::kKernels) {
    const auto workload = mo::parse_workload(mo::to_string(kernel));
    const mo::MeshOrder r =
        mo::compute_reordering(mesh, graph, {.methods = {}, .order = {.workload = workload}});
    const std::string order = r.vertices.method.name + "/" + r.cells.method.name;
    fmt::print("{},{},auto,{},{}\n", name, mesh.vertex_count(), mo::to_string(kernel), order);
    if (std::find(orders.begin(), orders.end(), order) == orders.end()) orders.push_back(order);
  }
}

void judge(const std::string& name, double budget, int threads, const std::string& machines,
           std::vector<std::string> orders) {
  std::vector<mo::CostModel> models;
  std::istringstream words(machines);
  for (std::string word; std::getline(words, word, ',');) models.push_back(machine_named(word, threads));
  const mo::Mesh mesh = mesh_of(name);
  const mo::CsrGraph graph = mo::vertex_graph(mesh);
  add_auto(name, mesh, graph, orders);
  std::vector<mo::Mesh> meshes;
  std::vector<mo::KernelReuse> reuse;
  std::vector<std::array<double, mo::kKernels.size()>> computed;  // see times_computed
  for (const std::string& order : orders) {
    const auto slash = order.find('/');
    meshes.push_back(mesh);
    mo::apply_reordering(
        meshes.back(),
        mo::compute_reordering(mesh, graph, {.methods = {order.substr(0, slash), order.substr(slash + 1)}}));
    const mo::Simplices simplices = mo::cut_into_simplices(meshes.back());
    const mo::CsrGraph ordered = mo::vertex_graph(meshes.back());
    reuse.push_back(mo::reuse_of_kernels(ordered, simplices, mo::halvings_for(simplices.size())));
    auto& times = computed.emplace_back();
    for (std::size_t k = 0; k < mo::kKernels.size(); ++k)
      times[k] = mo::times_computed(mo::kKernels[k], ordered, simplices, threads);
  }
  std::array<mo::Timings, 2> timings;
  for (mo::Timings& half : timings) {
    half = mo::time_orders(mo::index_size(meshes),
                           [&](mo::Index i) {
                             return mo::prepare_kernels(mo::KernelSet::plain, meshes[i],
                                                        mo::vertex_graph(meshes[i]), threads);
                           },
                           {.budget_seconds = budget / 2,
                            .min_rounds = 3,
                            .max_rounds = 200,
                            .sample_seconds = 0.005,
                            .processor_time = threads == 1});
  }
  for (std::size_t i = 0; i < orders.size(); ++i) {
    for (std::size_t k = 0; k < mo::kKernels.size(); ++k) {
      fmt::print("{},{},{},{},{:.6f},{:.6f}", name, mesh.vertex_count(), orders[i],
                 mo::to_string(mo::kKernels[k]), timings[0].orders[i][mo::kKernels[k]].best_ms,
                 timings[1].orders[i][mo::kKernels[k]].best_ms);
      for (const mo::CostModel& model : models) {
        const double times = model.threads == 1 ? 1 : computed[i][k];
        fmt::print(",{:.6f}", times * mo::predicted_ms(reuse[i][k], model.caches, model));
      }
      fmt::print("\n");
    }
  }
}

}  // namespace

int main(int argc, char** argv) try {
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (words.size() < 5) {
    fmt::print(stderr, "measure MESH BUDGET THREADS MACHINES ORDER…\n");
    return 2;
  }
  judge(words[0], std::atof(words[1].c_str()), std::atoi(words[2].c_str()), words[3],
        {words.begin() + 4, words.end()});
  return 0;
} catch (const std::exception& error) {
  fmt::print(stderr, "measure: {}\n", error.what());
  return 1;
}
