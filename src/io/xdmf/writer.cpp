// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/xdmf/writer.hpp"

#include "base/checksum.hpp"
#include "base/index.hpp"
#include "io/xdmf/raw.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <new>
#include <string_view>

namespace meshorder::xdmf {

Writer::Writer(const Mesh& mesh, const XdmfLayout& layout, std::vector<std::vector<Index>> rows,
               const FilePath& path, Notes& notes)
    : mesh_(mesh),
      layout_(layout),
      fields_(layout.fields),
      path_(path),
      stem_(path.path().stem().string()),
      notes_(notes),
      rows_(std::move(rows)) {
  parse(xml_, layout.xml);
  items_ = elements_named(xml_, "DataItem");
  grids_ = elements_named(xml_, "Grid");
  part_references();
}

void Writer::write() {
  OutputFile xml(path_);
  open_files();
  for (const Field& field : fields_) write_field(field);
  remove_gone();
  add_others();
  rename_files();
  mark_files(mark_of_mesh());
  std::vector<OutputFile> all;
  all.reserve(1 + files_.size() + binaries_.size());
  all.push_back(std::move(xml));
  for (auto& [name, output] : files_) all.push_back(output.out->finish());
  put_xml([&](std::string_view part) { all.front().write(part); });
  for (OutputFile& binary : binaries_) all.push_back(std::move(binary));
  OutputFile::commit_all(all);
}

std::string Writer::write_without_values(const std::filesystem::path& data, const std::string& mark) {
  const auto& [old_name, bytes] = *layout_.hdf5.begin();
  Hdf5Output output;
  output.name = new_name(old_name);
  const std::string name = path_.beside(output.name).string();
  hdf5::File file = hdf5::File::make(data, bytes, name);
  output.file = &file;
  files_.emplace(old_name, std::move(output));
  for (const Field& field : fields_) {
    file.give_room(field.place.dataset);
    if (field.role == Field::Role::connectivity) announce_cells_of(field);
  }
  rename_files();
  mark_files(mark);
  file.close();
  std::string xml;
  put_xml([&](std::string_view part) { xml += part; });
  return xml;
}

std::string Writer::new_name(const std::string& old_name) const {
  const std::filesystem::path old(old_name);
  const std::string extension = old.extension().empty() ? ".h5" : old.extension().string();
  std::string rest = old.stem().string();
  if (layout_.hdf5.size() == 1) {
    rest.clear();
  } else if (rest.starts_with(layout_.stem)) {
    rest.erase(0, layout_.stem.size());
  } else {
    rest.insert(0, "_");
  }
  std::string name = stem_ + rest + extension;
  const auto is_taken = [&] {
    return std::any_of(files_.begin(), files_.end(),
                       [&](const auto& file) { return file.second.name == name; });
  };
  for (int k = 2; is_taken(); ++k) name = fmt::format("{}{}_{}{}", stem_, rest, k, extension);
  return name;
}

void Writer::open_files() {
  for (const auto& [old_name, bytes] : layout_.hdf5) {
    Hdf5Output output;
    output.name = new_name(old_name);
    output.out = std::make_unique<hdf5::NewFile>(path_.beside(output.name), bytes);
    output.file = &output.out->file();
    for (const auto& [path, rows] : output.file->datasets()) output.datasets.insert(path);
    files_.emplace(old_name, std::move(output));
  }
}

void Writer::rename_files() {
  for (pugi::xml_node item : elements_named(xml_, "DataItem")) {
    const std::string format = attribute(item, "Format");
    if (!format.starts_with('H') && !format.starts_with('h')) continue;
    const auto [file, dataset] = split_hdf5_name(item.text().get());
    const auto output = files_.find(file);
    if (output == files_.end()) continue;
    set_text(item, output->second.name + ":" + dataset);
    const auto shape = shapes_.find(output->second.name + ":" + dataset);
    if (shape != shapes_.end()) set_shape(item, shape->second);
  }
}

std::string Writer::mark_of_mesh() const {
  Checksum sum;
  if (files_.empty()) return {};
  sum.add_all(mesh_.points);
  for (const std::vector<Index>& cells : rows_) {
    for (const Index c : cells) sum.add_all(mesh_.cells[c]);
  }
  return mark_of(sum.value());
}

void Writer::mark_files(const std::string& mark) {
  pugi::xml_node root = xml_.document_element();
  root.remove_child(root.find_child(is_mark));
  if (files_.empty()) return;
  pugi::xml_node instruction = root.prepend_child(pugi::node_pi);
  if (!instruction.set_name(kMark) || !instruction.set_value(mark.c_str())) throw std::bad_alloc();
  for (auto& [name, output] : files_) output.file->set_attribute("/", kMark, mark);
}

void Writer::put_xml(const TakeText& take) const {
  if (layout_.is_made) return print_indented(xml_, take);
  print(xml_, std::string_view(layout_.xml).substr(0, layout_.xml.find("<Xdmf")), take);
}

}  // namespace meshorder::xdmf
