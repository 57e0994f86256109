#!/bin/bash -eu
# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#
# Builds one program for each family with its seeds and dictionary into $OUT; OSS-Fuzz sets CC, CXX, CFLAGS, CXXFLAGS,
# LIB_FUZZING_ENGINE, SRC, WORK and OUT.

# the system's C++ libraries are built with libstdc++
export CXXFLAGS="${CXXFLAGS/-stdlib=libc++/}"
build=$WORK/build
cmake -S "$SRC/meshorder" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=None -DMESHORDER_FUZZ=ON \
  "-DMESHORDER_FUZZ_ENGINE=$LIB_FUZZING_ENGINE" -DMESHORDER_TESTS=OFF -DMESHORDER_EXAMPLES=OFF -DMESHORDER_CLI=OFF \
  -DMESHORDER_MODELS_TOOL=OFF "-DMESHORDER_COMPONENTS=core;io" '-DCMAKE_EXE_LINKER_FLAGS=-Wl,-rpath,$ORIGIN/lib'
ninja -C "$build" meshorder_fuzz meshorder_fuzz_seeds

mkdir -p "$OUT/lib"
ldd "$build/bin/meshorder_fuzz" | awk '$3 ~ "^/" && $1 !~ "^lib(c|m|pthread|dl|rt)[.]so" {print $3}' |
  xargs -r cp -L -t "$OUT/lib"

"$build/bin/meshorder_fuzz_seeds" "$WORK/seeds"
python3 "$SRC/meshorder/fuzz/samples.py" "$WORK/seeds"
# add_program NAME FAMILY
add_program() {
  cp "$build/bin/meshorder_fuzz" "$OUT/meshorder_fuzz_$1"
  (cd "$WORK/seeds/$2" && python3 -m zipfile -c "$OUT/meshorder_fuzz_$1_seed_corpus.zip" ./*)
  dictionary=$SRC/meshorder/fuzz/dictionaries/$2.dict
  [ ! -f "$dictionary" ] || cp "$dictionary" "$OUT/meshorder_fuzz_$1.dict"
}
while read -r family; do add_program "$family" "$family"; done <"$build/fuzz/families.txt"
while read -r family; do add_program "whole_$family" "$family"; done <"$build/fuzz/families_by_library.txt"
