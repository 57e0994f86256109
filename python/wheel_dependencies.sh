#!/usr/bin/env bash
# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#
# Builds the libraries that meshorder needs in a manylinux image, because the image's own libraries are too old.
# cibuildwheel runs this script as its before-all.
set -euo pipefail

dnf -y install curl git ninja-build perl tar unzip zip
git clone --depth 1 --branch 2025.12.12 https://github.com/microsoft/vcpkg /opt/vcpkg
VCPKG_FORCE_SYSTEM_BINARIES=1 /opt/vcpkg/bootstrap-vcpkg.sh -disableMetrics
VCPKG_FORCE_SYSTEM_BINARIES=1 /opt/vcpkg/vcpkg install cli11 eigen3 fmt highway liblzma lz4 metis nlohmann-json tbb zlib
