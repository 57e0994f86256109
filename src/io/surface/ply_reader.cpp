// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "base/text.hpp"
#include "io/stream/number_reader.hpp"
#include "io/stream/regular_text.hpp"
#include "io/surface/ply_parts.hpp"
#include "io/surface/surface_data.hpp"
#include "mesh/cells.hpp"
#include "mesh/values.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <utility>

namespace meshorder::ply {
namespace {

constexpr std::string_view kRemedy = "a header line is like 'element vertex N' or 'property float x'";

// ---- header

TypeWord parse_type(const Scanner& scanner, std::string_view word) {
  for (std::size_t type = 0; type < kTypeWords.size(); ++type) {
    if (std::ranges::count(kTypeWords[type], word) > 0) return {std::string(word), static_cast<Type>(type)};
  }
  scanner.fail("the type '" + std::string(word.substr(0, 40)) + "' is unknown",
               "give char … double or int8 … float64");
}

Encoding parse_encoding(const Scanner& scanner, std::string_view line) {
  const std::string_view name = next_word(line);
  if (next_word(line) != "1.0") scanner.fail("the version of the format is unknown", "1.0 is supported");
  if (name == "ascii") return Encoding::ascii;
  if (name == "binary_little_endian") return Encoding::little_endian;
  if (name == "binary_big_endian") return Encoding::big_endian;
  scanner.fail("the encoding '" + std::string(name.substr(0, 40)) + "' is unknown",
               "ascii, binary_little_endian and binary_big_endian are supported");
}

Role role_of(std::string_view name) {
  if (name == "vertex") return Role::vertices;
  if (name == "face") return Role::faces;
  if (name == "edge") return Role::edges;
  if (name == "tristrips") return Role::strips;
  if (name == "multi_texture_face") return Role::rows_of_faces;
  for (const std::string_view word : {"tetra", "tet", "tets", "tetrahedra", "tetrahedron"}) {
    if (name == word) return Role::tetrahedra;
  }
  return Role::other;
}

Element parse_element(const Scanner& scanner, std::string_view line) {
  Element element;
  element.name = next_word(line);
  const auto count = parse_integer<std::int64_t>(scanner, next_word(line), "the number of an element");
  element.count = scanner.checked_count(count, "the number of " + element.name, 1);
  element.role = role_of(element.name);
  return element;
}

Property parse_property(const Scanner& scanner, std::string_view line) {
  Property property;
  std::string_view word = next_word(line);
  property.is_list = word == "list";
  if (property.is_list) {
    property.count_type = parse_type(scanner, next_word(line));
    if (!is_integer(property.count_type.type)) {
      scanner.fail("the length of a list is not an integer", "uchar or int is usual");
    }
    word = next_word(line);
  }
  property.type = parse_type(scanner, word);
  property.name = next_word(line);
  if (property.name.empty()) scanner.fail("a property has no name", std::string(kRemedy));
  return property;
}

/// Returns whether numbers of this type could refer to vertices or faces.
bool could_be_indices(const Property& property) {
  return is_integer(property.type.type) && property.type.type != Type::int8 &&
         property.type.type != Type::uint8;
}

bool has_part(std::string_view name, std::string_view part) {
  return name.find(part) != std::string_view::npos;
}

bool has(const Element& element, auto&& predicate) {
  return std::any_of(element.properties.begin(), element.properties.end(), predicate);
}

void check_cells_element(const Scanner& scanner, const Element& element) {
  if (element.role == Role::edges) {
    for (const int end : {0, 1}) {
      if (!has(element, [&](const Property& p) { return end_of(p) == end && is_integer(p.type.type); })) {
        scanner.fail("the element edge has no whole numbers vertex1 and vertex2", "edges need both");
      }
    }
    return;
  }
  if (!has(element, [](const Property& p) { return is_corner_list(p) && is_integer(p.type.type); })) {
    scanner.fail("the element " + element.name + " has no list vertex_indices of whole numbers",
                 "'property list uchar int vertex_indices' is usual");
  }
  if (std::count_if(element.properties.begin(), element.properties.end(), is_corner_list) > 1) {
    scanner.fail("the element " + element.name + " has both vertex_indices and vertex_index",
                 "one of them lists the vertices; give the other another name");
  }
}

/// Returns whether the name suggests numbers of vertices or faces: "vertex1", "face_index".
bool sounds_like_index(const Property& property) {
  if (!is_integer(property.type.type)) return false;
  const std::string name = "_" + property.name;
  return has_part(name, "_vert") || has_part(name, "_face") || has_part(name, "index") ||
         has_part(name, "indices");
}

/// Marks properties and elements as left out if they may depend on the order of vertices or faces in an
/// unknown way:
/// - lists of whole numbers;
/// - elements of other kinds that have such lists, or numbers named like an index;
/// - elements of other kinds with as many rows as vertices or cells.
///
/// @param known  the elements of vertices and cells, by their numbers of rows
void leave_out_dependent(Element& element, const std::map<Index, std::string>& known) {
  constexpr std::string_view kWhole = "holds whole numbers, which could be those of vertices or faces";
  if (element.role != Role::other) {
    if (element.role == Role::rows_of_faces) return;
    for (Property& property : element.properties) {
      if (property.is_list && could_be_indices(property) && !is_corner_list(property))
        property.why_left_out = kWhole;
    }
    return;
  }
  for (const std::string_view name : {"camera", "material", "multi_texture_vertex"}) {
    if (element.name == name) return;
  }
  for (const Property& property : element.properties) {
    if ((property.is_list && could_be_indices(property)) || sounds_like_index(property)) {
      element.why_left_out = fmt::format("its property '{}' {}", property.name, kWhole);
      return;
    }
  }
  const auto same = known.find(element.count);
  if (element.count < 2 || same == known.end()) return;
  element.why_left_out =
      fmt::format("it has as many rows as the element {}, to which they could belong", same->second);
}

/// Fails if properties are missing or contradict each other.
void check_element(const Scanner& scanner, const Element& element) {
  std::set<std::string_view> names;
  for (const Property& property : element.properties) {
    if (!names.insert(property.name).second) {
      scanner.fail("the element " + element.name + " has two properties '" + property.name + "'",
                   "names must differ");
    }
  }
  if (element.properties.empty() && element.count > 0) {
    scanner.fail("the element " + element.name + " has no properties", std::string(kRemedy));
  }
  if (element.role == Role::vertices) {
    for (const int k : {0, 1, 2}) {
      if (!has(element, [&](const Property& p) { return coordinate_of(p) == k; })) {
        scanner.fail("the element vertex lacks x, y or z", "vertices have three coordinates");
      }
    }
  } else if (holds_cells(element)) {
    check_cells_element(scanner, element);
  }
}

/// Moves to the first byte after the line of end_header.
void leave_header(Scanner& scanner) {
  const std::string_view all = scanner.all();
  const bool only_cr = all.size() > 4 && all[3] == '\r' && all[4] != '\n';
  const auto end = scanner.byte() + static_cast<std::int64_t>(scanner.peek_line().size());
  if (only_cr) {  // a line feed that follows is data
    scanner.seek(end + 1);
  } else {
    (void)scanner.raw_line();
  }
}

/// Keeps the role rows_of_faces only if the element follows the only element of faces and has as many rows.
void check_rows_of_faces(PlyMetadata& header) {
  const Element* faces = nullptr;
  Element* rows = nullptr;
  bool fit = true;
  for (Element& element : header.elements) {
    if (element.role == Role::faces) {
      fit = fit && faces == nullptr;
      faces = &element;
    } else if (element.role == Role::rows_of_faces) {
      fit = fit && rows == nullptr && faces != nullptr && faces->count == element.count;
      rows = &element;
    }
  }
  for (Element& element : header.elements) {
    if (element.role == Role::rows_of_faces && !fit) element.role = Role::other;
  }
}

void check_elements(const Scanner& scanner, PlyMetadata& header) {
  const auto count = [&](Role role) {
    return std::count_if(header.elements.begin(), header.elements.end(),
                         [&](const Element& element) { return element.role == role; });
  };
  if (count(Role::vertices) != 1)
    scanner.fail("the header has no element vertex, or several", "one is needed");
  check_rows_of_faces(header);
  if (count(Role::strips) > 0) {  // strips become an element 'face'
    std::erase_if(header.elements, [](const Element& e) { return e.role == Role::faces && e.count == 0; });
    if (count(Role::faces) > 0)
      scanner.fail("the header has the elements face and tristrips", "convert the strips to faces");
  }
  std::map<Index, std::string> known;
  for (const Element& element : header.elements) {
    if (element.role != Role::other) known.try_emplace(element.count, element.name);
  }
  for (Element& element : header.elements) {
    check_element(scanner, element);
    leave_out_dependent(element, known);
  }
}

void read_header(Scanner& scanner, PlyMetadata& header) {
  if (trimmed(scanner.peek_line()) != "ply")
    scanner.fail("the file does not begin with 'ply'", "a PLY file begins with it");
  (void)scanner.raw_line();
  bool has_format = false;
  while (scanner.bytes_left() > 0) {
    std::string_view line = scanner.peek_line();
    const std::string whole(trimmed(line));
    const std::string_view keyword = next_word(line);
    if (keyword == "end_header") {
      if (!has_format) scanner.fail("the header has no format", "'format ascii 1.0' is usual");
      check_elements(scanner, header);
      return leave_header(scanner);
    }
    if (keyword == "format") {
      header.encoding = parse_encoding(scanner, line);
      has_format = true;
    } else if (keyword == "comment" || keyword == "obj_info") {
      header.comments.push_back(whole);
    } else if (keyword == "element") {
      header.elements.push_back(parse_element(scanner, line));
    } else if (keyword == "property" && !header.elements.empty()) {
      header.elements.back().properties.push_back(parse_property(scanner, line));
    } else if (!keyword.empty()) {
      scanner.fail("'" + whole.substr(0, 40) + "' is not a header line", std::string(kRemedy));
    }
    (void)scanner.raw_line();
  }
  scanner.fail("unexpected end of file in the header", "it may be cut short");
}

// ---- body

/// Reads numbers of the body, from its own scanner or another of the same text.
struct BodyReader : NumberReader {
  using NumberReader::NumberReader;

  template <class T>
  T number(Scanner& in, std::string_view what) const {
    return binary ? in.binary<T>(what, order) : text_number<T>(in, what);
  }

  /// Reads a number of that type and converts it to T.
  template <class T>
  T number_as(Scanner& in, Type type, std::string_view what) const {
    // text may have more digits than a float
    if (!binary && type == Type::float32) type = Type::float64;
    return with_type(type, [&](auto zero) { return static_cast<T>(number<decltype(zero)>(in, what)); });
  }

  /// Reads the length of a list; fails if it is negative or exceeds the bytes that are left.
  Index list_length(Scanner& in, const Property& property) const {
    const auto length = number_as<std::int64_t>(in, property.count_type.type, "the length of a list");
    if (length < 0 || length > in.bytes_left() || length > kMaxIndex) {
      fail("the list " + property.name + " has the length " + std::to_string(length),
           "the file is damaged or cut short");
    }
    return static_cast<Index>(length);
  }

 private:
  template <class T>
  static T text_number(Scanner& in, std::string_view what) {
    if constexpr (std::is_integral_v<T>) {
      const auto value = in.integer<std::int64_t>(what);
      if (!std::in_range<T>(value)) {
        in.fail(std::string(what) + " is " + std::to_string(value), "the property's type cannot hold it");
      }
      return static_cast<T>(value);
    } else if constexpr (std::is_same_v<T, double>) {
      return in.real(what);
    } else {
      const std::string_view word = in.word(what);
      T value{};
      const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), value);
      if (code == std::errc{} && end == word.data() + word.size()) return value;
      return static_cast<T>(parse_real(in, word, what));
    }
  }
};

Values values_of(Type type) { return values_of_type(static_cast<std::size_t>(type)); }

/// The values of one property, grouped by length if they are lists.
struct Column {
  struct OfLength {
    std::vector<Index> rows;
    Values values;
  };
  std::map<Index, OfLength> by_length;

  void read(BodyReader& body, const Property& property, Index row) {
    const Index length = property.is_list ? body.list_length(body.scanner, property) : 1;
    auto found = by_length.find(length);
    if (found == by_length.end())
      found = by_length.insert({length, {{}, values_of(property.type.type)}}).first;
    with_numbers(found->second.values, [&]<class T>(std::vector<T>& list) {
      for (Index i = 0; i < length; ++i) list.push_back(body.number<T>(body.scanner, property.name));
    });
    if (property.is_list) found->second.rows.push_back(row);
  }
};

/// Returns the least bytes of an item; in text, a digit and a blank for each property.
std::int64_t min_bytes(const Element& element, const BodyReader& body) {
  std::int64_t bytes = 0;
  for (const Property& property : element.properties) {
    const TypeWord& first = property.is_list ? property.count_type : property.type;
    bytes += !body.binary ? 2 : size_of_type(static_cast<std::size_t>(first.type));
  }
  return bytes;
}

class Reader {
 public:
  explicit Reader(const FilePath& path) : body_(path) {
    read_header(body_.scanner, *header_);
    body_.binary = header_->encoding != Encoding::ascii;
    if (body_.binary) body_.scanner.keep_padding();
    body_.order = header_->encoding == Encoding::big_endian ? std::endian::big : std::endian::little;
    for (const Element& element : header_->elements) {
      if (element.role == Role::vertices) vertex_count_ = element.count;
      if (holds_cells(element) && element.count > 0) ++cell_elements_;
    }
  }

  Mesh read(Notes& notes) {
    for (Element& element : header_->elements) {
      (void)body_.scanner.checked_count(element.count, "the number of " + element.name,
                                        min_bytes(element, body_));
      const Index first_cell = mesh_.cell_count();
      if (element.role == Role::other) {
        read_other(element);
      } else {
        read_element(element);
      }
      if (element.role == Role::strips) become_faces(element, first_cell, notes);
    }
    const bool more = !body_.binary ? !body_.scanner.at_end() : body_.scanner.bytes_left() > 0;
    if (more) body_.fail("unexpected data after the last element", "the numbers of elements may be wrong");
    join_arrays_of_all_cells();
    mesh_.format_metadata = header_;
    return std::move(mesh_);
  }

 private:
  void read_element(Element& element) {
    const Index first = element.role == Role::vertices        ? 0
                        : element.role == Role::rows_of_faces ? first_face_
                                                              : mesh_.cell_count();
    if (element.role == Role::faces) first_face_ = first;
    if (element.role == Role::vertices) mesh_.points.resize(element.count);
    if (holds_cells(element) && cell_elements_ > 1 && element.count > 0) mesh_.cell_blocks.push_back(first);
    std::vector<Column> columns(element.properties.size());
    for (Index i = read_plain_rows(element, columns); i < element.count; ++i) {
      ends_ = {-1, -1};
      for (std::size_t k = 0; k < columns.size(); ++k) {
        const Property& property = element.properties[k];
        if (!read_geometry(element, property, i)) columns[k].read(body_, property, first + i);
      }
      if (element.role == Role::edges) mesh_.cells.push_back(Shape::line, ends_);
    }
    if (element.role == Role::strips) return;
    for (std::size_t k = 0; k < columns.size(); ++k) {
      Property& property = element.properties[k];
      property.numbers_rows = element.role == Role::rows_of_faces && property.name == "tn" &&
                              !property.is_list && counts_up(columns[k]);
      if (property.why_left_out.empty() && !property.numbers_rows)
        add_arrays(element, property, std::move(columns[k]), first);
    }
  }

  /// Reads rows of a text on all threads, up to the first row that is not a line of plain numbers or has more
  /// than four vertices. Returns the number of rows read: 0 for an element with lists besides that of
  /// vertices.
  Index read_plain_rows(const Element& element, std::vector<Column>& columns) {
    const bool has_few_lists =
        element.role != Role::strips && element.role != Role::rows_of_faces &&
        !has(element, [&](const Property& p) { return p.is_list && !is_geometry(element, p); });
    if (body_.binary || !has_few_lists || element.count == 0) return 0;
    const auto count = static_cast<std::size_t>(element.count);
    std::vector<Values*> values(columns.size(), nullptr);
    for (std::size_t k = 0; k < columns.size(); ++k) {
      if (is_geometry(element, element.properties[k])) continue;
      values[k] = &columns[k].by_length[1].values;
      *values[k] = values_of(element.properties[k].type.type);
      with_numbers(*values[k], [&](auto& list) { list.resize(count); });
    }
    Cells& cells = mesh_.cells;
    const Index first = cells.size();
    const bool has_cells = holds_cells(element);
    if (has_cells) append_cells(cells, Shape::quad, 4, element.count);
    const Index read = read_regular_records(body_.scanner, element.count, [&](Scanner& in, Index row) {
      for (std::size_t k = 0; k < columns.size(); ++k) {
        const Property& property = element.properties[k];
        if (values[k] != nullptr) {
          with_numbers(*values[k], [&]<class T>(std::vector<T>& list) {
            list[row] = body_.number<T>(in, property.name);
          });
        } else if (!has_cells) {
          read_coordinate(in, property, mesh_.points[row]);
        } else if (element.role == Role::edges) {
          cells.shapes[first + row] = Shape::line;
          cells[first + row][static_cast<std::size_t>(end_of(property))] = vertex(in, property);
        } else if (!read_small_cell(in, element, property, first + row)) {
          return false;
        }
      }
      return true;
    });
    for (Values* const list : values) {
      if (list != nullptr) with_numbers(*list, [&](auto& numbers) { numbers.resize(read); });
    }
    if (has_cells) trim_to_corners(cells, first, read);
    return read;
  }

  /// Returns whether `read_geometry` reads the property.
  static bool is_geometry(const Element& element, const Property& property) {
    if (element.role == Role::vertices) return coordinate_of(property) >= 0;
    if (element.role == Role::edges) return end_of(property) >= 0;
    return is_corner_list(property);
  }

  void read_coordinate(Scanner& in, const Property& property, Point& point) const {
    double& x = point[static_cast<std::size_t>(coordinate_of(property))];
    x = body_.number_as<double>(in, property.type.type, "a coordinate");
    if (!std::isfinite(x)) body_.fail("a coordinate is not finite", "a finite number is needed");
  }

  /// Reads the vertices of a cell into `mesh_`, which has room for four; returns false if their number is
  /// wrong.
  bool read_small_cell(Scanner& in, const Element& element, const Property& property, Index cell) {
    const Index length = body_.list_length(in, property);
    const bool is_tetrahedron = element.role == Role::tetrahedra;
    if (length < (is_tetrahedron ? 4 : 1) || length > 4) return false;
    mesh_.cells.shapes[cell] = is_tetrahedron ? Shape::tetrahedron : face_shape(length);
    for (Index& corner : mesh_.cells[cell].first(static_cast<std::size_t>(length)))
      corner = vertex(in, property);
    return true;
  }

  /// Returns whether the values are 0, 1, 2 …
  static bool counts_up(const Column& column) {
    return std::all_of(column.by_length.begin(), column.by_length.end(), [](const auto& part) {
      return with_integers(part.second.values, [](const auto& list) {
        for (std::size_t row = 0; row < list.size(); ++row) {
          if (!std::cmp_equal(list[row], row)) return false;
        }
        return true;
      });
    });
  }

  /// Turns the description of an element of triangle strips into a description of their triangles.
  void become_faces(Element& element, Index first_cell, Notes& notes) {
    element.name = "face";
    element.role = Role::faces;
    element.count = mesh_.cell_count() - first_cell;
    for (Property& property : element.properties) {
      if (is_corner_list(property)) {
        property.count_type = {"uchar", Type::uint8};
      } else {
        property.why_left_out = "belongs to whole strips";
      }
    }
    notes.push_back(
        fmt::format("the triangle strips became {} triangles, which are written as faces", element.count));
  }

  /// Reads a coordinate or vertices of a cell; returns false for every other property.
  bool read_geometry(const Element& element, const Property& property, Index i) {
    if (element.role == Role::vertices) {
      if (coordinate_of(property) < 0) return false;
      read_coordinate(body_.scanner, property, mesh_.points[i]);
      return true;
    }
    if (element.role == Role::edges) {
      const int end = end_of(property);
      if (end >= 0) ends_[end] = vertex(body_.scanner, property);
      return end >= 0;
    }
    if (element.role == Role::rows_of_faces || !is_corner_list(property)) return false;
    if (element.role == Role::strips) return read_strip(property);
    const Index length = body_.list_length(body_.scanner, property);
    if (length == 0) body_.fail("a " + element.name + " has no vertices", "at least one is needed");
    if (element.role == Role::tetrahedra && length != 4) {
      body_.fail("a tetrahedron has " + std::to_string(length) + " vertices", "four are needed");
    }
    corners_.resize(length);
    for (Index& corner : corners_) corner = vertex(body_.scanner, property);
    mesh_.cells.push_back(element.role == Role::tetrahedra ? Shape::tetrahedron : face_shape(length),
                          corners_);
    return true;
  }

  /// Reads the triangles of a list of strips, which −1 separates. Reverses every second triangle: all then
  /// face one way.
  bool read_strip(const Property& property) {
    std::array<Index, 3> last{};
    int known = 0;  // corners of the strip so far; from the third on, each makes a triangle
    for (Index left = body_.list_length(body_.scanner, property); left > 0; --left) {
      const auto number = body_.number_as<std::int64_t>(body_.scanner, property.type.type, "a vertex");
      if (number == -1) {
        known = 0;
        continue;
      }
      last = {last[1], last[2], checked_vertex(number)};
      if (++known < 3 || last[0] == last[1] || last[1] == last[2] || last[0] == last[2]) continue;
      const bool is_turned = known % 2 == 0;
      mesh_.cells.push_back(Shape::triangle, is_turned ? std::array{last[1], last[0], last[2]} : last);
    }
    return true;
  }

  Index vertex(Scanner& in, const Property& property) const {
    return checked_vertex(body_.number_as<std::int64_t>(in, property.type.type, "a vertex"));
  }

  [[nodiscard]] Index checked_vertex(std::int64_t index) const {
    if (index < 0 || index >= vertex_count_) {
      body_.fail("vertex " + std::to_string(index) + " does not exist",
                 "there are " + std::to_string(vertex_count_) + ", counted from 0");
    }
    return static_cast<Index>(index);
  }

  void add_arrays(const Element& element, const Property& property, Column column, Index first) {
    const Association association =
        element.role == Role::vertices ? Association::vertices : Association::cells;
    const bool all = association == Association::vertices || cell_elements_ == 1;
    for (auto& [length, part] : column.by_length) {
      if (length == 0) continue;  // empty lists need no array: the header names them
      std::vector<Index> rows = std::move(part.rows);
      if (!property.is_list && !all) {
        for (Index i = 0; i < element.count; ++i) rows.push_back(first + i);
      }
      if (all && index_size(rows) == element.count) rows.clear();
      mesh_.data.push_back(
          {array_name(element, property), association, length, std::move(part.values), std::move(rows), {}});
    }
  }

  /// Joins the arrays of a property into one if all elements of cells, such as faces and edges, have the
  /// property.
  void join_arrays_of_all_cells() {
    if (cell_elements_ < 2) return;
    for (std::size_t i = 0; i < mesh_.data.size(); ++i) {
      const auto joins = [&](std::size_t k) {
        const DataArray& a = mesh_.data[i];
        const DataArray& b = mesh_.data[k];
        return b.association == Association::cells && a.association == b.association && a.name == b.name &&
               a.components == 1 && b.components == 1 && a.values.index() == b.values.index();
      };
      std::vector<std::size_t> parts;
      Index rows = 0;
      for (std::size_t k = i; k < mesh_.data.size(); ++k) {
        if (!joins(k)) continue;
        parts.push_back(k);
        rows += row_count(mesh_.data[k]);
      }
      if (parts.size() < 2 || rows != mesh_.cell_count() || !are_scalar(mesh_.data[i].name)) continue;
      join(parts);
    }
  }

  [[nodiscard]] bool are_scalar(const std::string& name) const {
    return std::none_of(header_->elements.begin(), header_->elements.end(), [&](const Element& element) {
      return holds_cells(element) &&
             has(element, [&](const Property& p) { return p.is_list && p.name == name; });
    });
  }

  /// Joins the arrays at the positions `parts` into the first of them.
  void join(const std::vector<std::size_t>& parts) {
    DataArray& whole = mesh_.data[parts[0]];
    for (std::size_t p = 1; p < parts.size(); ++p)
      append_values(whole.values, std::move(mesh_.data[parts[p]].values));
    whole.indices.clear();
    for (std::size_t p = parts.size() - 1; p > 0; --p) {
      mesh_.data.erase(mesh_.data.begin() + static_cast<std::ptrdiff_t>(parts[p]));
    }
  }

  /// Reads an element that is kept verbatim.
  void read_other(Element& element) {
    const std::int64_t begin = body_.scanner.byte();
    for (Index i = 0; i < element.count; ++i) {
      for (const Property& property : element.properties) {
        const Index length = property.is_list ? body_.list_length(body_.scanner, property) : 1;
        if (!body_.binary && property.is_list) element.content += std::to_string(length) + " ";
        for (Index k = 0; k < length; ++k) {
          if (!body_.binary) {
            element.content += std::string(body_.scanner.word(property.name)) + " ";
          } else {
            (void)body_.number_as<double>(body_.scanner, property.type.type, property.name);
          }
        }
      }
      if (!body_.binary) element.content.back() = '\n';
    }
    if (body_.binary) {
      element.content = body_.scanner.all().substr(begin, body_.scanner.byte() - begin);
    }
  }

  std::shared_ptr<PlyMetadata> header_ = std::make_shared<PlyMetadata>();
  BodyReader body_;
  Mesh mesh_;
  Index vertex_count_ = 0;
  int cell_elements_ = 0;
  Index first_face_ = 0;
  std::array<Index, 2> ends_{};
  std::vector<Index> corners_;
};

}  // namespace

Mesh read(const FilePath& path, Notes& notes) { return Reader(path).read(notes); }

}  // namespace meshorder::ply
