# shellcheck shell=bash
# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#
# What ./run and ./test share: the Debian packages that they need, and how the project is configured and built.
# To be sourced from the project's root.

# a Debian 12 package and its reason
packages_to_run=(
  build-essential      "C++ compiler"
  cmake                "configures the build"
  ninja-build          "runs the build"
  libcli11-dev         "command line"
  libeigen3-dev        "dense linear algebra"
  libfmt-dev           "text"
  libhwy-dev           "SIMD chosen at run time"
  libjs-three          "meshes in 3-D on the report page"
  libmeshoptimizer-dev "simplifies the surfaces that it shows"
  libmetis-dev         "orders by nested dissection and by parts"
  libsuitesparse-dev   "sparse Cholesky factors of the ADMM simulator"
  libtbb-dev           "threads"
  nlohmann-json3-dev   "JSON results"
  zlib1g-dev           "compressed .vtu files"
  liblz4-dev           "compressed .vtu files"
  liblzma-dev          "compressed .vtu files"
  libnetcdf-dev        "Exodus II files"
  libhdf5-dev          "MED and VTKHDF files, XDMF's arrays"
  libpugixml-dev       "XDMF's XML"
  libcgns-dev          "CGNS files"
  libcgal-dev          "makes the models' surfaces"
  libgmp-dev           "exact numbers for CGAL"
  libmpfr-dev          "exact numbers for CGAL"
  tetgen               "fills the surfaces with tetrahedra"
  gnuplot-nox          "draws the figures of a study"
)
# shellcheck disable=SC2034  # for ./run --mpi
packages_for_mpi=(
  libopenmpi-dev       "several ranks"
  openmpi-bin          "starts them"
  libptscotch-dev      "cuts meshes into parts for them"
)
# for fuzz/run, and for ./test
packages_to_fuzz=(
  clang-14             "compiler with coverage and sanitizers"
  libclang-rt-14-dev   "libFuzzer and the sanitizers' libraries"
  llvm-14              "names of functions in what the sanitizers report"
)
# shellcheck disable=SC2034  # for ./test
packages_to_test=(
  "${packages_to_run[@]}"
  "${packages_for_mpi[@]}"
  "${packages_to_fuzz[@]}"
  libgtest-dev         "unit tests"
  libvtk9-dev          "an independent reader and writer of .vtu and .vtk files"
  libgmock-dev         "matchers of the unit tests"
  python3              "end-to-end tests"
  python3-pytest       "end-to-end tests"
  python3-pytest-timeout "ends a test that hangs"
  python3-dev          "compiles the Python package"
  python3-venv         "tests the Python package apart from the system's own"
  python3-numpy        "independent answers for the end-to-end tests"
  python3-scipy        "independent answers for the end-to-end tests"
  python3-meshio       "an independent reader of mesh files"
  python3-netcdf4      "makes and reads Exodus II files independently"
  python3-mpi4py       "ranks of a program in Python"
  python3-h5py         "meshio's XDMF, and an independent reader of its HDF5 files"
  libexodusii5         "Exodus II's own library, which reads Nemesis pieces independently"
  libmed-tools         "MED's own library, which makes and reads MED files independently"
  cgns-convert         "checks and compares CGNS files, and makes some of ADF"
  libglu1-mesa         "Gmsh's Python module, which pip installs"
  libgl1               "Gmsh's Python module, which pip installs"
  libxcursor1          "Gmsh's Python module, which pip installs"
  libxft2              "Gmsh's Python module, which pip installs"
  libxinerama1         "Gmsh's Python module, which pip installs"
  libpetsc-real-dev    "the plugin for PETSc"
  calculix-ccx         "solves decks before and after they are ordered"
  python3-torch        "graphs of PyTorch, which Python orders"
  python3-jsonschema   "checks JSON against its schemas"
  locales              "a locale with decimal commas"
  valgrind             "finds reads of what was never written"
  doxygen              "reads the public headers for the manual"
  abigail-tools        "compares the binary interface for C with the recorded one"
  chromium             "the report page, as its reader sees it"
  chromium-driver      "the report page, as its reader sees it"
  python3-selenium     "the report page, as its reader sees it"
  fonts-dejavu-core    "letters for the browser"
  clang-format         "checks the layout of the sources"
  clang-tidy           "looks for mistakes in the sources"
)
# ./test does the same without them, in more time
# shellcheck disable=SC2034  # for ./test
packages_for_speed=(
  ccache               "compiles only once what has not changed, in whichever folder"
  libclang-dev         "a plugin that makes clang-tidy several times as fast"
  llvm-dev             "headers for that plugin"
  python3-pytest-xdist "several end-to-end tests at a time"
)

die() { printf '%s\n' "$*" >&2; exit 1; }

# as_root COMMAND…: without a terminal, sudo must not wait for a password
as_root() {
  if [ "$(id -u)" = 0 ]; then "$@"
  elif [ -t 0 ]; then sudo "$@"
  else sudo -n "$@"; fi
}

apt_get() { as_root env DEBIAN_FRONTEND=noninteractive apt-get -q -y -o DPkg::Lock::Timeout=600 "$@" </dev/null; }

# the mtime of the lists is the server's; that of partial/ is the time of the last update
package_lists_are_fresh() { [ -n "$(find /var/lib/apt/lists/partial -maxdepth 0 -mtime -1 2>/dev/null)" ]; }

# install_missing PACKAGE REASON PACKAGE REASON …
install_missing() {
  local -A reasons=()
  while [ $# -gt 0 ]; do reasons[$1]=$2; shift 2; done
  command -v dpkg-query >/dev/null || {
    echo "No Debian system: taking for granted what these Debian packages hold: ${!reasons[*]}"
    return 0
  }
  local installed missing
  # shellcheck disable=SC2016  # dpkg-query's own variables
  installed=$(dpkg-query -W -f '${db:Status-Status} ${Package}\n' "${!reasons[@]}" 2>/dev/null | sed -n 's/^installed //p' || true)
  mapfile -t missing < <(comm -23 <(printf '%s\n' "${!reasons[@]}" | sort) <(sort -u <<<"$installed"))
  [ ${#missing[@]} -gt 0 ] || return 0

  local list='' name log=build/setup.log
  for name in "${missing[@]}"; do list+="${list:+, }$name (${reasons[$name]})"; done
  [ "$(id -u)" = 0 ] || command -v sudo >/dev/null ||
    die "Missing packages. As root, run: apt-get install --no-install-recommends ${missing[*]}"
  mkdir -p build
  echo "Installing Debian packages, with what they depend on; it takes minutes, apt's log is $log:"
  echo "  $list"
  local install=(install --no-install-recommends "${missing[@]}")
  : >"$log"
  { package_lists_are_fresh && apt_get "${install[@]}" >>"$log" 2>&1; } ||
    { apt_get update >>"$log" 2>&1 && apt_get "${install[@]}" >>"$log" 2>&1; } ||
    { tail -n 5 "$log" >&2; die "The packages could not be installed; $log has it all."; }
}

# compilers take up to 2 GB each
build_jobs() {
  local cores memory limit
  cores=$(nproc)
  memory=$(awk '/^MemAvailable:/ {print int($2 / 1024 / 1024 / 2)}' /proc/meminfo)
  limit=$(cat /sys/fs/cgroup/memory.max 2>/dev/null || echo max)
  [ "$limit" = max ] || [ $((limit >> 31)) -ge "$memory" ] || memory=$((limit >> 31))
  [ "$memory" -ge 1 ] || memory=1
  echo $((cores < memory ? cores : memory))
}

# ccache finds in one checkout what was compiled in another: paths are relative to the checkout, also in debug
# information. With a precompiled header, ccache sees neither unused macros nor __TIME__ in the header; and a new
# checkout gives old headers new times.
export CCACHE_BASEDIR CCACHE_NOHASHDIR=1 CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime
CCACHE_BASEDIR=$(pwd -P)

# configure FOLDER OPTION…: ninja itself runs CMake again when a CMake file changed
configure() {
  local folder=$1 launcher=()
  shift
  command -v ccache >/dev/null && launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
  mkdir -p "$folder"
  cmake -S . -B "$folder" -G Ninja "${launcher[@]}" "$@" >"$folder/configure.log" 2>&1 ||
    { tail -n 20 "$folder/configure.log" >&2; die "CMake failed; $folder/configure.log has it all."; }
}

# build FOLDER TARGET…
# build FOLDER TARGET…: each line begins with the share done and the seconds taken so far
build() { NINJA_STATUS=${NINJA_STATUS:-'[%p, %es] '} ninja -C "$1" -j "$(build_jobs)" "${@:2}"; }

# sources FOLDER…: all sources of ours in those folders that exist, each ended by a zero byte
sources() {
  local folder folders=()
  for folder in "$@"; do [ ! -d "$folder" ] || folders+=("$folder"); done
  find "${folders[@]}" -name '*.[ch]pp' -print0
}
