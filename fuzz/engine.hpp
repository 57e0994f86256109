// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

// The functions that a fuzzing engine calls, by their names in libFuzzer's documentation
// (https://llvm.org/docs/LibFuzzer.html); fuzz/entry.cpp defines them. The engine, or fuzz/driver.cpp in its
// place, defines `LLVMFuzzerMutate`, which changes bytes without knowledge of their meaning.

// NOLINTBEGIN(readability-identifier-naming): the engine's names
extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv);
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most,
                                               unsigned seed);
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);
// NOLINTEND(readability-identifier-naming)
