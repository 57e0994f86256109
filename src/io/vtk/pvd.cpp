// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/text.hpp"
#include "io/stream/output_file.hpp"
#include "io/vtu.hpp"
#include <meshorder/error.hpp>

#include <cmath>

namespace meshorder {

void write_pvd(std::span<const PvdEntry> entries, const FilePath& path) {
  OutputFile out(path);
  out.write("<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n  <Collection>\n");
  for (const PvdEntry& entry : entries) {
    if (!std::isfinite(entry.time))
      throw InvalidArgument("collection: the time of '" + entry.file + "' is not finite");
    out.print("    <DataSet timestep=\"{}\" group=\"\" part=\"0\" file=\"{}\"/>\n", entry.time,
              xml_escaped(entry.file));
  }
  out.write("  </Collection>\n</VTKFile>\n");
  out.commit();
}

}  // namespace meshorder
