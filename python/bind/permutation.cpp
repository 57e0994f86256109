// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "arrays.hpp"
#include "module.hpp"
#include "options.hpp"
#include <meshorder/error.hpp>
#include <meshorder/permutation.hpp>

#include <nanobind/operators.h>

#include <cstddef>
#include <span>

namespace meshorder::python {
namespace {

/// Returns a view of one direction of a permutation. The view keeps the permutation alive.
Result<Index> direction(nb::handle self, std::span<const Index> map) {
  return Result<Index>(map.data(), {map.size()}, self);
}

void move_rows(const Permutation& permutation, const Array& from, const MutableArray& to) {
  const std::size_t bytes = from.size() * from.itemsize();
  if (from.ndim() == 0 || from.shape(0) != static_cast<std::size_t>(permutation.size()) ||
      to.size() * to.itemsize() != bytes) {
    throw InvalidArgument("move: expected " + std::to_string(permutation.size()) +
                          " rows, and as many in out");
  }
  const std::size_t row = permutation.size() == 0 ? 0 : bytes / static_cast<std::size_t>(permutation.size());
  unlocked([&] {
    permutation.move(std::span(static_cast<const std::byte*>(from.data()), bytes),
                     std::span(static_cast<std::byte*>(to.data()), bytes), row);
  });
}

void move_matrix(const Permutation& permutation, const Array& offsets, const Array& columns,
                 const Array& values, const MutableArray& new_offsets, const MutableArray& new_columns,
                 const MutableArray& new_values) {
  const GraphView matrix{.offsets = index_view(offsets), .neighbours = index_view(columns)};
  const IndexSpan offsets_out = index_span(new_offsets);
  const IndexSpan columns_out = index_span(new_columns);
  unlocked([&] {
    permutation.move_csr(
        matrix, std::span(static_cast<const std::byte*>(values.data()), values.size() * values.itemsize()),
        offsets_out, columns_out,
        std::span(static_cast<std::byte*>(new_values.data()), new_values.size() * new_values.itemsize()));
  });
}

}  // namespace

void add_permutation(nb::module_& module) {
  nb::class_<Permutation>(module, "Permutation")
      .def_static("from_old_to_new",
                  [](const Array& map) {
                    const IndexView view = index_view(map);
                    return unlocked([&] { return Permutation::from_old_to_new(view); });
                  })
      .def_static("from_new_to_old",
                  [](const Array& map) {
                    const IndexView view = index_view(map);
                    return unlocked([&] { return Permutation::from_new_to_old(view); });
                  })
      .def_prop_ro("old_to_new",
                   [](nb::handle_t<Permutation> self) {
                     return direction(self, nb::cast<const Permutation&>(self).old_to_new());
                   })
      .def_prop_ro("new_to_old",
                   [](nb::handle_t<Permutation> self) {
                     return direction(self, nb::cast<const Permutation&>(self).new_to_old());
                   })
      .def("__len__", &Permutation::size)
      .def(nb::self == nb::self, nb::sig("def __eq__(self, other: object, /) -> bool"))
      .def("inverse", [](const Permutation& self) { return self.inverse(); })
      .def("then", &Permutation::then)
      .def("repeated", &Permutation::repeated)
      .def("move_rows", &move_rows)
      .def("move_matrix", &move_matrix)
      .def("renumber", [](const Permutation& self, const MutableArray& numbers, int base) {
        const IndexSpan span = index_span(numbers);
        unlocked([&] { self.renumber(span, base); });
      });
}

}  // namespace meshorder::python
