// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/stream/file_path.hpp"
#include "lab/report/figures/figures.hpp"
#include "lab/report/page/view.hpp"
#include "lab/report/tables/tables.hpp"
#include <meshorder/quality.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace meshorder {

/// A mesh as the page shows it in 3-D.
struct PageMesh {
  std::string name;           ///< MeshRecord::name
  SurfaceView surface;        ///< without triangles for a matrix, which has no picture in 3-D
  std::vector<Point> points;  ///< of the surface's vertices
  struct Order {
    std::string ordering;
    std::vector<Index> ranks;  ///< of the surface's vertices, from 0
    SparsityPattern sparsity;
  };
  std::vector<Order> orders;
};

/// The motion of a scenario as the page plays it.
struct PageMotion {
  std::string scenario;
  SurfaceView surface;
  std::vector<Index> steps;                ///< of each frame
  std::vector<std::vector<Point>> frames;  ///< positions of the surface's vertices
  SurfaceView obstacle;                    ///< may be empty
  std::vector<Point> obstacle_points;
  std::vector<SurfaceView> surfaces = {};  ///< of a fluid, one for each frame, in the place of `surface`
};

/// The content of a page.
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

}  // namespace meshorder
