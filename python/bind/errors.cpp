// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "module.hpp"
#include <meshorder/error.hpp>

#include <array>

namespace meshorder::python {
namespace {

namespace nb = nanobind;

/// Name of Python's class for each `Code`, in the module `meshorder._errors`.
constexpr std::array kClasses{"Error",       "InvalidArgument", "InputError", "TooLarge",
                              "Unavailable", "Stopped",         "Error",      "InternalError"};

/// Sets Python's error to the one that corresponds to the library's exception.
void translate(const std::exception_ptr& thrown, void* /*unused*/) {
  try {
    std::rethrow_exception(thrown);
  } catch (const Error& error) {
    const nb::object kind =
        nb::module_::import_("meshorder._errors").attr(kClasses[static_cast<std::size_t>(error.code())]);
    nb::object value = kind(text(error.what()));
    if (const auto* input = dynamic_cast<const InputError*>(&error)) {
      const Location& location = input->location();
      value.attr("file") = text(location.file);
      if (location.line > 0) value.attr("line") = nb::int_(location.line);
      if (location.byte >= 0) value.attr("byte") = nb::int_(location.byte);
    }
    PyErr_SetObject(kind.ptr(), value.ptr());
  }
}

}  // namespace

nb::str text(std::string_view bytes) {
  return nb::steal<nb::str>(
      PyUnicode_DecodeUTF8(bytes.data(), static_cast<Py_ssize_t>(bytes.size()), "backslashreplace"));
}

nb::list texts(const std::vector<std::string>& list) {
  nb::list result;
  for (const std::string& entry : list) result.append(text(entry));
  return result;
}

void add_errors(nb::module_& /*module*/) { nb::register_exception_translator(translate); }

}  // namespace meshorder::python
