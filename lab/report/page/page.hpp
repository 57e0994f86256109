// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "lab/report/figures/figures.hpp"
#include "lab/report/page/view.hpp"
#include "lab/report/tables/tables.hpp"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace meshorder {

/// A mesh of a study as the page shows it in 3-D.
struct PageMesh {
  std::string name;  ///< MeshRecord::name
  SurfaceView surface;
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
  std::vector<std::vector<Point>> frames;  ///< places of the surface's vertices
  SurfaceView obstacle;                    ///< may be empty
  std::vector<Point> obstacle_points;
};

/// What a page is made of.
struct Page {
  std::string title;
  StudyResults results;
  std::vector<Table> tables;
  std::vector<Figure> figures;
  std::vector<PageMesh> meshes;
  std::vector<PageMotion> motions;
  std::vector<std::string> findings;  ///< sentences for the top
};

/// One HTML file that needs nothing else: no network, no other file. Its data are quantised to 16 bits a
/// coordinate and compressed.
std::string to_html(const Page& page);

/// The same in another frame than viewer/page.html. Throws InvalidArgument for an unknown placeholder.
std::string fill_page(std::string_view frame, const Page& page);

/// Writes it whole or not at all. Throws Error when the file cannot be written.
void write_page(const Page& page, const std::filesystem::path& path);

}  // namespace meshorder
