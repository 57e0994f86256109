// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/format.hpp"

#include <array>
#include <string_view>

namespace meshorder {

/// File extensions of Exodus II. Builds without netCDF need them, too, for error messages.
inline constexpr std::array<std::string_view, 4> kExodusExtensions{".exo", ".e", ".ex2", ".g"};

// Each function is defined in the folder of its format; format.cpp lists the formats.
Format tetgen_format();  ///< .node with .ele, .face and .edge beside it
Format vega_format();    ///< .veg
Format gmsh_format();    ///< .msh 2.2 and 4.1, text and binary
Format medit_format();   ///< .mesh
Format vtu_format();     ///< VTK's XML unstructured grid
Format vtk_format();     ///< VTK's legacy files
Format vtkhdf_format();  ///< .vtkhdf; only in builds with HDF5
Format off_format();
Format obj_format();
Format ply_format();
Format stl_format();
Format su2_format();            ///< .su2
Format xdmf_format();           ///< .xdmf with .h5 beside it; only in builds with HDF5 and pugixml
Format med_format();            ///< .med of Salome and Code_Aster; only in builds with HDF5
Format abaqus_format();         ///< .inp of Abaqus and CalculiX
Format ucd_format();            ///< .avs, .ucd, and .inp files that are not Abaqus decks
Format nastran_format();        ///< bulk data of Nastran
Format matrix_market_format();  ///< .mtx
Format metis_graph_format();    ///< .graph
Format unv_format();            ///< .unv of I-deas
Format cgns_format();           ///< .cgns, in builds with the CGNS library
Format exodus_format();         ///< Exodus II, in builds with netCDF

}  // namespace meshorder
