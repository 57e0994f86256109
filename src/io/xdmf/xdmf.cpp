// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/xdmf/xdmf.hpp"

#include "io/all_formats.hpp"
#include "io/hdf5/session.hpp"
#include "io/unsupported.hpp"
#include "io/xdmf/raw.hpp"
#include "io/xdmf/writer.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <optional>

namespace meshorder::xdmf {

void write(const Mesh& mesh, const FilePath& path, Notes& notes) {
  const hdf5::Session session;  // the outermost session: it records the failures of the whole function
  if (const auto* const own = dynamic_cast<const XdmfLayout*>(mesh.format_metadata.get())) {
    std::vector<std::vector<Index>> rows = cells_of_parts(mesh, *own);
    if (!rows.front().empty()) return Writer(mesh, *own, std::move(rows), path, notes).write();
  }
  const XdmfLayout layout = layout_of(mesh, path);
  Writer(mesh, layout, cells_of_parts(mesh, layout), path, notes).write();
  note_metadata_unsupported(mesh, "XDMF", notes);
}

std::string mark_of(std::uint64_t checksum) { return fmt::format("{:016x}", checksum); }

namespace {

/// The files of a layout whose values are all in one HDF5 file.
class XdmfWithData final : public SplitFile {
 public:
  explicit XdmfWithData(std::shared_ptr<const XdmfLayout> layout) : layout_(std::move(layout)) {}

  [[nodiscard]] std::string data_of(const std::string& document) const override {
    return with_writer(document, [&](Writer& writer) {
      return FilePath(document).beside(writer.new_name(layout_->hdf5.begin()->first)).string();
    });
  }

  [[nodiscard]] std::string write_without_values(const std::string& document, const std::string& data,
                                                 std::uint64_t checksum) const override {
    return with_writer(document,
                       [&](Writer& writer) { return writer.write_without_values(data, mark_of(checksum)); });
  }

  [[nodiscard]] std::vector<std::int64_t> places_in(const std::string& data,
                                                    const std::string& name) const override {
    const hdf5::Session session;
    const hdf5::File file = hdf5::File::open(data, name);
    std::vector<std::int64_t> places;
    for (const Field& field : layout_->fields) {
      const std::optional<std::uint64_t> place = file.place_of_values(field.place.dataset);
      if (!place) {
        throw InputError(name, fmt::format("no space was allocated for dataset '{}'", field.place.dataset),
                         "is the disk full?");
      }
      places.push_back(static_cast<std::int64_t>(*place));
    }
    return places;
  }

 private:
  template <class Work>
  [[nodiscard]] std::string with_writer(const std::string& document, const Work& work) const {
    const hdf5::Session session;
    const Mesh none;
    Notes ignored;
    Writer writer(none, *layout_, {}, FilePath(document), ignored);
    return work(writer);
  }

  std::shared_ptr<const XdmfLayout> layout_;
};

}  // namespace

std::shared_ptr<const SplitFile> with_data(std::shared_ptr<const XdmfLayout> layout) {
  return std::make_shared<XdmfWithData>(std::move(layout));
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
