// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// The functions that the page's worker calls: they take files in memory, order a file as `meshorder order`
// does, and return what the page shows. Of the page's functions, this module calls only `tell`.
#include "base/memory.hpp"
#include "base/parallel.hpp"
#include "base/text.hpp"
#include "io/format.hpp"
#include "io/kept_cells.hpp"
#include "matrix_points.hpp"
#include "mesh/graphs.hpp"
#include "mesh/simplices.hpp"
#include "mesh/stored_matrix.hpp"
#include "metrics/edge_span.hpp"
#include "order_report.hpp"
#include "wording.hpp"
#include <meshorder/error.hpp>
#include <meshorder/io.hpp>

#include <emscripten.h>
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <new>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

// NOLINTNEXTLINE: JavaScript
EM_JS(void, tell, (const char* stage, double share), {
  if (Module["tell"]) Module["tell"](UTF8ToString(stage), share);
});

namespace meshorder {
namespace {

constexpr std::uint64_t kMostMemory = std::uint64_t{4} << 30;  // a page has 32-bit addresses
const tbb::global_control kOneThread(tbb::global_control::max_allowed_parallelism, 1);

/// The files that the page gave, and those that were written.
class GivenFiles : public FileStore {
 public:
  [[nodiscard]] bool has(const std::filesystem::path& path) const override {
    return files_.find(path.string()) != files_.end();
  }
  [[nodiscard]] std::string read(const std::filesystem::path& path) const override {
    const auto found = files_.find(path.string());
    return found == files_.end() ? std::string() : found->second;
  }
  void write(const std::filesystem::path& path, std::string bytes) override {
    files_[path.string()] = std::move(bytes);
  }

  /// Makes a file of zeros of that size; returns its bytes, to be filled.
  char* make(const char* name, std::size_t size) {
    std::string& bytes = files_[name];
    bytes.assign(size, '\0');
    return bytes.data();
  }
  [[nodiscard]] std::map<std::string, std::string> take() { return std::exchange(files_, {}); }

 private:
  std::map<std::string, std::string> files_;
};

/// A named part of the result: a text, or an array of numbers.
struct Part {
  std::string name;
  std::variant<std::string, std::vector<float>, std::vector<std::uint32_t>, std::vector<double>> values;
};

// NOLINTBEGIN(cppcoreguidelines-avoid-non-const-global-variables): between calls of the page
GivenFiles files;
std::vector<Part> parts;
// NOLINTEND(cppcoreguidelines-avoid-non-const-global-variables)

/// Adds the parts "places" (of the surface's vertices) and "triangles". Returns the surface's vertices; none
/// if the mesh has no surface. `mesh` is not yet ordered.
std::vector<Index> add_surface(const Mesh& mesh) {
  std::vector<std::array<Index, 3>> triangles;
  try {
    triangles = boundary_triangles(mesh);
  } catch (const InputError&) {
    return {};
  }
  constexpr Index kUnseen = -1;
  std::vector<Index> place_of(mesh.points.size(), kUnseen);
  std::vector<Index> vertices;
  std::vector<std::uint32_t> corners;
  corners.reserve(3 * triangles.size());
  for (const auto& triangle : triangles) {
    for (const Index v : triangle) {
      if (place_of[v] == kUnseen) {
        place_of[v] = static_cast<Index>(vertices.size());
        vertices.push_back(v);
      }
      corners.push_back(static_cast<std::uint32_t>(place_of[v]));
    }
  }
  std::vector<float> places;
  places.reserve(3 * vertices.size());
  const auto origin = mesh.points[vertices.empty() ? 0 : vertices.front()];  // floats are finest near 0
  for (const Index v : vertices) {
    for (std::size_t k = 0; k < 3; ++k) places.push_back(static_cast<float>(mesh.points[v][k] - origin[k]));
  }
  parts.push_back({"places", std::move(places)});
  parts.push_back({"triangles", std::move(corners)});
  return vertices;
}

void add_ranks(const char* name, const std::vector<Index>& vertices, const Permutation& order) {
  std::vector<std::uint32_t> ranks;
  ranks.reserve(vertices.size());
  for (const Index v : vertices) ranks.push_back(static_cast<std::uint32_t>(order.old_to_new()[v]));
  parts.push_back({name, std::move(ranks)});
}

/// Orders the file `input` into `output`. The steps are those of `Ordering` in apps/meshorder/order.cpp.
void order(const std::string& input, const std::string& output, const MeshMethods& methods) {
  Notes notes;
  (void)output_format_of(output);  // fail before the work
  tell("reading", 0);
  Mesh mesh = read_mesh_from({input, files}, {.notes = &notes});
  (void)files.take();
  const Format& format = output_format_of(output, mesh.format);
  keep_cells_at(mesh, cells_to_write(mesh, {output, files}, format, false, notes), notes);
  command::require_points(mesh, input, methods.vertices, methods.elements);
  tell("graph", 0.3);
  const CsrGraph graph = vertex_graph(mesh);
  const std::vector<Index> vertices = add_surface(mesh);
  const std::string cells = command::cells_in_words(mesh);

  ReorderOptions options{.methods = methods, .format = format.key()};
  options.order.run.progress = [](const Progress& now) {
    tell(std::string(now.stage).c_str(), 0.4 + 0.3 * std::max(now.fraction, 0.0));
    return true;
  };
  const std::optional<Permutation> arranged = arrange_cells(mesh, format);
  MeshOrder made = in_call(options.order.run, [&] { return compute_order_in_file(mesh, graph, options); });
  const Permutation& of_vertices = made.vertices.permutation;
  const Permutation as_is = Permutation::identity(mesh.vertex_count());
  const command::SpanChange spans{quick_edge_span(graph, {}),
                                  quick_edge_span(graph, of_vertices.old_to_new())};
  command::note_no_better(graph, options, of_vertices, notes);
  made.cells.permutation =
      move_in_file(mesh, of_vertices, std::move(made.cells.permutation), &format, arranged, options.ids);
  command::note_no_better(mesh, options, made.cells.permutation, notes);
  command::note_convergence(made.vertices.fiedler, "the vertices", notes);
  command::note_convergence(made.cells.fiedler, "the elements", notes);
  add_ranks("before", vertices, as_is);
  add_ranks("after", vertices, of_vertices);

  tell("writing", 0.7);
  write_arranged(mesh, {output, files}, {.notes = &notes}, format);
  for (auto& [name, bytes] : files.take()) parts.push_back({"file:" + name, std::move(bytes)});

  std::vector<std::string> lines = command::lines_of_order(made, {}, spans, stored_matrix(mesh));
  if (command::has_new_numbers(mesh, made, format, options.ids))
    lines.push_back(fmt::format("{:<10} {}", "numbers", "new for vertices and cells"));
  parts.push_back({"lines", join(
                                lines, [](const std::string& line) { return visible(line); }, "\n")});
  parts.push_back({"notes", join(
                                command::grouped_by_name(notes),
                                [](const std::string& note) { return visible(note); }, "\n")});
  parts.push_back({"cells", cells});
  parts.push_back({"spans", std::vector<double>{spans.before.mean, spans.after.mean}});
  parts.push_back({"counts", std::vector<double>{double(mesh.vertex_count()), double(mesh.cell_count())}});
}

}  // namespace
}  // namespace meshorder

using namespace meshorder;  // NOLINT(google-build-using-namespace): of the functions below

extern "C" {

/// Makes a file of that size and returns its bytes, for the page to fill; null if memory does not suffice.
EMSCRIPTEN_KEEPALIVE char* give_file(const char* name, std::size_t size) {
  try {
    return files.make(name, size);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}

/// Orders the file `input` and keeps the result as parts; if that fails, the part "error" is the only one.
/// The names of methods are those of the command.
EMSCRIPTEN_KEEPALIVE void order_file(const char* input, const char* output, const char* vertices,
                                     const char* elements) {
  parts.clear();
  set_memory_limit(kMostMemory / 4 * 3);
  std::string error;
  try {
    order(input, output, {.vertices = vertices, .elements = elements});
  } catch (const std::bad_alloc&) {
    error =
        "this mesh needs more than the 4 GiB of memory that a page may have; the command meshorder orders it";
  } catch (const std::exception& failure) {
    error = failure.what();
  }
  (void)files.take();
  if (!error.empty()) {
    parts.clear();
    parts.push_back({"error", visible(error)});
  }
}

EMSCRIPTEN_KEEPALIVE int part_count() { return static_cast<int>(parts.size()); }
EMSCRIPTEN_KEEPALIVE const char* part_name(int part) {
  return parts[static_cast<std::size_t>(part)].name.c_str();
}
EMSCRIPTEN_KEEPALIVE const void* part_data(int part) {
  return std::visit([](const auto& values) -> const void* { return values.data(); },
                    parts[static_cast<std::size_t>(part)].values);
}
/// Returns the size of a part in bytes.
EMSCRIPTEN_KEEPALIVE std::size_t part_size(int part) {
  return std::visit([](const auto& values) { return values.size() * sizeof(values[0]); },
                    parts[static_cast<std::size_t>(part)].values);
}
}
