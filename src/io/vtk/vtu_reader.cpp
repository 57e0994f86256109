// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Reader of VTK's XML files of unstructured grids:
// https://docs.vtk.org/en/latest/vtk_file_formats/vtkxml_file_format.html
//
// VTK's own reader is not used: it trusts the sizes in a header when it allocates, reads past the end of
// damaged arrays, cannot read the NaN that VTK writes as text, and reports faults on standard error.
#include "base/memory.hpp"
#include "io/stream/read_limits.hpp"
#include "io/vtk/vtk.hpp"
#include "io/vtk/vtu_document.hpp"
#include "mesh/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <type_traits>
#include <utility>

namespace meshorder::vtk {
namespace {

class VtuReader {
 public:
  VtuReader(const FilePath& path, Notes& notes) : path_(path), notes_(notes) {}

  Mesh read() {
    const VtuDocument file(path_);
    const char* const root = file.lists_pieces() ? "PUnstructuredGrid" : "UnstructuredGrid";
    const VtuElement* grid = file.root().child(root);
    if (grid == nullptr)
      throw file.error(file.root(), fmt::format("there is no <{}>", root), "the file may be cut short");
    if (file.lists_pieces()) {
      read_listed(file, *grid);
      file_ = &file;
      types_ = nullptr;  // it pointed into a file that is now closed
      join(*grid);
    } else {
      read_grid(file, *grid);
      if (pieces_ > 1) notes_.push_back(fmt::format("the {} pieces of the file became one", pieces_));
    }
    finish(*grid);
    return std::move(mesh_);
  }

 private:
  /// Reads the pieces of a file.
  void read_grid(const VtuDocument& file, const VtuElement& grid) {
    file_ = &file;
    is_first_ = !metadata_->vtu.has_value();
    if (is_first_) metadata_->vtu = file.encoding();
    if (pieces_ == 0) version_ = file.version();
    for (const VtuElement& element : grid.children) {
      if (element.name == "FieldData") {
        read_fields(element);
      } else if (element.name == "Piece") {
        pieces_ += read_piece(element) ? 1 : 0;
      } else {
        note_unknown(element);
      }
    }
  }

  /// Reads the files that a .pvtu file lists.
  void read_listed(const VtuDocument& list, const VtuElement& grid) {
    bool any = false;
    const std::size_t notes_before = notes_.size();
    for (const VtuElement& element : grid.children) {
      if (element.name != "Piece") continue;
      any = true;
      const std::string& source = list.required(element, "Source");
      const FilePath path = path_.beside(source);
      if (!may_include(path_, path)) {
        throw list.error(element, "the piece '" + source + "' is not in the folder of the file",
                         kIncludeRemedy);
      }
      if (!path.is_file())
        throw list.error(element, "the piece '" + source + "' does not exist", "all pieces are needed");
      const VtuDocument file(path);
      const VtuElement* const piece = file.root().child("UnstructuredGrid");
      if (piece == nullptr)
        throw file.error(file.root(), "there is no <UnstructuredGrid>", "a piece holds a part of the mesh");
      if (pieces_ > 0 && (file.version() < kNewOrder) != (version_ < kNewOrder)) {
        throw file.error(
            file.root(), "of this piece and the one before, only one has a version below 2.1",
            "VTK numbers nodes of higher order differently since 2.1; save all pieces in one version");
      }
      read_grid(file, *piece);
    }
    if (!any) throw list.error(grid, "the file lists no pieces", "it may be cut short");
    // a note that several pieces cause appears once
    Notes of_pieces(notes_.begin() + static_cast<std::ptrdiff_t>(notes_before), notes_.end());
    notes_.resize(notes_before);
    for (std::string& note : of_pieces) {
      const auto first = notes_.begin() + static_cast<std::ptrdiff_t>(notes_before);
      if (std::find(first, notes_.end(), note) == notes_.end()) notes_.push_back(std::move(note));
    }
  }

  /// Makes one mesh of the pieces that were listed.
  void join(const VtuElement& grid) {
    check_arrays(grid, index_size(cells_.types));
    join_pieces(
        {mesh_.points, cells_, arrays_, metadata_->roles},
        [&](const std::string& what, const std::string& remedy) { return file_->error(grid, what, remedy); },
        notes_);
  }

  /// Throws unless every array has a row for each point, or for each of `cells` cells.
  void check_arrays(const VtuElement& grid, Index cells) const {
    for (const DataArray& array : arrays_) {
      const Index needed = array.association == Association::vertices ? mesh_.vertex_count() : cells;
      if (row_count(array) != needed)
        throw file_->error(grid, "the array '" + array.name + "' is missing in a piece",
                           "all pieces have the same arrays");
    }
  }

  void note_unknown(const VtuElement& element) {
    notes_.push_back("the element <" + element.name + "> is ignored");
  }

  static bool is_array(const VtuElement& element) {
    return element.name == "DataArray" || element.name == "Array";
  }

  /// Reads a piece; returns false if it is empty.
  bool read_piece(const VtuElement& piece) {
    const std::int64_t points = file_->count(piece, "NumberOfPoints");
    const std::int64_t cells = file_->count(piece, "NumberOfCells");
    if (points == 0 && cells == 0) return false;
    if (points + mesh_.vertex_count() > kMaxIndex || cells + index_size(cells_.types) > kMaxIndex) {
      throw file_->error(piece, "the pieces have too many points or cells",
                         "at most 2147483647 are possible");
    }
    const Index first_point = mesh_.vertex_count();
    for (const VtuElement& element : piece.children) {
      if (element.name == "PointData" || element.name == "CellData") {
        const Association association =
            element.name == "PointData" ? Association::vertices : Association::cells;
        read_data(element, association, association == Association::vertices ? points : cells);
      } else if (element.name != "Points" && element.name != "Cells") {
        note_unknown(element);
      }
    }
    read_points(piece, points);
    read_cells(piece, cells, first_point);
    return true;
  }

  void read_points(const VtuElement& piece, std::int64_t count) {
    if (count == 0) return;
    const VtuElement* element = piece.child("Points");
    const bool one = element != nullptr &&
                     std::count_if(element->children.begin(), element->children.end(), is_array) == 1;
    if (!one)
      throw file_->error(element != nullptr ? *element : piece, "<Points> with one array is missing",
                         "each piece has its points");
    const VtuElement& array = *std::find_if(element->children.begin(), element->children.end(), is_array);
    if (file_->components(array) != 3)
      throw file_->error(array, "the points have " + std::to_string(file_->components(array)) + " components",
                         "3 are needed");
    const Values values = file_->values(array, 3 * count);
    if (mesh_.points.empty()) {
      metadata_->float_points = std::holds_alternative<std::vector<float>>(values);
      metadata_->vtu->mode = file_->mode(array);
    }
    if (are_texts(values))
      throw file_->error(array, "the points are strings", "Float32 or Float64 is needed");
    if (values.index() > 1) notes_.push_back("the points are integers and are stored as Float64");
    add_points(mesh_.points, values, [&](std::size_t p) {
      return file_->error(array,
                          fmt::format("point {} (counted from 0) has a coordinate that is not finite", p),
                          "finite numbers are needed");
    });
  }

  /// Returns the array of that name, null if there is none.
  [[nodiscard]] static const VtuElement* find_cell_array(const VtuElement& cells, std::string_view name) {
    const auto found =
        std::find_if(cells.children.begin(), cells.children.end(), [&](const VtuElement& element) {
          const std::string* own = element.attribute("Name");
          return is_array(element) && own != nullptr && *own == name;
        });
    return found == cells.children.end() ? nullptr : &*found;
  }

  [[nodiscard]] const VtuElement& cell_array(
      const VtuElement& cells, std::string_view name,
      const char* needed = "connectivity, offsets and types are needed") const {
    const VtuElement* const found = find_cell_array(cells, name);
    if (found == nullptr)
      throw file_->error(cells, fmt::format("the array {} is missing in <Cells>", name), needed);
    refuse_time_steps(*found);
    return *found;
  }

  void read_cells(const VtuElement& piece, std::int64_t count, Index first_point) {
    if (count == 0) return;
    const VtuElement* cells = piece.child("Cells");
    if (cells == nullptr) throw file_->error(piece, "<Cells> is missing", "each piece has its cells");
    types_ = &cell_array(*cells, "types");

    const Offset last = append_ends(cell_array(*cells, "offsets"), count, "cell", cells_.offsets);
    append_points(cell_array(*cells, "connectivity"), last, first_point, cells_.vertices);

    append_integers(*types_, count, cells_.types, [&](std::int64_t c, auto type) {
      if (std::cmp_less(type, 0) || std::cmp_greater(type, 255)) {
        throw file_->error(*types_, fmt::format("cell {} (counted from 0) has the type {}", c, type),
                           "VTK's types run from 0 to 81");
      }
      return static_cast<std::uint8_t>(type);
    });
    read_polyhedra(*cells, count, first_point);
  }

  /// Appends the `count` ends of an array to `ends`. The array's ends count from 0; each is increased by the
  /// old last entry of `ends`. Returns the array's last end. Messages call an item a `thing`.
  Offset append_ends(const VtuElement& array, std::int64_t count, const char* thing,
                     std::vector<Offset>& ends) {
    const Offset first = ends.back();
    Offset last = 0;
    append_integers(array, count, ends, [&](std::int64_t k, auto end) {
      if (!std::in_range<Offset>(end) || std::cmp_less(end, last)) {
        throw file_->error(
            array,
            fmt::format("{} {} (counted from 0) ends at {}, before it begins at {}", thing, k, end, last),
            "offsets must ascend");
      }
      last = static_cast<Offset>(end);
      return first + last;
    });
    return last;
  }

  void append_points(const VtuElement& array, std::int64_t count, Index first_point,
                     std::vector<Index>& target) {
    const Index points = mesh_.vertex_count() - first_point;
    append_integers(array, count, target, [&](std::int64_t, auto point) {
      if (std::cmp_less(point, 0) || std::cmp_greater_equal(point, points)) {
        throw file_->error(array, fmt::format("a cell names the point {}", point),
                           fmt::format("the piece has points 0 to {}", points - 1));
      }
      return first_point + static_cast<Index>(point);
    });
  }

  // ---- polyhedra

  void read_polyhedra(const VtuElement& cells, std::int64_t count, Index first_point) {
    Polyhedra& polyhedra = cells_.polyhedra;
    const auto first_cell = static_cast<std::int64_t>(cells_.types.size()) - count;
    const bool any =
        std::find(cells_.types.begin() + first_cell, cells_.types.end(), kPolyhedron) != cells_.types.end();
    if (!any && polyhedra.empty()) return;
    if (polyhedra.empty()) polyhedra.starts.assign(static_cast<std::size_t>(first_cell) + 1, 0);
    if (!any) {
      polyhedra.starts.resize(cells_.types.size() + 1, polyhedra.starts.back());
    } else if (find_cell_array(cells, "polyhedron_to_faces") != nullptr) {
      polyhedra.are_by_face = true;
      read_polyhedra_by_face(cells, count, first_cell, first_point);
    } else {
      read_streams_of_faces(cells, count, first_cell, first_point);
    }
  }

  /// Reads polyhedra as VTK wrote them up to 9.3: the numbers of `Polyhedra`, and for each cell the end of
  /// its numbers; −1 if the cell is not a polyhedron.
  void read_streams_of_faces(const VtuElement& cells, std::int64_t count, std::int64_t first_cell,
                             Index first_point) {
    constexpr const char* kNeeded = "polyhedra have faces and faceoffsets";
    const VtuElement& offsets = cell_array(cells, "faceoffsets", kNeeded);
    const VtuElement& faces = cell_array(cells, "faces", kNeeded);
    Polyhedra& polyhedra = cells_.polyhedra;
    const Offset first = polyhedra.starts.back();
    Offset last = 0;
    append_integers(offsets, count, polyhedra.starts, [&](std::int64_t c, auto end) {
      if (cells_.types[static_cast<std::size_t>(first_cell + c)] != kPolyhedron) return first + last;
      if (!std::in_range<Offset>(end) || std::cmp_less_equal(end, last)) {
        throw file_->error(
            offsets, fmt::format("the faces of cell {} (counted from 0), a polyhedron, end at {}", c, end),
            fmt::format("more than {} is needed, where they begin", last));
      }
      last = static_cast<Offset>(end);
      return first + last;
    });
    append_integers(faces, last, polyhedra.numbers, [&](std::int64_t, auto number) {
      if (!std::in_range<Index>(number)) {
        throw file_->error(faces, fmt::format("a number of faces, corners or a point is {}", number),
                           "it is too large");
      }
      return static_cast<Index>(number);
    });
    const Index points = mesh_.vertex_count() - first_point;
    for (std::int64_t c = first_cell; c < first_cell + count; ++c) {
      const auto at = static_cast<std::size_t>(c);
      const std::span<Index> numbers(polyhedra.numbers.data() + polyhedra.starts[at],
                                     polyhedra.numbers.data() + polyhedra.starts[at + 1]);
      if (cells_.types[at] != kPolyhedron) continue;
      if (!are_faces(numbers)) {
        throw file_->error(
            faces,
            fmt::format("cell {} (counted from 0), a polyhedron, has faces that do not fit its {} numbers",
                        c - first_cell, numbers.size()),
            "the number of its faces is needed, then of each face the number of its corners and these");
      }
      for_faces(numbers, [&](std::span<Index> corners) {
        for (Index& corner : corners) {
          if (corner < 0 || corner >= points) {
            throw file_->error(faces, fmt::format("a face names the point {}", corner),
                               fmt::format("the piece has points 0 to {}", points - 1));
          }
          corner += first_point;
        }
      });
    }
  }

  /// Reads polyhedra as VTK writes them since 9.4: the corners of all faces, and the faces of each cell.
  void read_polyhedra_by_face(const VtuElement& cells, std::int64_t count, std::int64_t first_cell,
                              Index first_point) {
    constexpr const char* kNeeded =
        "polyhedra have face_connectivity, face_offsets, polyhedron_to_faces and polyhedron_offsets";
    const VtuElement& corner_ends = cell_array(cells, "face_offsets", kNeeded);
    std::vector<Offset> corner_starts{0};
    const Offset corner_count =
        append_ends(corner_ends, file_->value_count(corner_ends), "face", corner_starts);
    std::vector<Index> corners;
    append_points(cell_array(cells, "face_connectivity", kNeeded), corner_count, first_point, corners);
    std::vector<Offset> face_starts{0};
    const Offset face_count =
        append_ends(cell_array(cells, "polyhedron_offsets", kNeeded), count, "cell", face_starts);
    const VtuElement& faces_of_cells = cell_array(cells, "polyhedron_to_faces", kNeeded);
    std::vector<Index> faces;
    auto size = static_cast<std::uint64_t>(count);  // how many numbers all polyhedra have
    append_integers(faces_of_cells, face_count, faces, [&](std::int64_t, auto face) {
      if (std::cmp_less(face, 0) || std::cmp_greater_equal(face, corner_starts.size() - 1)) {
        throw file_->error(faces_of_cells, fmt::format("a polyhedron names the face {}", face),
                           fmt::format("the piece has faces 0 to {}", corner_starts.size() - 2));
      }
      const auto f = static_cast<std::size_t>(face);
      size += static_cast<std::uint64_t>(1 + corner_starts[f + 1] - corner_starts[f]);
      return static_cast<Index>(face);
    });
    file_->claim(faces_of_cells, bytes_for(size, sizeof(Index)));  // many cells may share a face

    Polyhedra& polyhedra = cells_.polyhedra;
    polyhedra.numbers.reserve(polyhedra.numbers.size() + size);
    for (std::size_t c = 0; c + 1 < face_starts.size(); ++c) {
      const bool is_polyhedron = cells_.types[static_cast<std::size_t>(first_cell) + c] == kPolyhedron;
      const Offset own_count = is_polyhedron ? face_starts[c + 1] - face_starts[c] : 0;
      const auto own = std::span(faces).subspan(static_cast<std::size_t>(face_starts[c]),
                                                static_cast<std::size_t>(own_count));
      if (is_polyhedron) polyhedra.numbers.push_back(static_cast<Index>(own.size()));
      for (const Index face : own) {
        const auto f = static_cast<std::size_t>(face);
        polyhedra.numbers.push_back(static_cast<Index>(corner_starts[f + 1] - corner_starts[f]));
        polyhedra.numbers.insert(polyhedra.numbers.end(), corners.begin() + corner_starts[f],
                                 corners.begin() + corner_starts[f + 1]);
      }
      polyhedra.starts.push_back(static_cast<Offset>(polyhedra.numbers.size()));
    }
  }

  /// Appends `checked(i, number)` for every number of an array. If `target` is empty and has the array's
  /// type, reuses the array's memory.
  template <class Number, class Checked>
  void append_integers(const VtuElement& array, std::int64_t count, std::vector<Number>& target,
                       const Checked& checked) {
    if (file_->components(array) != 1)
      throw file_->error(array, "the array has several components", "1 is needed");
    Values values = file_->values(array, count);
    if (!are_integers(values))
      throw file_->error(array, "the array does not hold integers", "Int32 or Int64 is usual");
    with_integers(values, [&]<class Stored>(std::vector<Stored>& numbers) {
      const std::span<const Stored> from = numbers;
      const std::size_t first = target.size();
      if constexpr (std::is_same_v<Stored, Number>) {
        if (target.empty()) target.swap(numbers);
      }
      resize_large(target, first + from.size());
      std::int64_t i = 0;
      std::transform(from.begin(), from.end(), target.begin() + static_cast<std::ptrdiff_t>(first),
                     [&](Stored number) { return checked(i++, number); });
    });
  }

  /// Throws InputError for an array of a time step after the first; notes that the first step's time is left
  /// out.
  void refuse_time_steps(const VtuElement& array) const {
    const std::string* const step = array.attribute("TimeStep");
    if (step == nullptr) return;
    if (without_xml_blanks(*step) != "0")
      throw file_->error(array, "the file holds several time steps", "save each step as a separate file");
    const char* const note = "the time of the only step is left out";
    if (std::find(notes_.begin(), notes_.end(), note) == notes_.end()) notes_.emplace_back(note);
  }

  /// Reads an array of PointData, CellData or FieldData.
  DataArray read_array(const VtuElement& element, std::optional<Association> association,
                       std::int64_t tuples) {
    refuse_time_steps(element);
    DataArray array;
    array.name = file_->required(element, "Name");
    array.association = association.value_or(Association::vertices);
    const std::int64_t components = file_->components(element);
    if (components < 1) throw file_->error(element, "the array has no components", "at least 1 is needed");
    array.components = static_cast<Index>(components);
    array.values = file_->values(element, tuples * components);
    if (*element.attribute("type") == "Bit")
      notes_.push_back("the array '" + array.name + "' holds bits, which are stored as bytes");
    for (std::int64_t i = 0; i < components && i < 64; ++i) {
      const std::string* name = element.attribute("ComponentName" + std::to_string(i));
      if (name == nullptr) continue;
      if (array.component_names.empty()) {
        file_->claim(element, bytes_for(static_cast<std::uint64_t>(components), sizeof(std::string)));
        array.component_names.resize(static_cast<std::size_t>(components));
      }
      array.component_names[static_cast<std::size_t>(i)] = *name;
    }
    read_facts(element, association, array);
    return array;
  }

  void read_facts(const VtuElement& element, std::optional<Association> association, const DataArray& array) {
    ArrayFacts facts{association, array.name, {}, {}, {}};
    const std::string* id = element.attribute("IdType");
    if (id != nullptr && without_xml_blanks(*id) == "1" &&
        std::holds_alternative<std::vector<std::int64_t>>(array.values))
      facts.type = "vtkIdType";
    for (const VtuElement& key : element.children) {
      const std::string* name = key.attribute("name");
      if (name != nullptr && name->starts_with("L2_NORM")) continue;  // VTK computes it
      facts.xml_information += file_->source(key) + "\n";
    }
    if (!facts.type.empty() || !facts.xml_information.empty())
      metadata_->facts.try_emplace({association, array.name}, std::move(facts));
  }

  void read_fields(const VtuElement& fields) {
    for (const VtuElement& element : fields.children) {
      if (!is_array(element)) {
        note_unknown(element);
        continue;
      }
      DataArray field = read_array(element, {}, file_->count(element, "NumberOfTuples"));
      const auto [known, is_new] = fields_.try_emplace(field.name, metadata_->fields.size());
      if (is_first_ || is_new) {
        metadata_->fields.push_back(std::move(field));
      } else if (metadata_->fields[known->second].values != field.values) {
        notes_.push_back("left out: the field '" + field.name +
                         "' of pieces where it differs from the first's");
      }
    }
  }

  void read_data(const VtuElement& section, Association association, std::int64_t tuples) {
    for (std::size_t role = 0; role < kXmlRoles.size(); ++role) {
      const std::string* name = section.attribute(kXmlRoles[role]);
      if (name == nullptr || name->empty()) continue;
      const auto kind = static_cast<Role>(role);
      const bool known = std::any_of(
          metadata_->roles.begin(), metadata_->roles.end(),
          [&](const ArrayRole& other) { return other.role == kind && other.association == association; });
      if (!known) metadata_->roles.push_back({kind, association, *name, {}});
    }
    std::set<std::string> names;
    for (const VtuElement& element : section.children) {
      if (!is_array(element)) {
        note_unknown(element);
        continue;
      }
      DataArray array = read_array(element, association, tuples);
      if (!names.insert(array.name).second)
        throw file_->error(element, "the array '" + array.name + "' is given twice", "names must differ");
      const auto [known, is_new] = places_.try_emplace({association, array.name}, arrays_.size());
      if (is_new) {
        arrays_.push_back(std::move(array));
        continue;
      }
      DataArray& before = arrays_[known->second];
      if (before.components != array.components || before.values.index() != array.values.index()) {
        throw file_->error(element,
                           "the array '" + array.name + "' is of another type than in the piece before",
                           "all pieces have the same arrays");
      }
      append_values(before.values, std::move(array.values));
    }
  }

  void finish(const VtuElement& grid) {
    const bool old_order = version_ < kNewOrder &&
                           std::any_of(cells_.types.begin(), cells_.types.end(), is_higher_order_hexahedron);
    const std::vector<std::uint8_t> types = old_order ? cells_.types : std::vector<std::uint8_t>{};
    const VtuElement& at = types_ != nullptr ? *types_ : grid;
    metadata_->inward_wedges = take_cells(
        mesh_, cells_,
        [&](const std::string& what, const std::string& remedy) { return file_->error(at, what, remedy); },
        notes_);
    metadata_->polyhedra = std::move(cells_.polyhedra);
    check_arrays(grid, mesh_.cell_count());
    for (DataArray& array : arrays_) add_array(mesh_, std::move(array));
    if (old_order) swap_hexahedron_edges(mesh_, types, mesh_.cells);
    mesh_.format_metadata = metadata_;
  }

  /// Ten times the file version since which VTK numbers the nodes of higher-order hexahedra differently.
  static constexpr int kNewOrder = 21;

  const FilePath& path_;
  Notes& notes_;
  const VtuDocument* file_ = nullptr;          ///< the file that is being read
  int version_ = 0;                            ///< version of the first file that is not empty, times ten
  std::map<std::string, std::size_t> fields_;  ///< indices of the fields, by name
  bool is_first_ = true;                       ///< whether the file that is being read is the first
  int pieces_ = 0;                             ///< number of pieces that are not empty
  Mesh mesh_;
  std::shared_ptr<VtkMetadata> metadata_ = std::make_shared<VtkMetadata>();
  std::vector<DataArray> arrays_;
  std::map<std::pair<Association, std::string>, std::size_t> places_;  // indices in `arrays_`, by name
  FileCells cells_;
  const VtuElement* types_ = nullptr;
};

}  // namespace

Mesh read_vtu(const FilePath& path, Notes& notes) { return VtuReader(path, notes).read(); }

}  // namespace meshorder::vtk
