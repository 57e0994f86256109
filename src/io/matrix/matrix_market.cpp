// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Square sparse matrices as Matrix Market's coordinate files. Format: R. Boisvert, R. Pozo and K. Remington,
// "The Matrix Market exchange formats: initial design", NISTIR 5935 (1996).
#include "base/memory.hpp"
#include "base/text.hpp"
#include "io/all_formats.hpp"
#include "io/matrix/matrix.hpp"
#include "io/stream/output_file.hpp"
#include "io/stream/regular_text.hpp"
#include "io/stream/scanner.hpp"
#include "io/stream/text_ends.hpp"
#include "io/stream/text_rows.hpp"
#include "io/unsupported.hpp"
#include "mesh/cells.hpp"
#include "mesh/stored_matrix.hpp"
#include "mesh/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>
#include <variant>

namespace meshorder {
namespace matrix {

enum class Field : std::uint8_t { pattern, real, integer, complex };
enum class Symmetry : std::uint8_t { general, symmetric, skew_symmetric, hermitian };

}  // namespace matrix

template <>
struct EnumNames<matrix::Field> {
  static constexpr std::string_view kind = "field";
  static constexpr std::array names{
      std::pair{matrix::Field::pattern, "pattern"}, std::pair{matrix::Field::real, "real"},
      std::pair{matrix::Field::integer, "integer"}, std::pair{matrix::Field::complex, "complex"}};
};

template <>
struct EnumNames<matrix::Symmetry> {
  static constexpr std::string_view kind = "symmetry";
  static constexpr std::array names{std::pair{matrix::Symmetry::general, "general"},
                                    std::pair{matrix::Symmetry::symmetric, "symmetric"},
                                    std::pair{matrix::Symmetry::skew_symmetric, "skew-symmetric"},
                                    std::pair{matrix::Symmetry::hermitian, "hermitian"}};
};

namespace matrix {
namespace {

constexpr std::string_view kName = "MatrixMarket";
constexpr std::string_view kBanner = "%%MatrixMarket";

/// Data of a file beyond the matrix.
struct MatrixMetadata final : StoredMatrix {
  Symmetry stored_as = Symmetry::general;
  std::string comments;  ///< the comment lines after the first line

  [[nodiscard]] std::vector<std::string> contents() const override {
    std::vector<std::string> result;
    if (is_half) {
      result.push_back(fmt::format("the storage of one half of the {} matrix", symmetry));
    }
    if (!comments.empty()) result.emplace_back("the matrix's comments");
    return result;
  }
};

// ---- reading

/// Returns the enumerator of that name, case ignored; fails at the scanner's line if there is none.
template <NamedEnum Enum>
Enum parse_word(const Scanner& at, std::string_view word) {
  for (const auto& [value, name] : EnumNames<Enum>::names) {
    if (same_but_for_case(word, name)) return value;
  }
  at.fail(fmt::format("the {} of the matrix is '{}'", EnumNames<Enum>::kind, shown(word)),
          "known: " + names_of<Enum>());
}

class MatrixReader {
 public:
  MatrixReader(const FilePath& path, Notes& notes) : in_(path, '%'), notes_(notes) {}

  Mesh read() {
    read_banner();
    read_sizes();
    const auto begin_of_entries = static_cast<std::size_t>(in_.byte());
    read_entries();
    if (!in_.at_end()) in_.fail("more entries than the count says", "the count is wrong");
    if (in_.last_comment() > begin_of_entries)
      notes_.push_back(in_.file() + ": comments between the entries are left out");
    note_missing_line_end(in_, '%', notes_);
    if (!metadata_->is_half && !is_symmetric(entry_pattern(mesh_))) {
      notes_.push_back("the pattern of the matrix A is not symmetric: orders use that of A + A'");
    }
    if (field_ != Field::pattern) {
      const Index components = field_ == Field::complex ? 2 : 1;
      mesh_.data.push_back(
          {std::string(kValue),
           Association::cells,
           components,
           field_ == Field::integer ? Values(std::move(integers_)) : Values(std::move(reals_)),
           {},
           {}});
    }
    mesh_.format_metadata = metadata_;
    return std::move(mesh_);
  }

 private:
  void read_banner() {
    std::string_view line = in_.peek_line();
    if (!same_but_for_case(next_word(line), kBanner)) {
      in_.fail("is not a Matrix Market file", "its first line must begin with %%MatrixMarket");
    }
    if (const std::string_view object = next_word(line); !same_but_for_case(object, "matrix")) {
      in_.fail(fmt::format("holds a '{}'", shown(object)), "only a matrix can be ordered");
    }
    if (const std::string_view layout = next_word(line); !same_but_for_case(layout, "coordinate")) {
      in_.fail(fmt::format("the matrix is stored as '{}'", shown(layout)),
               "only sparse matrices, stored as 'coordinate', can be ordered");
    }
    field_ = parse_word<Field>(in_, next_word(line));
    metadata_->stored_as = parse_word<Symmetry>(in_, next_word(line));
    metadata_->field = to_string(field_);
    metadata_->symmetry = to_string(metadata_->stored_as);
    metadata_->is_half = metadata_->stored_as != Symmetry::general;
    if (const std::string_view more = next_word(line); !more.empty()) {
      in_.fail(fmt::format("the first line continues with '{}'", shown(more)), "it should end there");
    }
    (void)in_.raw_line();
    while (in_.bytes_left() > 0) {
      const std::string_view next = trimmed(in_.peek_line());
      if (!next.empty() && next.front() != '%') break;
      metadata_->comments.append(in_.raw_line()) += '\n';
    }
  }

  void read_sizes() {
    if (!in_.at_end() && in_.words_in_line() < 3) {
      in_.fail(fmt::format("the line of sizes has {} number{}", in_.words_in_line(),
                           in_.words_in_line() == 1 ? "" : "s"),
               "three are needed: rows, columns and entries");
    }
    const auto rows = in_.integer<std::int64_t>("the number of rows");
    const auto columns = in_.integer<std::int64_t>("the number of columns");
    if (rows != columns) {
      in_.fail(fmt::format("the matrix has {} rows and {} columns", rows, columns),
               "only a square matrix can be ordered");
    }
    entries_ = in_.count("the number of entries", 4);
    if (!in_.at_line_end())
      in_.fail("the line of sizes has too many numbers", "three are needed: rows, columns and entries");
    // a large number of rows must not exceed the number of bytes that follow
    constexpr std::int64_t kFewRows = 1 << 20;
    if (rows < 0 || rows > kFewRows) (void)in_.checked_count(rows, "the number of rows", 1);
    claim_vertices(static_cast<Index>(rows));
    mesh_.points.resize(rows, {0, 0, 0});
  }

  void read_entries() {
    Cells& cells = mesh_.cells;
    const Index rows = mesh_.vertex_count();
    const std::size_t reals_of_entry = field_ == Field::complex ? 2 : field_ == Field::real ? 1 : 0;
    const bool has_integer = field_ == Field::integer;
    append_cells(cells, Shape::line, 2, entries_);
    if (has_integer) resize_large(integers_, static_cast<std::size_t>(entries_));
    resize_large(reals_, static_cast<std::size_t>(entries_) * reals_of_entry);
    read_records(in_, entries_, [&](Scanner& in, Index i) {
      const std::span<Index> entry = cells[i];
      entry[0] = in.position("a row", rows);
      entry[1] = in.position("a column", rows);
      cells.shapes[i] = entry[0] == entry[1] ? Shape::vertex : Shape::line;
      if (has_integer) integers_[i] = in.integer<std::int64_t>("a value");
      for (std::size_t k = 0; k < reals_of_entry; ++k) {
        reals_[static_cast<std::size_t>(i) * reals_of_entry + k] =
            in.real(k == 0 ? "a value" : "an imaginary part");
      }
      if (!in.at_line_end()) in.fail("the line of an entry has too many numbers", "check the first line");
    });
    trim_to_corners(cells, 0, entries_);
  }

  Scanner in_;
  Notes& notes_;
  Mesh mesh_;
  std::shared_ptr<MatrixMetadata> metadata_ = std::make_shared<MatrixMetadata>();
  Field field_ = Field::pattern;
  Index entries_ = 0;
  std::vector<std::int64_t> integers_;
  std::vector<double> reals_;
};

Mesh read_matrix(const FilePath& path, Notes& notes) { return MatrixReader(path, notes).read(); }

// ---- writing

const MatrixMetadata* metadata_of(const Mesh& mesh) {
  return dynamic_cast<const MatrixMetadata*>(mesh.format_metadata.get());
}

/// Returns whether no two cells join the same vertices.
bool joins_once(const Mesh& mesh) {
  std::vector<std::pair<Index, Index>> ends;
  ends.reserve(mesh.cells.shapes.size());
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    ends.emplace_back(std::minmax(mesh.cells[c].front(), mesh.cells[c].back()));
  }
  std::sort(ends.begin(), ends.end());
  return std::adjacent_find(ends.begin(), ends.end()) == ends.end();
}

Field field_of(const DataArray* values) {
  if (values == nullptr) return Field::pattern;
  if (values->components == 2) return Field::complex;
  return is_whole(*values) ? Field::integer : Field::real;
}

/// Returns the array whose values are written as the matrix's values; null for a pattern.
const DataArray* values_of(const Mesh& mesh) {
  const DataArray* values = dense_array(mesh, kValue, Association::cells);
  if (values == nullptr && metadata_of(mesh) == nullptr)
    values = dense_array(mesh, kWeight, Association::cells);
  return values != nullptr && values->components <= 2 ? values : nullptr;
}

/// Returns the symmetry to write for a mesh with these values.
Symmetry symmetry_of(const Mesh& mesh, const DataArray* values) {
  if (const MatrixMetadata* const own = metadata_of(mesh)) return own->stored_as;
  const bool may_be = values == nullptr || values->name == kWeight;
  return may_be && joins_once(mesh) ? Symmetry::symmetric : Symmetry::general;
}

/// Returns whether an entry is written transposed, because the file has only the half below the diagonal.
bool is_transposed(std::span<const Index> entry, Symmetry symmetry) {
  return symmetry != Symmetry::general && entry.front() < entry.back();
}

/// Returns whether a component of a value changes its sign if the entry is transposed.
bool changes_sign(Symmetry symmetry, Offset component) {
  return symmetry == Symmetry::skew_symmetric || (symmetry == Symmetry::hermitian && component == 1);
}

template <class Number>
Number negative(Number value) {
  // unsigned: the least integer has no negative and stays as it is
  if constexpr (std::is_integral_v<Number>)
    return static_cast<Number>(0 - static_cast<std::uint64_t>(value));
  else
    return -value;
}

void add_value(Text& row, const DataArray& values, Field field, Index entry, Symmetry transposed) {
  for (Offset k = 0; k < values.components; ++k) {
    const Offset at = Offset{entry} * values.components + k;
    const bool turned = changes_sign(transposed, k);
    if (field == Field::integer) {
      const std::int64_t value = whole_value(values, at);
      row.integer(" ", turned ? negative(value) : value);
    } else {
      const double value = real_value(values, at);
      row.real(" ", turned ? -value : value);
    }
  }
}

/// Transposes the entries above the diagonal if the file has only the half below it.
Permutation settle_entries(Mesh& mesh) {
  const DataArray* const written = values_of(mesh);
  const Symmetry symmetry = symmetry_of(mesh, written);
  DataArray* const values = written == nullptr ? nullptr : &mesh.data[written - mesh.data.data()];
  for (Index c = 0; c < mesh.cell_count(); ++c) {
    const std::span<Index> entry = mesh.cells[c];
    if (!is_transposed(entry, symmetry)) continue;
    std::swap(entry.front(), entry.back());
    for (Offset k = 0; values != nullptr && k < values->components; ++k) {
      if (!changes_sign(symmetry, k)) continue;
      with_numbers(values->values, [&]<class Value>(std::vector<Value>& numbers) {
        Value& number = numbers[Offset{c} * values->components + k];
        number = negative(number);
      });
    }
  }
  return Permutation::identity(mesh.cell_count());
}

void write_matrix(const Mesh& mesh, const FilePath& path, Notes& notes) {
  const MatrixMetadata* const own = metadata_of(mesh);
  const DataArray* const values = values_of(mesh);
  const Symmetry symmetry = symmetry_of(mesh, values);
  if (own == nullptr && symmetry == Symmetry::general)
    notes.emplace_back("each line is one entry of the matrix, which is written as 'general'");
  const Field field = field_of(values);

  OutputFile out(path);
  out.print("{} matrix coordinate {} {}\n", kBanner, to_string(field), to_string(symmetry));
  if (own != nullptr) out.write(own->comments);
  out.print("{} {} {}\n", mesh.vertex_count(), mesh.vertex_count(), mesh.cell_count());
  write_rows(out, mesh.cell_count(), [&](Text& row, Index c) {
    const std::span<const Index> entry = mesh.cells[c];
    const bool transposed = is_transposed(entry, symmetry);
    row.integer("", Offset{transposed ? entry.back() : entry.front()} + 1);
    row.integer(" ", Offset{transposed ? entry.front() : entry.back()} + 1);
    if (values != nullptr) add_value(row, *values, field, c, transposed ? symmetry : Symmetry::general);
    row.write("\n");
  });
  out.commit();
  note_all_unsupported(mesh, "Matrix Market", std::array{values}, notes);
  if (own == nullptr) note_metadata_unsupported(mesh, "Matrix Market", notes);
}

}  // namespace
}  // namespace matrix

Format matrix_market_format() {
  Format format{matrix::kName, {".mtx"}, false, matrix::read_matrix, matrix::write_matrix, matrix::is_entry};
  format.settle_cells = matrix::settle_entries;
  return format;
}

}  // namespace meshorder
