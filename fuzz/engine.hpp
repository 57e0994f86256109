// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>

// What a fuzzing engine calls, as libFuzzer's documentation names it (https://llvm.org/docs/LibFuzzer.html):
// fuzz/entry.cpp defines it. The engine, or fuzz/driver.cpp in its place, defines `LLVMFuzzerMutate`, which
// changes bytes without knowledge of what they mean.

// NOLINTBEGIN(readability-identifier-naming): the engine's names
extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv);
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most,
                                               unsigned seed);
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);
// NOLINTEND(readability-identifier-naming)
