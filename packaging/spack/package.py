# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
from spack.package import *


class Meshorder(CMakePackage):
    """Reorders the vertices and elements of simulation meshes, and the rows of sparse matrices, so that neighbours in
    the mesh are neighbours in memory and solvers find more of their data in the caches. The libraries for C++ and C."""

    license("MIT")

    # where the sources are is to be added: git = "…", or `spack develop --path …`
    version("0.3.0", tag="v0.3.0")

    variant("shared", default=True, description="One shared C++ library instead of an archive for each component")
    variant("metis", default=True, description="The orders metis-nd and metis-rb")
    variant("io", default=False, description="The component io: mesh files")

    depends_on("c", type="build")
    depends_on("cxx", type="build")
    depends_on("cmake@3.25:", type="build")
    depends_on("eigen@3.4:", type="build")
    depends_on("tbb")
    depends_on("metis@5:", when="+metis")
    with when("+io"):
        depends_on("fmt@9:")
        depends_on("zlib-api")
        depends_on("xz")
        depends_on("lz4")

    def cmake_args(self):
        spec = self.spec
        return [
            self.define("MESHORDER_COMPONENTS", ["core", "c"] + (["io"] if spec.satisfies("+io") else [])),
            self.define_from_variant("BUILD_SHARED_LIBS", "shared"),
            self.define_from_variant("MESHORDER_METIS", "metis"),
            self.define("MESHORDER_CLI", False),
            self.define("MESHORDER_TESTS", False),
            self.define("MESHORDER_EXAMPLES", False),
            self.define("MESHORDER_MODELS_TOOL", False),
        ]
