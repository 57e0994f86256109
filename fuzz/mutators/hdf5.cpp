// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// HDF5 files: the values of a dataset are changed by libhdf5 itself, so that the file stays one.
#include "fuzz/families/families.hpp"
#include "fuzz/input_files.hpp"
#include "fuzz/mutators/choice.hpp"
#include "io/hdf5/hdf5_file.hpp"
#include <meshorder/error.hpp>

#include <algorithm>
#include <cstring>
#include <type_traits>

namespace meshorder::fuzz {
namespace {

constexpr std::string_view kSignature = "\x89HDF\r\n\x1a\n";

/// Changes one number, or all bytes as the engine likes, but not their count.
template <class Number>
void change(std::vector<Number>& numbers, Choice& choice) {
  if constexpr (std::is_arithmetic_v<Number>) {
    if (numbers.empty()) return;
    if (choice.below(2) == 0) {
      Number& number = numbers[choice.below(numbers.size())];
      number = choice.below(2) == 0 ? static_cast<Number>(number + 1) : static_cast<Number>(number - 1);
      return;
    }
    std::string bytes(numbers.size() * sizeof(Number), '\0');
    std::memcpy(bytes.data(), numbers.data(), bytes.size());
    const std::size_t size = bytes.size();
    bytes = mutated_bytes(std::move(bytes), size);
    bytes.resize(size);
    std::memcpy(numbers.data(), bytes.data(), size);
  }
}

/// Returns the file with another dataset; nothing without datasets of numbers.
std::string with_other_values(const std::string& bytes, Choice& choice) {
  hdf5::File file = hdf5::File::in_memory(bytes, "input");
  const auto datasets = file.datasets();
  if (datasets.empty()) return {};
  const std::string& path = datasets[choice.below(datasets.size())].first;
  if (choice.below(16) == 0) {
    file.remove(path);
    return file.bytes();
  }
  const std::string& source = choice.below(8) == 0 ? datasets[choice.below(datasets.size())].first : path;
  const hdf5::DatasetInfo info = file.info(source);
  Values values = file.read(source);
  std::vector<std::uint64_t> shape = info.shape;
  if (source == path) {
    std::visit([&](auto& numbers) { change(numbers, choice); }, values);
    if (choice.below(16) == 0 && shape.size() > 1) std::swap(shape.front(), shape.back());
  } else {  // two have the same values
    file.remove(path);
  }
  file.write(path, values, shape);
  return file.bytes();
}

}  // namespace

std::string mutate_hdf5(std::string input, std::uint32_t seed) {
  Choice choice(seed);
  std::vector<MemoryFile> files = input_files(input, "first");
  const auto found = std::find_if(files.begin(), files.end(),
                                  [](const MemoryFile& file) { return file.bytes.starts_with(kSignature); });
  if (found == files.end()) return {};
  try {
    found->bytes = with_other_values(found->bytes, choice);
  } catch (const Error&) {  // it is no longer whole
    return {};
  }
  return found->bytes.empty() ? std::string() : input_of(files);
}

}  // namespace meshorder::fuzz
