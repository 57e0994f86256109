// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/checksum.hpp"
#include "base/memory.hpp"
#include "io/xdmf/raw.hpp"
#include "io/xdmf/writer.hpp"
#include "mesh/values.hpp"

#include <fmt/compile.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <type_traits>

namespace meshorder::xdmf {
namespace {

/// Returns the shape of `count` values in rows of `components` values.
std::vector<std::uint64_t> shape_of(std::size_t count, std::size_t components) {
  std::vector<std::uint64_t> shape{count / components};
  if (components > 1) shape.push_back(components);
  return shape;
}

}  // namespace

void set_either(pugi::xml_node element, const char* name, const char* other, const std::string& value) {
  set_attribute(element, element.attribute(other) && !element.attribute(name) ? other : name, value);
}

namespace {

void set_number_type(pugi::xml_node item, std::size_t alternative) {
  const auto [name, precision] = number_type_of(alternative);
  set_either(item, "NumberType", "DataType", name);
  set_attribute(item, "Precision", std::to_string(precision));
}

}  // namespace

void Writer::set_shape(pugi::xml_node item, const std::vector<std::uint64_t>& shape) {
  std::string text;
  for (const std::uint64_t n : shape) text += (text.empty() ? "" : " ") + std::to_string(n);
  set_attribute(item, "Dimensions", text);
}

std::vector<std::uint64_t> Writer::shape_at(const DataPlace& place, std::size_t count,
                                            std::size_t components) {
  if (place.count() == count && !layout_.is_made) return place.shape;
  std::vector<std::uint64_t> shape = shape_of(count, components);
  set_shape(items_[place.item], shape);
  if (place.format == DataPlace::Format::hdf)
    shapes_[files_.at(place.file).name + ":" + place.dataset] = shape;
  return shape;
}

bool Writer::is_taken(const DataPlace& place, const Values& values) {
  if (place.format != DataPlace::Format::hdf) return false;
  Hdf5Output& output = files_.at(place.file);
  return !output.written.insert(place.dataset).second && output.file->read(place.dataset) != values;
}

std::vector<std::uint64_t> Writer::describe(pugi::xml_node item, const Values& values,
                                            std::size_t components) {
  std::vector<std::uint64_t> shape = shape_of(size_of(values), components);
  set_shape(item, shape);
  set_number_type(item, values.index());
  return shape;
}

void Writer::put_apart(pugi::xml_node item, const std::string& file, const std::string& dataset,
                       const Values& values, const std::vector<std::uint64_t>& shape) {
  files_.at(file).file->write(dataset, values, shape);
  set_text(item, file + ":" + dataset);
}

std::vector<pugi::xml_node> Writer::items_at(const DataPlace& place) const {
  std::vector<pugi::xml_node> items{items_[place.item]};
  for (const DataPlace::Repeat& repeat : place.repeats) items.push_back(items_[repeat.item]);
  return items;
}

void Writer::put(const DataPlace& place, const Values& values, std::size_t components) {
  pugi::xml_node item = items_[place.item];
  if (is_taken(place, values)) {
    const std::string dataset = unused_dataset(files_.at(place.file), 0, "");
    put_apart(item, place.file, dataset, values, shape_of(size_of(values), components));
    for (pugi::xml_node each : items_at(place)) {
      describe(each, values, components);
      set_text(each, item.text().get());
    }
    return;
  }
  const std::vector<std::uint64_t> shape = shape_at(place, size_of(values), components);
  const bool same_type = values.index() == place.alternative;
  if (!same_type || layout_.is_made) {
    for (pugi::xml_node each : items_at(place)) set_number_type(each, values.index());
  }
  switch (place.format) {
    case DataPlace::Format::xml:
      set_text(item, text_of_values(values, components));
      return;
    case DataPlace::Format::hdf:
      if (!same_type) files_.at(place.file).file->remove(place.dataset);
      files_.at(place.file).file->write(place.dataset, values, shape);
      return name_dataset(place);
    case DataPlace::Format::binary:
      put_binary(item, place, values);
  }
}

void Writer::put_indices(const DataPlace& place, std::span<const Index> indices, std::size_t components) {
  constexpr std::size_t kInt32 = 6;
  const bool is_shared =
      place.format == DataPlace::Format::hdf && files_.at(place.file).written.contains(place.dataset);
  if (place.format != DataPlace::Format::hdf || place.alternative < kInt32 || is_shared) {
    Values values = values_of_type(std::max(place.alternative, kInt32));
    with_integers(values, [&](auto& numbers) { numbers.assign(indices.begin(), indices.end()); });
    return put(place, values, components);
  }
  if (layout_.is_made) set_number_type(items_[place.item], place.alternative);
  files_.at(place.file).written.insert(place.dataset);
  files_.at(place.file).file->write(place.dataset, indices, shape_at(place, indices.size(), components));
  name_dataset(place);
}

void Writer::name_dataset(const DataPlace& place) {
  files_.at(place.file).datasets.insert(place.dataset);
  if (layout_.is_made) set_text(items_[place.item], place.file + ":" + place.dataset);
}

void Writer::put_binary(pugi::xml_node item, const DataPlace& place, const Values& values) {
  const std::string name = fmt::format("{}{}.bin", stem_, binaries_.size());
  OutputFile& out = binaries_.emplace_back(path_.beside(name));
  Checksum sum;
  with_numbers(values, [&](const auto& numbers) {
    for (const auto number : numbers) out.binary(number, place.order);
    sum.add_all(numbers);
  });
  item.remove_attribute("Seek");
  item.remove_attribute(kValueMark);
  set_attribute(item, kValueMark, mark_of(sum.value()));
  set_text(item, name);
}

std::string Writer::text_of_values(const Values& values, std::size_t components) {
  constexpr std::size_t kMostCharacters = 32;  // for a number and the blank after it
  constexpr std::size_t kUsualCharacters = 20;
  std::string text;
  with_numbers(values, [&]<class Number>(const std::vector<Number>& numbers) {
    resize_large(text, kUsualCharacters * numbers.size() + kMostCharacters);
    char* at = text.data();
    *at++ = '\n';
    std::size_t in_row = 0;
    for (const Number number : numbers) {
      const auto used = static_cast<std::size_t>(at - text.data());
      if (text.size() - used < kMostCharacters) {
        text.resize(text.size() + text.size() / 4 + kMostCharacters);
        at = text.data() + used;
      }
      if constexpr (std::is_integral_v<Number>) {
        at = std::to_chars(at, at + kMostCharacters, number).ptr;
      } else {
        at = fmt::format_to(at, FMT_COMPILE("{}"), number);
      }
      const bool ends_row = ++in_row == components;
      *at++ = ends_row ? '\n' : ' ';
      if (ends_row) in_row = 0;
    }
    text.resize(static_cast<std::size_t>(at - text.data()));
  });
  return text;
}

}  // namespace meshorder::xdmf
