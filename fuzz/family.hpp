// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace meshorder::fuzz {

/// What is fuzzed on its own, with a corpus of its own: a file format, or a part of the interface.
struct Family {
  using Bytes = std::span<const std::uint8_t>;

  std::string_view name;
  /// Checks all that is promised of any input. Throws no exception of meshorder; aborts with a message on
  /// standard error where a promise is broken.
  void (*check)(std::string_view family, Bytes input);
  /// Changes an input knowing its structure, with `seed` for all choices. Returns an empty text where the
  /// input has no such structure. Null: bytes are changed without knowledge of what they mean.
  std::string (*mutate)(std::string input, std::uint32_t seed) = nullptr;
  /// Whether a library reads the bytes, which crashes on some damaged files: inputs are changed either by
  /// `mutate` alone, which leaves whole files, as in tests, or without it.
  bool by_library = false;
};

/// Returns all families, those of the formats that this build has among them.
std::span<const Family> families();

/// Writes a sentence to standard error and aborts.
[[noreturn]] void fail(const std::string& what);

/// Lets LLVMFuzzerCustomMutator leave files whole that a library reads; after LLVMFuzzerInitialize.
void keep_files_whole();

/// Changes `text` as the fuzzing engine does where it knows nothing of its meaning.
std::string mutated_bytes(std::string text, std::size_t most);

}  // namespace meshorder::fuzz
