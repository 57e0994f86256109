// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "options.hpp"

#include <meshorder/error.hpp>

#include <nanobind/stl/string.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <string>
#include <string_view>
#include <thread>

namespace meshorder::python {
namespace {

std::atomic<int> running_calls = 0;
std::atomic<bool> interpreter_ends = false;
std::thread::id ending_thread;  // set before `interpreter_ends`

/// Makes the calling thread sleep until the process ends.
[[noreturn]] void sleep_for_ever() {
  while (true) std::this_thread::sleep_for(std::chrono::hours(1));
}

/// Returns whether an object is Python's or NumPy's False; the latter results from comparing NumPy's numbers.
bool is_false(const nb::object& answer) {
  const std::string_view type = Py_TYPE(answer.ptr())->tp_name;  // numpy.bool_ before NumPy 2
  return answer.is(Py_False) ||
         ((type == "numpy.bool" || type == "numpy.bool_") && !nb::cast<bool>(answer.attr("item")()));
}

/// Returns a progress function that calls the given Python function, unless it is None, and handles signals:
/// Ctrl-C ends the call with KeyboardInterrupt. Only the result False stops the call; None does not. The
/// library may copy the progress function while Python is unlocked: the copies share one reference to the
/// Python function, which the options hold to the end.
std::function<bool(const Progress&)> reporter(const nb::object& given) {
  return [shared = std::make_shared<const nb::object>(given)](const Progress& progress) {
    if (interpreter_ends) return false;
    const nb::gil_scoped_acquire lock;
    if (PyErr_CheckSignals() != 0) throw nb::python_error();
    const nb::object& function = *shared;
    if (function.is_none()) return true;
    const nb::object answer =
        function(nb::str(progress.stage.data(), progress.stage.size()), progress.fraction);
    return !is_false(answer);
  };
}

Check parse_check(const std::string& name) {
  if (name == "full") return Check::full;
  if (name == "fast") return Check::fast;
  if (name == "none") return Check::none;
  throw InvalidArgument("check: expected 'full', 'fast' or 'none', not '" + name + "'");
}

}  // namespace

Options::Options(const nb::dict& given) {
  const auto value = [&](const char* name) { return given.get(name, nb::none()); };
  const auto take = [&]<class T>(const char* name, T& into) {
    if (const nb::object object = value(name); !object.is_none()) into = nb::cast<T>(object);
  };
  const auto view = [&](const char* name, auto& into, auto viewed) {
    const nb::object object = value(name);
    if (object.is_none()) return;
    arrays_.push_back(nb::cast<Array>(object));
    into = viewed(arrays_.back());
  };
  take("seed", order_.seed);
  take("tolerance", order_.tolerance);
  take("max_iterations", order_.max_iterations);
  take("threads", order_.run.threads);
  take("time_limit", order_.run.time_limit);
  if (const nb::object name = value("workload"); !name.is_none()) {
    order_.workload = parse_workload(nb::cast<std::string>(name));
  }
  if (const nb::object name = value("check"); !name.is_none()) {
    order_.check = parse_check(nb::cast<std::string>(name));
  }
  if (const nb::object mirror = value("mirror"); mirror.is(Py_True)) order_.symmetry = Symmetry::mirror;
  view("start", order_.start, real_view);
  view("groups", order_.groups, index_view);
  view("cell_groups", order_.cell_groups, index_view);
  order_.run.progress = reporter(value("progress"));
}

UnlockedCall::UnlockedCall() {
  if (interpreter_ends) {
    if (std::this_thread::get_id() == ending_thread) throw Stopped("the interpreter ends");
    const nb::gil_scoped_release release;
    sleep_for_ever();
  }
  ++running_calls;
  release_.emplace();
}

UnlockedCall::~UnlockedCall() {
  if (interpreter_ends) {
    --running_calls;
    sleep_for_ever();
  }
  release_.reset();
  --running_calls;
}

void wait_for_calls() {
  ending_thread = std::this_thread::get_id();
  interpreter_ends = true;
  const nb::gil_scoped_release release;
  while (running_calls > 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

void forget_calls() { running_calls = 0; }

}  // namespace meshorder::python
