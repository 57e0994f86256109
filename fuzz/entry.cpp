// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// The functions that a fuzzing engine calls. One program serves all families; its copy for a family has a
// name that ends in the family's. "_whole_" before the family's name means that mutations do not damage files
// that a library reads.
#include "fuzz/engine.hpp"
#include "fuzz/family.hpp"

#include <tbb/global_control.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <string>
#include <utility>

// defined by the leak checker, if it is built in
extern "C" __attribute__((weak)) void __lsan_disable();  // NOLINT
extern "C" __attribute__((weak)) void __lsan_enable();   // NOLINT

namespace meshorder::fuzz {
namespace {

// NOLINTBEGIN(cppcoreguidelines-avoid-non-const-global-variables): the engine's functions have no context
const Family* chosen = nullptr;
bool keeps_files_whole = false;
// NOLINTEND(cppcoreguidelines-avoid-non-const-global-variables)

void choose_family(const std::filesystem::path& program) {
  const std::string name = program.filename().string();
  const auto names_it = [&](const Family& family) { return name.ends_with("_" + std::string(family.name)); };
  const auto found = std::find_if(families().begin(), families().end(), names_it);
  if (found == families().end()) fail(name + ": no family has the name behind the last '_'");
  chosen = &*found;
  keeps_files_whole = chosen->by_library && name.ends_with("_whole_" + std::string(chosen->name));
}

/// Returns an input changed with knowledge of its structure. Leaks of libraries during the change are not
/// reported.
std::string changed(std::string input, std::uint32_t seed) {
  if (__lsan_disable != nullptr) __lsan_disable();
  std::string result = chosen->mutate(std::move(input), seed);
  if (__lsan_enable != nullptr) __lsan_enable();
  return result;
}

}  // namespace

void fail(const std::string& what) {
  std::fprintf(stderr, "fuzz: %s\n", what.c_str());
  std::abort();
}

void keep_files_whole() { keeps_files_whole = chosen->by_library; }

std::string mutated_bytes(std::string text, std::size_t most) {
  const std::size_t size = std::min(text.size(), most);
  text.resize(most);
  text.resize(LLVMFuzzerMutate(reinterpret_cast<std::uint8_t*>(text.data()), size, most));
  return text;
}

}  // namespace meshorder::fuzz

using namespace meshorder::fuzz;

extern "C" int LLVMFuzzerInitialize(int* /*argc*/, char*** argv) {
  // one thread: the effect of an input must not depend on the timing of threads
  static const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  choose_family((*argv)[0]);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  chosen->check(chosen->name, {data, size});
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most,
                                               unsigned seed) {
  constexpr unsigned kOneIn = 2;  // one mutation in this many knows the structure
  // Libraries crash on some damaged files: a `mutate` that calls a library is used only if files stay whole.
  const bool knows = chosen->by_library ? keeps_files_whole : seed % kOneIn == 0;
  if (chosen->mutate != nullptr && knows) {
    const std::string result = changed({data, data + size}, static_cast<std::uint32_t>(std::mt19937(seed)()));
    if (!result.empty() && result.size() <= most) {
      std::copy(result.begin(), result.end(), data);
      return result.size();
    }
  }
  if (keeps_files_whole) return size;
  return LLVMFuzzerMutate(data, size, most);
}
