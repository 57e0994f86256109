// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Bindings for orders of meshes that are given as arrays, and for meshes of files.
#include "cells.hpp"
#include "mesh/simplices.hpp"
#include "mesh/stored_matrix.hpp"
#include "module.hpp"
#include "options.hpp"
#include "payoff/kernel_bench.hpp"
#include "results.hpp"
#include <meshorder/error.hpp>
#include <meshorder/io.hpp>
#include <meshorder/mesh.hpp>
#include <meshorder/payoff.hpp>

#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/variant.h>
#include <nanobind/stl/vector.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <tuple>
#include <type_traits>
#include <variant>
#include <vector>

namespace meshorder::python {
namespace {

using python::described;

nb::tuple described(MeshOrder order) {
  return nb::make_tuple(described(std::move(order.vertices)), described(std::move(order.cells)));
}

nb::tuple order_of_mesh(const GivenPoints& points, const GivenCells& cells, std::size_t vertex_count,
                        const MeshMethods& methods, const nb::dict& options) {
  const Options given_options(options);
  const MeshView mesh = mesh_view(points, cells, vertex_count);
  return described(unlocked([&] { return order_mesh(mesh, methods, given_options.order()); }));
}

nb::object milliseconds(std::span<const Kernel> kernels, const std::optional<KernelMilliseconds>& times) {
  if (!times) return nb::none();
  nb::dict result;
  for (const Kernel kernel : kernels) {
    result[text(to_string(kernel))] = (*times)[static_cast<std::size_t>(kernel)];
  }
  return result;
}

nb::dict described(const Candidate& candidate, std::span<const Kernel> kernels) {
  nb::dict result;
  result["vertices"] = candidate.vertices.name;
  result["elements"] = candidate.elements.name;
  result["reason"] = candidate.vertices.reason;
  result["workload"] = std::string(to_string(candidate.workload));
  result["spans"] = described(candidate.spans);
  result["pattern"] = described(candidate.pattern);
  result["predicted"] = milliseconds(kernels, candidate.costs.predicted);
  result["measured"] = milliseconds(kernels, candidate.costs.measured);
  result["order_seconds"] = candidate.order_seconds;
  return result;
}

using MethodPairs = std::vector<std::pair<std::string, std::string>>;

PayoffOptions payoff_options(const MethodPairs& methods, bool predict, bool measure,
                             const std::string& kernels, double budget, const std::string& machine,
                             bool all_threads, const OrderOptions& order) {
  PayoffOptions options{.predict = predict,
                        .machine = machine,
                        .measure = measure,
                        .kernels = parse_kernels(kernels),
                        .all_threads = all_threads,
                        .budget_seconds = budget,
                        .order = order};
  for (const auto& [vertices, elements] : methods) options.methods.push_back({vertices, elements});
  return options;
}

nb::tuple advise_mesh(const Mesh& mesh, const PayoffOptions& options) {
  const Advice advice = unlocked([&] { return advise(mesh, options); });
  const std::span<const Kernel> kernels = kernels_of(mesh);
  nb::list candidates;
  for (const Candidate& candidate : advice.candidates) candidates.append(described(candidate, kernels));
  nb::dict best_of;
  for (const Kernel kernel : kernels) {
    const KernelAdvice& best = advice.kernels[static_cast<std::size_t>(kernel)];
    best_of[text(to_string(kernel))] =
        nb::make_tuple(best.candidate, best.gain.ratio, best.gain.low, best.gain.high, best.runs_to_pay);
  }
  return nb::make_tuple(to_string(advice), described(advice.as_is, kernels), candidates, best_of,
                        advice.doubt, advice.machine, advice.threads);
}

nb::list compare_mesh(const Mesh& mesh, const PayoffOptions& options) {
  nb::list list;
  for (const Candidate& candidate : unlocked([&] { return compare(mesh, options); }))
    list.append(described(candidate, kernels_of(mesh)));
  return list;
}

nb::tuple calibrated(double seconds, bool keep, const nb::dict& options) {
  const Options given_options(options);
  const CalibrationReport report =
      unlocked([&] { return calibrate({.seconds = seconds, .keep = keep, .run = given_options.run()}); });
  return nb::make_tuple(report.machine, report.json, report.file, report.doubt);
}

/// Returns a method of Mesh that converts Python's arguments to options and calls `question`, which is
/// advise_mesh or compare_mesh.
template <class Answer>
auto answering(Answer (*question)(const Mesh&, const PayoffOptions&)) {
  return [question](const Mesh& self, const MethodPairs& methods, bool predict, bool measure,
                    const std::string& kernels, double budget, const std::string& machine, bool all_threads,
                    const nb::dict& options) {
    const Options given_options(options);
    return question(self, payoff_options(methods, predict, measure, kernels, budget, machine, all_threads,
                                         given_options.order()));
  };
}

/// Returns the corners of the surface, three for each triangle.
Result<Index> surface_of(const Mesh& mesh) {
  return given(unlocked([&] {
    std::vector<Index> corners;
    for (const auto& triangle : boundary_triangles(mesh)) {
      corners.insert(corners.end(), triangle.begin(), triangle.end());
    }
    return corners;
  }));
}

/// Returns a view of an array of a mesh. The view keeps the mesh alive.
template <class T>
Result<T> viewed(nb::handle mesh, const std::vector<T>& values) {
  return Result<T>(values.data(), {values.size()}, mesh);
}

nb::object values_of(nb::handle mesh, const DataArray& array) {
  return std::visit(
      [&]<class T>(const std::vector<T>& values) -> nb::object {
        if constexpr (std::is_same_v<T, std::string>) {
          return texts(values);
        } else {
          const auto width = static_cast<std::size_t>(array.components);
          if (width == 1) return nb::cast(viewed(mesh, values));
          return nb::cast(nb::ndarray<nb::numpy, const T, nb::ndim<2>>(values.data(),
                                                                       {values.size() / width, width}, mesh));
        }
      },
      array.values);
}

/// Copies a Python array of rank 1 or 2 into a new array for a mesh. Throws InvalidArgument unless the Python
/// array holds real numbers.
DataArray array_of(const std::string& name, bool of_vertices, const Array& values) {
  DataArray array{.name = name,
                  .association = of_vertices ? Association::vertices : Association::cells,
                  .components = values.ndim() == 2 ? static_cast<Index>(values.shape(1)) : 1};
  const auto take = [&]<class... Numbers>(std::variant<std::vector<Numbers>...>*) {
    const auto try_type = [&]<class Number>(Number) {
      if constexpr (std::is_arithmetic_v<Number>) {
        if (values.dtype() != nb::dtype<Number>()) return false;
        const auto* const first = static_cast<const Number*>(values.data());
        array.values = std::vector<Number>(first, first + values.size());
        return true;
      }
      return false;
    };
    return (try_type(Numbers{}) || ...);
  };
  if (!take(static_cast<Values*>(nullptr))) {
    throw InvalidArgument("array '" + name + "': expected real numbers");
  }
  return array;
}

EntitySet set_of(const std::string& name, bool of_vertices, const Array& members) {
  EntitySet set{.name = name, .association = of_vertices ? Association::vertices : Association::cells};
  const IndexView view = index_view(members);
  set.members.reserve(view.size());
  for (std::size_t i = 0; i < view.size(); ++i) {
    set.members.push_back(std::in_range<Index>(view[i]) ? static_cast<Index>(view[i]) : Index{-1});
  }
  return set;
}

/// Adds the properties of the class. Their arrays are views of the mesh's memory.
void add_properties(nb::class_<Mesh>& mesh) {
  using Self = nb::handle_t<Mesh>;
  const auto of = [](Self self) -> const Mesh& { return nb::cast<const Mesh&>(self); };
  mesh.def_prop_ro("points",
                   [of](Self self) {
                     const std::vector<Point>& points = of(self).points;
                     return nb::ndarray<nb::numpy, const double, nb::shape<-1, 3>>(
                         points.empty() ? nullptr : points.front().data(), {points.size(), 3}, self);
                   })
      .def_prop_ro("dimension", [of](Self self) { return of(self).dimension; })
      .def_prop_ro("format", [of](Self self) { return of(self).format; })
      .def_prop_ro("offsets", [of](Self self) { return viewed(self, of(self).cells.offsets); })
      .def_prop_ro("connectivity", [of](Self self) { return viewed(self, of(self).cells.vertices); })
      .def_prop_ro("shapes",
                   [of](Self self) {
                     const std::vector<Shape>& shapes = of(self).cells.shapes;
                     return Result<std::uint8_t>(reinterpret_cast<const std::uint8_t*>(shapes.data()),
                                                 {shapes.size()}, self);
                   })
      .def_prop_ro("vertex_ids", [of](Self self) { return viewed(self, of(self).vertex_ids); })
      .def_prop_ro("cell_ids", [of](Self self) { return viewed(self, of(self).cell_ids); })
      .def_prop_ro(
          "data",
          [of](Self self) {
            nb::list list;
            for (const DataArray& array : of(self).data) {
              list.append(nb::make_tuple(text(array.name), array.association == Association::vertices,
                                         values_of(self, array), viewed(self, array.indices)));
            }
            return list;
          })
      .def_prop_ro("sets",
                   [of](Self self) {
                     nb::list list;
                     for (const EntitySet& set : of(self).sets) {
                       list.append(nb::make_tuple(text(set.name), set.association == Association::vertices,
                                                  viewed(self, set.members)));
                     }
                     return list;
                   })
      .def_prop_ro("block_starts", [of](Self self) { return viewed(self, of(self).cell_blocks); })
      .def_prop_ro("format_contents", [](const Mesh& self) {
        return texts(self.format_metadata ? self.format_metadata->contents() : std::vector<std::string>());
      });
}

void add_methods(nb::class_<Mesh>& mesh) {
  mesh.def("add_data", [](Mesh& self, const std::string& name, bool of_vertices,
                          const Array& values) { self.data.push_back(array_of(name, of_vertices, values)); })
      .def("add_set", [](Mesh& self, const std::string& name, bool of_vertices,
                         const Array& members) { self.sets.push_back(set_of(name, of_vertices, members)); })
      .def("check", [](const Mesh& self) { check_mesh(self); })
      .def("surface", &surface_of)
      .def("graph",
           [](const Mesh& self) {
             const Graph graph = unlocked([&] { return vertex_graph(view(self).cells, self.points.size()); });
             return nb::make_tuple(given(std::vector(graph.offsets().begin(), graph.offsets().end())),
                                   given(std::vector(graph.neighbours().begin(), graph.neighbours().end())));
           })
      .def("copy", [](const Mesh& self) { return Mesh(self); })
      .def("reorder",
           [](Mesh& self, const std::string& vertices, const std::string& elements, const std::string& ids,
              const std::string& group_by, const std::string& format, const nb::dict& options) {
             const Options given_options(options);
             ReorderOptions wanted{.methods = {vertices, elements},
                                   .group_by = group_by,
                                   .format = format,
                                   .order = given_options.order()};
             if (ids == "keep")
               wanted.ids = Ids::keep;
             else if (ids == "attach")
               wanted.ids = Ids::attach;
             else if (ids != "renumber")
               throw InvalidArgument("ids: expected 'renumber', 'keep' or 'attach', not '" + ids + "'");
             return described(unlocked([&] { return reorder(self, wanted); }));
           })
      .def("advise", answering(advise_mesh))
      .def("compare", answering(compare_mesh))
      .def("write",
           [](const Mesh& self, const std::filesystem::path& path) {
             Notes notes;
             (void)unlocked([&] { return write_mesh(self, path, &notes); });
             return texts(notes);
           })
      .def("to_bytes", [](const Mesh& self, const std::string& format, const std::string& name) {
        MemoryFiles files = unlocked([&] { return write_mesh_to_memory(self, format, name); });
        if (files.files.size() != 1) {
          throw InvalidArgument("to_bytes: " + format + " takes several files; use write");
        }
        return nb::bytes(files.files.front().bytes.data(), files.files.front().bytes.size());
      });
}

}  // namespace

void add_meshes(nb::module_& module) {
  nb::list shapes;
  nb::list dimensions;
  for (int s = 0; s < kShapes; ++s) {
    shapes.append(text(to_string(static_cast<Shape>(s))));
    dimensions.append(dimension(static_cast<Shape>(s)));
  }
  module.def("calibrate", &calibrated);
  module.attr("shapes") = nb::tuple(shapes);
  module.attr("dimensions") = nb::tuple(dimensions);
  nb::class_<Mesh> class_of_meshes(module, "Mesh");
  add_properties(class_of_meshes);
  add_methods(class_of_meshes);
  module.def(
      "order_mesh",
      [](const GivenPoints& points, const GivenCells& cells, std::size_t vertex_count,
         const std::string& vertices, const std::string& elements, const nb::dict& options) {
        return order_of_mesh(points, cells, vertex_count, {vertices, elements}, options);
      },
      nb::arg().none(), nb::arg(), nb::arg(), nb::arg(), nb::arg(), nb::arg());
  module.def("matrix_mesh", [](const Array& offsets, const Array& columns) {
    const GraphView matrix{.offsets = index_view(offsets), .neighbours = index_view(columns)};
    return unlocked([&] { return matrix_mesh(matrix); });
  });
  module.def("make_mesh", [](const GivenPoints& points, const GivenCells& cells) {
    const MeshView view = mesh_view(points, cells, 0);
    return unlocked([&] { return make_mesh(view); });
  });
  module.def(
      "read",
      [](const std::filesystem::path& path, const std::string& format,
         std::optional<std::uint64_t> memory_limit, std::vector<std::filesystem::path> include_folders) {
        Notes notes;
        const ReadOptions options{.format = format,
                                  .notes = &notes,
                                  .memory_limit = memory_limit,
                                  .include_folders = std::move(include_folders)};
        Mesh mesh = unlocked([&] { return read_mesh(path, options); });
        return nb::make_tuple(nb::cast(std::move(mesh)), texts(notes));
      },
      nb::arg(), nb::arg(), nb::arg().none(), nb::arg());
  module.def(
      "read_bytes",
      [](const nb::bytes& bytes, const std::string& format, std::optional<std::uint64_t> memory_limit) {
        Notes notes;
        const std::span data(static_cast<const std::byte*>(bytes.data()), bytes.size());
        const ReadOptions options{
            .format = format, .name = "bytes", .notes = &notes, .memory_limit = memory_limit};
        Mesh mesh = unlocked([&] { return read_mesh(data, options); });
        return nb::make_tuple(nb::cast(std::move(mesh)), texts(notes));
      },
      nb::arg(), nb::arg(), nb::arg().none());
  module.def("formats", [] {
    nb::list list;
    for (const FormatInfo& format : formats())
      list.append(nb::make_tuple(format.name, format.extensions, format.single_file));
    return list;
  });
}

}  // namespace meshorder::python
