// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// The laboratory's files.
#include "fuzz/families/families.hpp"
#include "fuzz/families/scratch.hpp"
#include "lab/scenario/checkpoint.hpp"
#include "lab/scenario/scenario.hpp"
#include "lab/study/results_json.hpp"
#include "support/files.hpp"

#include <nlohmann/json.hpp>
#include <zlib.h>

#include <cstring>

namespace meshorder::fuzz {
namespace {

// offsets in a checkpoint's header: magic (16 bytes), byte order, version (4 each), size (8), fingerprints
constexpr std::size_t kSizeAt = 24;
constexpr std::size_t kFingerprintAt = 32;
constexpr std::size_t kLeastCheckpoint = kFingerprintAt + sizeof(Fingerprint) + sizeof(std::uint32_t);

Fingerprint fingerprint_of(std::string_view checkpoint) {
  Fingerprint result;
  if (checkpoint.size() >= kLeastCheckpoint) {
    std::memcpy(&result, checkpoint.data() + kFingerprintAt, sizeof result);
  }
  return result;
}

}  // namespace

void check_scenario(std::string_view /*family*/, Family::Bytes input) {
  (void)accepted([&] { return parse_scenario(text_of(input), "scenario.json"); });
}

void check_results(std::string_view /*family*/, Family::Bytes input) {
  const std::filesystem::path path = scratch_file("results.json", text_of(input));
  const auto results = accepted([&] { return read_results(path); });
  if (!results) return;
  const std::filesystem::path copy = path.parent_path() / "copy.json";
  write_results(*results, copy);
  if (to_json(read_results(copy)) != to_json(*results)) fail("results that were written differ");
}

void check_checkpoint(std::string_view /*family*/, Family::Bytes input) {
  const std::string_view bytes = text_of(input);
  const std::filesystem::path path = scratch_file("checkpoint", bytes);
  const auto checkpoint = accepted([&] { return read_checkpoint(path, fingerprint_of(bytes)); });
  if (!checkpoint) return;
  const std::filesystem::path copy = path.parent_path() / "copy";
  write_checkpoint(*checkpoint, copy);
  const std::string written = test::content_of(copy);
  if (bytes.starts_with(written.substr(0, written.size() - sizeof(std::uint32_t)))) return;
  write_checkpoint(read_checkpoint(copy, checkpoint->fingerprint), path);
  if (test::content_of(path) != written) fail("a checkpoint that was written differs");
}

std::string mutate_checkpoint(std::string input, std::uint32_t /*seed*/) {
  if (input.size() < kLeastCheckpoint) return {};
  constexpr std::size_t kSum = sizeof(std::uint32_t);
  const std::string head = input.substr(0, kFingerprintAt);
  std::string body = input.substr(kFingerprintAt, input.size() - kFingerprintAt - kSum);
  body = mutated_bytes(body, body.size() + 64);
  std::string result = head + body;
  const std::uint64_t size = result.size() + kSum;
  std::memcpy(result.data() + kSizeAt, &size, sizeof size);
  const auto sum =
      static_cast<std::uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(result.data()), result.size()));
  result.append(reinterpret_cast<const char*>(&sum), kSum);
  return result;
}

void check_motion(std::string_view /*family*/, Family::Bytes input) {
  const std::filesystem::path path = scratch_file("motion.npy", text_of(input));
  const auto motion = accepted([&] { return read_motion(path); });
  if (!motion) return;
  for (const auto& frame : motion->frames) {
    if (index_size(frame) != motion->vertices) fail("a frame has another number of vertices");
  }
}

}  // namespace meshorder::fuzz
