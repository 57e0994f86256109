// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Runs a family without a fuzzing engine, the same way each time:
//
//   meshorder_fuzz_FAMILY EXECUTIONS FOLDER
//
// checks the files of the folder, or one file, then EXECUTIONS changed inputs. It does not measure coverage,
// so it finds only faults near the seeds. An input that breaks a promise is left in the file "crash".
#include "fuzz/engine.hpp"
#include "fuzz/family.hpp"

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

// defined by the sanitizers, if they are built in
extern "C" __attribute__((weak)) void __sanitizer_set_death_callback(void (*callback)());  // NOLINT

namespace meshorder::fuzz {
namespace {

constexpr std::size_t kMostOfInput = std::size_t{1} << 18U;  // all seeds are shorter
constexpr std::array<std::string_view, 10> kNumbers{
    "0", "1", "-1", "2147483647", "2147483648", "4294967296", "1e400", "nan", "-0", "99999999999999999999"};

// NOLINTBEGIN(cppcoreguidelines-avoid-non-const-global-variables): signals and engines have no other context
std::mt19937 random_numbers;
std::string current;  // the input that is being checked
// NOLINTEND(cppcoreguidelines-avoid-non-const-global-variables)

void keep_input() {
  std::ofstream("crash", std::ios::binary)
      .write(current.data(), static_cast<std::streamsize>(current.size()));
}

std::size_t below(std::size_t end) { return end == 0 ? 0 : random_numbers() % end; }

/// Changes a few bytes, removes or repeats a part, or puts a number in place of a part.
std::string changed(std::string text) {
  const std::size_t at = below(text.size());
  const std::size_t length = std::min(text.size() - at, 1 + below(16));
  switch (below(6)) {
    case 0:
      return text.erase(at, length);
    case 1:
      return text.insert(at, text.substr(at, length));
    case 2:
      return text.replace(at, std::min<std::size_t>(length, 4), kNumbers[below(kNumbers.size())]);
    case 3:
      return text.substr(0, at);
    case 4:
      if (!text.empty()) text[at] = static_cast<char>(text[at] ^ 1 << below(8));
      return text;
    default:
      if (!text.empty()) text[at] = static_cast<char>(below(256));
      return text;
  }
}

/// Returns the content of a file, or the contents of the files in a folder, sorted by their names.
std::vector<std::string> seeds_in(const std::filesystem::path& place) {
  std::vector<std::filesystem::path> paths;
  if (std::filesystem::is_regular_file(place)) paths.push_back(place);
  for (std::error_code none; const auto& entry : std::filesystem::directory_iterator(place, none)) {
    if (entry.is_regular_file()) paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  std::vector<std::string> seeds;
  for (const auto& path : paths) {
    std::ifstream stream(path, std::ios::binary);
    seeds.emplace_back(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
  }
  return seeds;
}

void run_one(std::string input) {
  current = std::move(input);
  LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(current.data()), current.size());
}

int run(const std::filesystem::path& seed_folder, long executions) {
  const std::vector<std::string> seeds = seeds_in(seed_folder);
  if (seeds.empty()) {
    std::fprintf(stderr, "%s: no seeds\n", seed_folder.c_str());
    return EXIT_FAILURE;
  }
  for (const std::string& seed : seeds) run_one(seed);
  for (long k = 0; k < executions; ++k) {
    std::string input = seeds[static_cast<std::size_t>(k) % seeds.size()];
    std::size_t size = std::min(input.size(), kMostOfInput);
    input.resize(kMostOfInput);
    for (std::size_t changes = 1 + below(3); changes > 0; --changes) {
      size = LLVMFuzzerCustomMutator(reinterpret_cast<std::uint8_t*>(input.data()), size, kMostOfInput,
                                     static_cast<unsigned>(random_numbers()));
    }
    input.resize(size);
    run_one(std::move(input));
  }
  std::printf("%zu seeds and %ld changed inputs\n", seeds.size(), executions);
  return EXIT_SUCCESS;
}

}  // namespace
}  // namespace meshorder::fuzz

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most) {
  const std::string text = meshorder::fuzz::changed({data, data + size});
  const std::size_t kept = std::min(text.size(), most);
  std::copy_n(text.begin(), kept, data);
  return kept;
}

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: %s EXECUTIONS FOLDER\n", argv[0]);
    return 2;
  }
  LLVMFuzzerInitialize(&argc, &argv);
  meshorder::fuzz::keep_files_whole();
  if (__sanitizer_set_death_callback != nullptr) __sanitizer_set_death_callback(meshorder::fuzz::keep_input);
  std::signal(SIGABRT, [](int /*signal*/) { meshorder::fuzz::keep_input(); });
  return meshorder::fuzz::run(argv[2], std::strtol(argv[1], nullptr, 10));
}
