// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/xdmf/xdmf.hpp"

#include "io/all_formats.hpp"
#include "io/hdf5/session.hpp"
#include "io/unsupported.hpp"
#include "io/xdmf/raw.hpp"
#include "io/xdmf/writer.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <filesystem>
#include <optional>

namespace meshorder::xdmf {

void write(const Mesh& mesh, const FilePath& path, Notes& notes) {
  const hdf5::Session session;  // for the whole function: failures in it count at its end
  if (const auto* const own = dynamic_cast<const Layout*>(mesh.format_metadata.get())) {
    std::vector<std::vector<Index>> rows = cells_of_parts(mesh, *own);
    if (!rows.front().empty()) return Writer(mesh, *own, std::move(rows), path, notes).write();
  }
  const Layout layout = layout_of(mesh, path);
  Writer(mesh, layout, cells_of_parts(mesh, layout), path, notes).write();
  note_metadata_unsupported(mesh, "XDMF", notes);
}

std::string mark_of(std::uint64_t checksum) { return fmt::format("{:016x}", checksum); }

std::string name_of_data(const Layout& layout, const std::filesystem::path& path) {
  const Mesh none;
  Notes ignored;
  return Writer(none, layout, {}, FilePath(path), ignored).new_name(layout.hdf5.begin()->first);
}

std::string write_without_values(const Layout& layout, const std::filesystem::path& path,
                                 const std::filesystem::path& data, const std::string& mark) {
  const hdf5::Session session;
  const Mesh none;
  Notes ignored;
  return Writer(none, layout, {}, FilePath(path), ignored).write_without_values(data, mark);
}

std::vector<std::uint64_t> places_of_values(const Layout& layout, const std::filesystem::path& data,
                                            const std::string& name) {
  const hdf5::Session session;
  const hdf5::File file = hdf5::File::open(data, name);
  std::vector<std::uint64_t> places;
  for (const Field& field : layout.fields) {
    const std::optional<std::uint64_t> place = file.place_of_values(field.place.dataset);
    if (!place) {
      throw InputError(name, fmt::format("the dataset '{}' got no room", field.place.dataset),
                       "is the disk full?");
    }
    places.push_back(*place);
  }
  return places;
}

}  // namespace meshorder::xdmf

namespace meshorder {

Format xdmf_format() {
  return {.name = "XDMF",
          .extensions = {".xdmf", ".xmf"},
          .groups_cells_by_type = false,
          .read = xdmf::read,
          .write = xdmf::write,
          .holds = xdmf::holds,
          .places = xdmf::places,
          .single_file = false,
          .library = "HDF5",
          .load_library = hdf5::load_library};
}

}  // namespace meshorder
