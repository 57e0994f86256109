// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace meshorder::fuzz {

/// A subject of fuzzing, with a corpus of its own: a file format, or a part of the interface.
struct Family {
  using Bytes = std::span<const std::uint8_t>;

  std::string_view name;
  /// Checks all promises about an input. Throws no exception of meshorder; aborts with a message on standard
  /// error where a promise is broken.
  void (*check)(std::string_view family, Bytes input);
  /// Changes an input with knowledge of its structure; `seed` determines all choices. Returns an empty text
  /// if the input has no such structure. Null: bytes are changed without knowledge of their meaning.
  std::string (*mutate)(std::string input, std::uint32_t seed) = nullptr;
  /// Whether a library reads the bytes. Libraries crash on some damaged files. A program therefore changes
  /// inputs either only by `mutate`, which leaves files whole (as in tests), or never by `mutate`.
  bool by_library = false;
};

/// Returns all families, including those of the formats that this build has.
std::span<const Family> families();

/// Writes a sentence to standard error and aborts.
[[noreturn]] void fail(const std::string& what);

/// Makes LLVMFuzzerCustomMutator damage no files that a library reads. Call it after LLVMFuzzerInitialize.
void keep_files_whole();

/// Returns `text` as the engine changes it without knowledge of its meaning, cut to `most` bytes.
std::string mutated_bytes(std::string text, std::size_t most);

}  // namespace meshorder::fuzz
