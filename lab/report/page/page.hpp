// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/stream/file_path.hpp"
#include "lab/report/figures/figures.hpp"
#include "lab/report/tables/tables.hpp"
#include "lab/study/results.hpp"
#include <meshorder/mesh.hpp>
#include <meshorder/quality.hpp>

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder {

/// The simplified outer surface of a body.
struct SurfaceView {
  std::vector<Index> vertices;  ///< vertices of the mesh, in the sequence of their first use
  std::vector<std::array<Index, 3>>
      triangles;  ///< indices into `vertices`, anticlockwise as seen from outside
};

/// A mesh as the page shows it in 3-D.
struct PageMesh {
  std::string name;           ///< MeshRecord::name
  SurfaceView surface;        ///< without triangles for a matrix, which has no picture in 3-D
  std::vector<Point> points;  ///< of the surface's vertices
  struct Order {
    std::string ordering;
    std::vector<Index> ranks;  ///< positions of the surface's vertices in the order, from 0
    SparsityPattern sparsity;
  };
  std::vector<Order> orders;
};

/// The motion of a scenario as the page plays it.
struct PageMotion {
  std::string scenario;
  SurfaceView surface;
  std::vector<Index> steps;                ///< step of each frame
  std::vector<std::vector<Point>> frames;  ///< positions of the surface's vertices
  SurfaceView obstacle;                    ///< may be empty
  std::vector<Point> obstacle_points;
  std::vector<SurfaceView> surfaces = {};  ///< of a fluid, one for each frame; `surface` is then unused
};

struct Page {
  std::string title;
  StudyResults results;
  std::vector<Table> tables;
  std::vector<Figure> figures;
  std::vector<PageMesh> meshes;
  std::vector<PageMotion> motions;
  std::vector<std::string> findings;  ///< sentences for the top
};

/// Returns the page as one HTML file, which needs no network and no other file. Coordinates are quantised to
/// 16 bits and compressed.
std::string to_html(const Page& page);

/// Does the same with another template than viewer/page.html. Throws InvalidArgument for an unknown
/// placeholder.
std::string fill_page(std::string_view frame, const Page& page);

/// Writes the page, completely or not at all. Throws Error if the file cannot be written.
void write_page(const Page& page, const FilePath& path);

/// Returns HTML on how much faster kernels run on each mesh in the order that `meshorder order` makes: the
/// gain, if it is certain; the verdict; and two bars for each kernel, its times in the mesh's own order and
/// the new order. Empty for a study with scenarios. Leaves out meshes that have neither a verdict nor times.
std::string headlines_of(const StudyResults& results);

/// The files of viewer/, and three.js with its licence, built into the program.
struct ViewerSources {
  std::string_view page;        ///< page.html, with its placeholders
  std::string_view comparison;  ///< comparison.html, with its placeholders
  std::string_view style;       ///< style.css
  std::string_view scripts;     ///< all *.js, in the order of their names
  std::string_view three;
};

const ViewerSources& viewer_sources();

}  // namespace meshorder
