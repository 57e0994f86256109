// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/parallel.hpp"
#include "base/stopwatch.hpp"
#include "mesh/graphs.hpp"
#include "mesh/stored_matrix.hpp"
#include "ordering/method.hpp"
#include "payoff/advice.hpp"
#include "payoff/calibration_store.hpp"
#include "payoff/kernel_bench.hpp"
#include <meshorder/error.hpp>

#include <string>
#include <utility>
#include <vector>

namespace meshorder {
inline namespace v0_3 {
namespace {

/// Throws InvalidArgument unless the mesh has cells that the kernels can use.
void check_kernels_run(const Mesh& mesh) {
  if (CellSimplices(mesh).size() > 0) return;
  throw InvalidArgument(stored_matrix(mesh) != nullptr
                            ? "advise: the matrix has no entries off the diagonal"
                            : "advise: the mesh has no lines, surfaces or volumes, which the kernels need");
}

/// Throws InvalidArgument if a method needs coordinates and the mesh is a matrix without them.
void check_places(const Mesh& mesh, const std::vector<MeshMethods>& methods) {
  if (stored_matrix(mesh) == nullptr || has_places(mesh)) return;
  for (const MeshMethods& method : methods) {
    if (needs_points(vertex_methods(), method.vertices) || needs_points(element_methods(), method.elements))
      throw InvalidArgument("advise: " + method.vertices + "/" + method.elements +
                            " needs coordinates, and the matrix has none");
  }
}

/// Advises on the mesh that `make` returns.
template <class Make>
Advice advise_on(const PayoffOptions& options, const Make& make) {
  return in_call(options.order.run, [&] {
    if (!(options.budget_seconds >= 0)) {
      throw InvalidArgument("advise: the budget is " + std::to_string(options.budget_seconds) +
                            " s, must be 0 or more");
    }
    if (options.predict && options.kernels != KernelSet::plain) {
      throw InvalidArgument("advise: tuned kernels are not predicted; measure them");
    }
    if (options.order.workload == Workload::gpu) {
      throw InvalidArgument(
          "workload gpu: the kernels run on this machine's processor; gpu_cost and gpu_product_cost count "
          "the cost of an order on a graphics processor");
    }
    const int threads = options.all_threads ? thread_count() : 1;
    const MachineChoice machine = choose_machine(options.machine, options.all_threads && options.predict);
    if (options.predict && machine.model.threads != threads) {
      throw InvalidArgument(
          "advise: the cost of misses on all threads is not known; calibrate() measures it on this machine");
    }
    report("check");
    const auto& mesh = make();
    if (options.order.check != Check::none) check_mesh(mesh);
    check_kernels_run(mesh);
    check_places(mesh, options.methods);
    report("graph");
    const Stopwatch stopwatch;
    const CsrGraph graph = vertex_graph(mesh);
    AdviceOptions inside{.methods = options.methods,
                         .machine = machine,
                         .kernels = options.kernels,
                         .threads = threads,
                         .ordering = options.order,
                         .graph_seconds = stopwatch.seconds(),
                         .predict = options.predict};
    if (options.measure) inside.measure_within = options.budget_seconds;
    return advise(mesh, graph, inside);
  });
}

std::vector<Candidate> all_of(Advice advice) {
  std::vector<Candidate> candidates;
  candidates.reserve(1 + advice.candidates.size());
  candidates.push_back(std::move(advice.as_is));
  for (Candidate& candidate : advice.candidates) candidates.push_back(std::move(candidate));
  return candidates;
}

}  // namespace

Advice advise(const MeshView& mesh, const PayoffOptions& options) {
  return advise_on(options, [&] { return make_mesh(mesh); });
}

Advice advise(const GraphView& matrix, const PayoffOptions& options) {
  return advise_on(options, [&] { return matrix_mesh(matrix); });
}

Advice advise(const Mesh& mesh, const PayoffOptions& options) {
  return advise_on(options, [&]() -> const Mesh& { return mesh; });
}

std::vector<Candidate> compare(const MeshView& mesh, const PayoffOptions& options) {
  return all_of(advise(mesh, options));
}

std::vector<Candidate> compare(const GraphView& matrix, const PayoffOptions& options) {
  return all_of(advise(matrix, options));
}

std::vector<Candidate> compare(const Mesh& mesh, const PayoffOptions& options) {
  return all_of(advise(mesh, options));
}

CalibrationReport calibrate(const CalibrationOptions& options) {
  return in_call(options.run, [&] {
    if (!(options.seconds > 0)) {
      throw InvalidArgument("calibrate: " + std::to_string(options.seconds) + " s, must be more than 0");
    }
    const Calibration calibration = measure_machine(effort_of(options.seconds));
    CalibrationReport result{.machine = chosen(calibration).in_words(),
                             .json = to_json_text(calibration),
                             .file = {},
                             .doubt = reason_to_doubt(calibration.steadiness)};
    if (options.keep) result.file = save_calibration(calibration).string();
    return result;
  });
}

}  // namespace v0_3
}  // namespace meshorder
