// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// parRSB, the spectral partitioner of Nek5000: `mpirun -n N peer-parrsb HEXAHEDRA N OUT` cuts hexahedra into
// as many parts as there are ranks. HEXAHEDRA is a folder with two files of whole numbers: corners.npy, the
// eight vertices of each hexahedron, and coordinates.npy, the three coordinates of each of these corners.
#include "parts.hpp"

#include <mpi.h>
#include <parRSB.h>  // must follow mpi.h, which it includes as if it were C

#include <cstdio>
#include <stdexcept>
#include <string>

namespace {

constexpr int kCorners = 8;

std::vector<int> partition(const std::vector<std::int64_t>& corners,
                           const std::vector<std::int64_t>& coordinates) {
  const peer::Range own = peer::own_range(static_cast<std::int64_t>(corners.size()) / kCorners);
  std::vector<long long> vertices;
  for (std::int64_t k = own.begin * kCorners; k < own.end * kCorners; ++k)
    vertices.push_back(corners[static_cast<std::size_t>(k)] + 1);
  const std::vector<double> places(coordinates.begin() + own.begin * kCorners * 3,
                                   coordinates.begin() + own.end * kCorners * 3);
  std::vector<int> parts(static_cast<std::size_t>(own.end - own.begin));
  parrsb_options options = parrsb_default_options;
  options.verbose_level = 0;
  if (parrsb_part_mesh(parts.data(), vertices.data(), places.data(), nullptr, static_cast<int>(parts.size()),
                       kCorners, &options, MPI_COMM_WORLD) != 0) {
    throw std::runtime_error("parRSB failed");
  }
  return parts;
}

}  // namespace

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  if (argc < 4) {
    std::fputs("usage: peer-parrsb HEXAHEDRA PARTS OUT\n", stderr);
    return 2;
  }
  peer::run_on_ranks([&] {
    const std::string folder = argv[1];
    const std::vector<std::int64_t> corners = peer::read_numbers(folder + "/corners.npy");
    const std::vector<std::int64_t> coordinates = peer::read_numbers(folder + "/coordinates.npy");
    peer::measure_parts(argv[3], [&] { return partition(corners, coordinates); });
  });
  MPI_Finalize();
}
