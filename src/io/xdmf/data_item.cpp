// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/xdmf/data_item.hpp"

#include "base/checksum.hpp"
#include "base/index.hpp"
#include "base/memory.hpp"
#include "base/text.hpp"
#include "io/format.hpp"
#include "io/stream/byte_order.hpp"
#include "io/stream/read_limits.hpp"
#include "io/stream/regular_text.hpp"
#include "io/xdmf/raw.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <limits>
#include <tuple>

namespace meshorder::xdmf {
namespace {

using Format = DataPlace::Format;

/// A number type under a name that VTK's readers accept: they know one byte as Char or UChar, not as Int.
struct NumberType {
  std::string_view name;
  int precision;  ///< bytes
  std::size_t alternative;
};
constexpr std::array kNumberTypes{
    NumberType{"Float", 8, 0}, NumberType{"Float", 4, 1}, NumberType{"Char", 1, 2},
    NumberType{"UChar", 1, 3}, NumberType{"Short", 2, 4}, NumberType{"UShort", 2, 5},
    NumberType{"Int", 4, 6},   NumberType{"UInt", 4, 7},  NumberType{"Int", 8, 8},
    NumberType{"UInt", 8, 9},  NumberType{"Int", 1, 2},   NumberType{"UInt", 1, 3},
    NumberType{"Int", 2, 4},   NumberType{"UInt", 2, 5},
};

/// All text of an element. Only text in several pieces is copied.
class ElementText {
 public:
  explicit ElementText(pugi::xml_node element) {
    for (const pugi::xml_node child : element.children()) {
      if (child.type() != pugi::node_pcdata && child.type() != pugi::node_cdata) continue;
      if (!first_.empty() && joined_.empty()) joined_ = first_;
      if (first_.empty()) {
        first_ = child.value();
      } else {
        joined_ += child.value();
      }
    }
  }

  [[nodiscard]] std::string_view view() const { return joined_.empty() ? first_ : joined_; }

 private:
  std::string_view first_;
  std::string joined_;  // the pieces joined, if there are several
};

std::vector<std::uint64_t> shape_of(const Document& document, pugi::xml_node item) {
  std::vector<std::uint64_t> shape;
  const std::string dimensions = attribute(item, "Dimensions");
  std::string_view rest = dimensions;
  for (std::string_view word = next_word(rest, kXmlBlanks); !word.empty();
       word = next_word(rest, kXmlBlanks)) {
    std::uint64_t size = 0;
    if (!parse_xml_number(word, size)) {
      throw document.error(item, fmt::format("Dimensions is '{}'", dimensions.substr(0, 40)),
                           "whole numbers, such as 100 3, are needed");
    }
    shape.push_back(size);
  }
  if (shape.empty()) {
    throw document.error(item, "the DataItem has no Dimensions", "Dimensions=\"100 3\" is needed");
  }
  return shape;
}

/// Returns the number type of values in XML or in a binary file, as an alternative of Values.
std::size_t alternative_of(const Document& document, pugi::xml_node item) {
  const std::string type = attribute(item, "NumberType", "DataType");
  const auto precision = document.whole_number<int>(item, "Precision", 0);
  const auto found = std::find_if(kNumberTypes.begin(), kNumberTypes.end(), [&](const NumberType& known) {
    if (!same_but_for_case(known.name, type.empty() ? "Float" : type)) return false;
    const bool usual = known.precision == 4 || known.name.ends_with("Char") || known.name.ends_with("Short");
    return precision == 0 ? usual : known.precision == precision;
  });
  if (found == kNumberTypes.end()) {
    throw document.error(item,
                         fmt::format("the numbers are '{}'{}", type,
                                     precision == 0 ? "" : fmt::format(" of {} bytes", precision)),
                         "Float, Int, UInt, Char and UChar are supported");
  }
  return found->alternative;
}

/// Stores in `place` where the values of a DataItem are in a binary file.
void find_bytes(const Document& document, pugi::xml_node item, DataPlace& place) {
  place.file = without_xml_blanks(ElementText(item).view());
  const std::string order = attribute(item, "Endian");
  if (same_but_for_case(order, "Big")) place.order = std::endian::big;
  if (same_but_for_case(order, "Little")) place.order = std::endian::little;
  const std::string compression = attribute(item, "Compression");
  if (!compression.empty() && !same_but_for_case(compression, "Raw")) {
    throw document.error(item, fmt::format("the binary file is compressed ({})", compression.substr(0, 40)),
                         "write it without Compression");
  }
  place.seek = document.whole_number<std::uint64_t>(item, "Seek", 0);
}

/// Throws InputError if the XML gives a checksum and the values of a plain binary file have another checksum.
template <class Number>
void check_sum(const Document& document, const DataPlace& place, pugi::xml_node item,
               const std::vector<Number>& numbers) {
  const std::string_view expected = item.attribute(kValueMark).value();
  if (expected.empty()) return;
  Checksum sum;
  sum.add_all(numbers);
  if (expected == mark_of(sum.value())) return;
  throw NotTogether(document.error(
      item, fmt::format("'{}' was not written together with this file: its checksum differs", place.file),
      fmt::format("give the files of one mesh, or remove the attribute {} if they belong together",
                  kValueMark)));
}

/// Throws InputError if allocating `bytes` for values would exceed the memory limit.
void claim(const Document& document, pugi::xml_node item, std::uint64_t bytes) {
  const std::string fault = refused_claim(bytes, "the DataItem");
  if (!fault.empty()) throw document.error(item, fault, kClaimRemedy);
}

}  // namespace

std::pair<std::string, int> number_type_of(std::size_t alternative) {
  const auto found = std::find_if(kNumberTypes.begin(), kNumberTypes.end(),
                                  [&](const NumberType& type) { return type.alternative == alternative; });
  return {std::string(found->name), found->precision};
}

std::uint64_t DataPlace::count() const { return hdf5::DatasetInfo{shape, 0}.size(); }

void DataPlace::repeat(const DataPlace& other) {
  if (other.named_by != named_by) repeats.push_back({other.item, other.named_by});
}

std::string key_of(const DataPlace& place) {
  if (place.format == Format::hdf) return place.file + ":" + place.dataset;
  return std::to_string(place.item);
}

std::pair<std::string, std::string> split_hdf5_name(std::string_view text) {
  text = without_xml_blanks(text);
  std::size_t colon = text.find(":/");
  if (colon == std::string_view::npos) colon = text.rfind(':');
  if (colon == std::string_view::npos) return {};
  return {std::string(without_xml_blanks(text.substr(0, colon))),
          hdf5::normal_path(without_xml_blanks(text.substr(colon + 1)))};
}

DataPlace DataReader::place_of(pugi::xml_node item) {
  const std::size_t named_by = document_.number(item);
  item = document_.resolved(item);
  const std::string kind = attribute(item, "ItemType", "Type");
  if (!kind.empty() && !same_but_for_case(kind, "Uniform")) {
    throw document_.error(item, fmt::format("the DataItem is a {}", kind.substr(0, 40)),
                          "only whole arrays can be reordered: write the values as a separate array");
  }
  DataPlace place;
  place.item = document_.number(item);
  place.named_by = named_by;
  place.shape = shape_of(document_, item);
  const std::string format = attribute(item, "Format");
  if (same_but_for_case(format, "HDF") || same_but_for_case(format, "HDF5") ||
      same_but_for_case(format, "H5")) {
    place.format = DataPlace::Format::hdf;
    find_dataset(item, place);
    return place;
  }
  const bool is_binary = same_but_for_case(format, "Binary");
  if (!is_binary && !format.empty() && !same_but_for_case(format, "XML")) {
    throw document_.error(item, fmt::format("the Format is '{}'", format.substr(0, 40)),
                          "HDF, XML and Binary are supported");
  }
  place.alternative = alternative_of(document_, item);
  if (is_binary) {
    place.format = DataPlace::Format::binary;
    find_bytes(document_, item, place);
  }
  return place;
}

void DataReader::find_dataset(pugi::xml_node item, DataPlace& place) {
  const ElementText whole_text(item);
  const std::string_view text = whole_text.view();
  if (text.find('|') != std::string_view::npos) {
    throw document_.error(item, "the DataItem selects a part of a dataset",
                          "only whole arrays can be reordered: write the values as a separate array");
  }
  std::tie(place.file, place.dataset) = split_hdf5_name(text);
  if (place.file.empty()) {
    throw document_.error(item, fmt::format("'{}' names no dataset", text.substr(0, 100)),
                          "file.h5:/path is needed");
  }
  const hdf5::DatasetInfo info = file(item, place.file).info(place.dataset);
  if (info.size() != place.count()) {
    throw document_.error(item,
                          fmt::format("Dimensions is '{}', but '{}' in {} has {} values",
                                      attribute(item, "Dimensions"), place.dataset, place.file, info.size()),
                          "the XML and the HDF5 file may be of different runs");
  }
  place.alternative = info.alternative;
}

FilePath DataReader::path_of(pugi::xml_node item, const std::string& name) const {
  FilePath path = path_.beside(name);
  if (!may_include(path_, path)) {
    throw document_.error(item, fmt::format("the data file '{}' is not in the mesh's folder", name),
                          kIncludeRemedy);
  }
  if (!path.is_file()) {
    const char* const here = path.path().has_parent_path() ? "" : "./";
    throw document_.error(item, fmt::format("the data file '{}' is missing", name),
                          fmt::format("copy it to {}{}", here, path.string()));
  }
  return path;
}

const hdf5::File& DataReader::file(pugi::xml_node item, const std::string& name) {
  const auto known = files_.find(name);
  if (known != files_.end()) return known->second;
  hdf5::File opened = hdf5::File::open(path_of(item, name));
  const std::string mark = opened.text_attribute("/", kMark).value_or("");
  // the .xdmf file is put in place first: if the files are from two runs, the .xdmf file is the newer one and
  // has a mark
  if (!document_.mark().empty() && mark != document_.mark()) {
    throw NotTogether(document_.error(
        item, fmt::format("'{}' was not written together with this file: their marks differ", name),
        fmt::format("give the files of one mesh, or remove the line <?{}…?> if they belong together",
                    kMark)));
  }
  return files_.emplace(name, std::move(opened)).first->second;
}

Values DataReader::read(const DataPlace& place) {
  const pugi::xml_node item = document_.item(place.item);
  if (place.format == Format::hdf) return file(item, place.file).read(place.dataset);
  return place.format == Format::xml ? read_text(place, item) : read_binary(place, item);
}

std::vector<Index> DataReader::read_indices(const DataPlace& place) {
  const pugi::xml_node item = document_.item(place.item);
  constexpr std::size_t kFirstIntegral = 2;
  if (place.alternative < kFirstIntegral) {
    throw document_.error(item, "the DataItem does not hold whole numbers", "Int or UInt is needed");
  }
  if (place.format == Format::hdf) return file(item, place.file).read_indices(place.dataset);
  const Values values = read(place);
  std::vector<Index> indices;
  with_integers(values, [&](const auto& numbers) {
    reserve_large(indices, numbers.size());
    for (const auto number : numbers) {
      const Index limit = std::cmp_less(number, 0) ? std::numeric_limits<Index>::min() : kMaxIndex;
      indices.push_back(std::in_range<Index>(number) ? static_cast<Index>(number) : limit);
    }
  });
  return indices;
}

Values DataReader::read_text(const DataPlace& place, pugi::xml_node item) const {
  const ElementText whole_text(item);
  std::string_view text = whole_text.view();
  const std::uint64_t count = place.count();
  return numbers_of_type(place.alternative, [&]<class Number>(std::vector<Number>& numbers) {
    const std::uint64_t most = std::min<std::uint64_t>(count, text.size() / 2 + 1);
    claim(document_, item, bytes_for(most, sizeof(Number)));
    resize_large(numbers, most);
    const RegularNumbers regular = read_regular_numbers<Number>(text, numbers);
    numbers.resize(regular.count);
    text.remove_prefix(regular.bytes);
    for (std::string_view word = next_word(text, kXmlBlanks); !word.empty();
         word = next_word(text, kXmlBlanks)) {
      Number number{};
      const char* const end = word.data() + word.size();
      const auto [next, code] = std::from_chars(word.data() + (word.front() == '+' ? 1 : 0), end, number);
      if (code != std::errc{} || next != end) {
        throw document_.error(
            item, fmt::format("'{}' is not a number of the type", word.substr(0, 40)),
            fmt::format("value {} (counted from 0) is wrong or out of range", numbers.size()));
      }
      numbers.push_back(number);
    }
    if (numbers.size() != count) {
      throw document_.error(item, fmt::format("the DataItem has {} values", numbers.size()),
                            fmt::format("its Dimensions say {}", count));
    }
  });
}

Values DataReader::read_binary(const DataPlace& place, pugi::xml_node item) {
  auto known = binaries_.find(place.file);
  if (known == binaries_.end()) {
    known = binaries_.emplace(place.file, path_of(item, place.file).read()).first;
  }
  const std::string& bytes = known->second;
  const std::uint64_t count = place.count();
  const auto size = static_cast<std::uint64_t>(size_of_type(place.alternative));
  if (place.seek > bytes.size() || count > (bytes.size() - place.seek) / size) {
    throw document_.error(
        item, fmt::format("the file '{}' has {} bytes", place.file, bytes.size()),
        fmt::format("{} values of {} bytes from byte {} on are needed", count, size, place.seek));
  }
  return numbers_of_type(place.alternative, [&]<class Number>(std::vector<Number>& numbers) {
    claim(document_, item, bytes_for(count, sizeof(Number)));
    numbers.resize(count);
    if (count > 0) std::memcpy(numbers.data(), bytes.data() + place.seek, count * sizeof(Number));
    if (place.order != std::endian::native) {
      for (Number& number : numbers) number = swapped_bytes(number);
    }
    check_sum(document_, place, item, numbers);
  });
}

}  // namespace meshorder::xdmf
