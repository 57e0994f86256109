// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/fluid/triangulation.hpp"

#include "lab/support/process.hpp"
#include <meshorder/error.hpp>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

namespace meshorder {
namespace {

constexpr const char* kProgram = "meshorder-delaunay";

[[noreturn]] void throw_misunderstood() {
  throw InputError(kProgram, "its answer is not a triangulation", "install the program of this version");
}

/// Throws unless all numbers are 0 … count − 1, or −1 if `may_lack`.
void check_numbers(std::span<const std::array<Index, 4>> rows, Index count, bool may_lack) {
  for (const std::array<Index, 4>& row : rows) {
    for (const Index number : row) {
      if (number >= count || number < (may_lack ? -1 : 0)) throw_misunderstood();
    }
  }
}

Triangulation ask(ChildProcess& program, std::span<const Point> points) {
  const auto count = static_cast<std::int64_t>(points.size());
  program.send_bytes(std::as_bytes(std::span(&count, 1)));
  program.send_bytes(std::as_bytes(points));
  std::int64_t tetrahedra = 0;
  program.receive_bytes(std::as_writable_bytes(std::span(&tetrahedra, 1)));
  if (tetrahedra < 0 || tetrahedra > kMaxIndex / 4 || (count < 4 && tetrahedra > 0)) throw_misunderstood();
  Triangulation result;
  result.corners.resize(static_cast<std::size_t>(tetrahedra));
  result.neighbours.resize(result.corners.size());
  program.receive_bytes(std::as_writable_bytes(std::span(result.corners)));
  program.receive_bytes(std::as_writable_bytes(std::span(result.neighbours)));
  check_numbers(result.corners, static_cast<Index>(count), false);
  check_numbers(result.neighbours, static_cast<Index>(tetrahedra), true);
  return result;
}

}  // namespace

bool has_delaunay_program() { return !find_program(kProgram).empty(); }

Triangulate delaunay_program() {
  const std::filesystem::path path = find_program(kProgram);
  if (path.empty())
    throw InputError(kProgram, "is neither beside this program nor on PATH",
                     "build it with -DMESHORDER_MODELS_TOOL=ON; it needs CGAL");
  const auto program = std::make_shared<ChildProcess>(path, std::vector<std::string>{});
  return [program](std::span<const Point> points) { return ask(*program, points); };
}

}  // namespace meshorder
