// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

#include "io/exodus/library.hpp"
#include "io/stream/file_path.hpp"
#include "io/stream/output_file.hpp"
#include <meshorder/error.hpp>
#include <meshorder/mesh.hpp>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

/// Files of netCDF, read and written through its C library. The library allows one call at a time: each
/// NcInput and each NcOutput holds a lock of the process.
namespace meshorder::exodus {

/// A type of values in netCDF, with its number in netcdf.h.
using NcType = int;
extern const NcType kChar;
extern const NcType kInt;
extern const NcType kInt64;
extern const NcType kFloat;
extern const NcType kDouble;

/// Returns whether values of the type are whole numbers.
bool is_whole(NcType type);
/// Returns the size of a value in bytes, 0 for strings and user-defined types.
std::size_t size_of(NcType type);
/// Returns whether a type can hold each of the values exactly. Only the real types can hold NaN.
/// O(values).
bool can_hold(NcType type, const Values& values);

/// An attribute of a file or a variable: a name with values.
struct Attribute {
  std::string name;
  NcType type;
  std::size_t count;
  std::string bytes;  ///< count values in the byte order of this machine
};

/// Returns an attribute that is a text.
Attribute text_attribute(std::string name, std::string text);

/// Returns an attribute with one number; `type` must match Number.
template <class Number>
Attribute number_attribute(std::string name, NcType type, Number value) {
  Attribute attribute{std::move(name), type, 1, std::string(sizeof(value), '\0')};
  std::memcpy(attribute.bytes.data(), &value, sizeof(value));
  return attribute;
}

struct Dimension {
  std::string name;
  std::size_t length;
  bool unlimited = false;
};

/// A variable of a file that is read.
struct Variable {
  int id;
  std::string name;
  NcType type;
  std::vector<int> dimensions;  ///< indices in NcInput::dimensions
};

/// How values are stored.
struct Storage {
  int kind;              ///< kind of the file, as nc_inq_format returns it
  int deflate = 0;       ///< level of compression, 0 to 9
  bool shuffle = false;  ///< bytes are shuffled before compression
};

/// Returns the storage of new files: netCDF-3 with 64-bit offsets, or CDF-5 if `large`.
Storage plain_storage(bool large);

/// Throws InputError unless a file begins with a valid header of netCDF-3 and all values lie within `size`
/// bytes. `first_bytes(n)` returns the first n bytes, or all bytes of a shorter file. O(size of the header).
void check_classic_header(const std::string& file, const std::function<std::string(std::size_t)>& first_bytes,
                          std::uint64_t size);

/// A file that is read.
class NcInput {
 public:
  /// Opens a file. Throws InputError if it cannot be read or is not a valid netCDF file.
  explicit NcInput(const FilePath& path);
  ~NcInput();
  NcInput(const NcInput&) = delete;
  NcInput& operator=(const NcInput&) = delete;
  NcInput(NcInput&&) = delete;
  NcInput& operator=(NcInput&&) = delete;

  [[nodiscard]] const std::vector<Dimension>& dimensions() const noexcept { return dimensions_; }
  [[nodiscard]] const std::vector<Variable>& variables() const noexcept { return variables_; }
  /// Returns the variable of that name, or null.
  [[nodiscard]] const Variable* find(const std::string& name) const;
  /// Returns the length of a dimension, 0 if there is no such dimension.
  [[nodiscard]] std::size_t length(const std::string& name) const;
  /// Returns the length of a dimension that counts items of the file. Throws InputError if the length exceeds
  /// the file's size in bytes.
  [[nodiscard]] std::size_t count(const std::string& dimension) const;
  /// Returns the lengths along a variable's dimensions.
  [[nodiscard]] std::vector<std::size_t> shape(const Variable& variable) const;
  /// Returns the number of a variable's values. Throws InputError if the file is too small to hold them.
  [[nodiscard]] std::size_t size(const Variable& variable) const;
  /// Returns `count`. Throws InputError if `count` values of `bytes_each` bytes exceed the memory limit for
  /// sizes that a file claims.
  [[nodiscard]] std::size_t claimed(std::string_view what, std::size_t count, std::size_t bytes_each) const;

  /// Returns the attributes of a variable, or of the file if `variable` is null. Leaves out attributes of
  /// user-defined types or of several strings, and appends their names to `lost`.
  [[nodiscard]] std::vector<Attribute> attributes(const Variable* variable,
                                                  std::vector<std::string>& lost) const;
  /// Returns the text of an attribute of a variable, empty if there is none.
  [[nodiscard]] std::string text(const Variable& variable, const std::string& attribute) const;

  /// Reads a part of the values as 32-bit integers: along each dimension `counts` values from `starts` on.
  /// Throws InputError if the type is not whole, a value does not fit or the values cannot be read.
  void read(const Variable& variable, const std::vector<std::size_t>& starts,
            const std::vector<std::size_t>& counts, std::int32_t* values) const;
  [[nodiscard]] std::vector<std::int64_t> integers(const Variable& variable) const;
  [[nodiscard]] std::vector<std::int64_t> integers(const Variable& variable,
                                                   const std::vector<std::size_t>& starts,
                                                   const std::vector<std::size_t>& counts) const;
  /// Returns the part of the values that `read` reads, as real numbers; the type may be any number type.
  [[nodiscard]] std::vector<double> reals(const Variable& variable, const std::vector<std::size_t>& starts,
                                          const std::vector<std::size_t>& counts) const;
  /// Returns the bytes of all values in the byte order of this machine.
  [[nodiscard]] std::string bytes(const Variable& variable) const;
  /// Returns the rows of a table of characters, each up to its zero byte and without blanks at its end.
  [[nodiscard]] std::vector<std::string> texts(const Variable& variable) const;
  /// Returns the part of the values that `read` reads, in the variable's type, which may be any number type.
  [[nodiscard]] Values values(const Variable& variable, const std::vector<std::size_t>& starts,
                              const std::vector<std::size_t>& counts) const;

  [[nodiscard]] Storage storage() const;

  /// Throws InputError for a fault of the file.
  [[noreturn]] void fail(const std::string& what,
                         const std::string& remedy = "the file may be damaged") const;
  [[nodiscard]] const std::string& name() const noexcept { return name_; }

 private:
  void check(int status, const std::string& what) const;
  void inquire();
  /// Throws InputError if the library would take more memory for a chunk than the file may claim.
  void check_chunks(const Variable& variable) const;

  Library library_;
  std::string name_;
  std::optional<InputFile> file_;
  std::string memory_;  // the content of a file that is not on disk
  std::uint64_t size_ = 0;
  int id_ = -1;
  std::vector<Dimension> dimensions_;
  std::vector<Variable> variables_;
  std::map<std::string, std::size_t> by_name_;
};

class NcOutput;

/// Writes the values of a declared variable.
class NcSink {
 public:
  NcSink(const NcOutput& file, std::string name, int variable)
      : file_(&file), name_(std::move(name)), variable_(variable) {}
  /// Writes all values of a variable of one dimension.
  template <class Number>
  void list(const std::vector<Number>& values) const {
    part({0}, {values.size()}, values);
  }
  /// Writes a part of the values: along each dimension `counts` values from `starts` on.
  /// Number: double, float, std::int32_t, std::int64_t or std::uint64_t.
  template <class Number>
  void part(const std::vector<std::size_t>& starts, const std::vector<std::size_t>& counts,
            const std::vector<Number>& values) const;
  /// Writes the first `counts` values along each dimension, given as bytes in the variable's type.
  void bytes(const std::vector<std::size_t>& counts, const std::string& values) const;

 private:
  const NcOutput* file_;
  std::string name_;
  int variable_;
};

/// A file that already exists. The caller moves the file to its final path once it is written.
struct UnfinishedFile {
  std::filesystem::path path;
  std::string name;  ///< name for messages
};

/// Writes a file: first the caller declares all dimensions and variables, then `finish` writes the values.
class NcOutput {
 public:
  NcOutput(const FilePath& path, const Storage& storage);
  NcOutput(const UnfinishedFile& file, const Storage& storage);
  ~NcOutput();
  NcOutput(const NcOutput&) = delete;
  NcOutput& operator=(const NcOutput&) = delete;
  NcOutput(NcOutput&&) = delete;
  NcOutput& operator=(NcOutput&&) = delete;

  void attribute(const Attribute& attribute);
  /// Declares a dimension, which may be declared several times. Returns false if the dimension exists with
  /// another length.
  bool dimension(const Dimension& dimension);
  /// Declares a variable. A function given to `later` writes the variable's values.
  NcSink variable(const std::string& name, NcType type, const std::vector<std::string>& dimensions,
                  const std::vector<Attribute>& attributes = {});
  /// Adds a function that `finish` calls.
  void later(std::function<void()> put) { puts_.push_back(std::move(put)); }
  [[nodiscard]] bool has_variable(const std::string& name) const { return declared_.contains(name); }

  /// Writes all values, and moves the file to its final path unless the caller does so.
  void finish();

 private:
  void create(const std::filesystem::path& path);
  void check(int status, const std::string& what) const;
  void put_attribute(int variable, const Attribute& attribute, const std::string& of) const;

  friend class NcSink;
  Library library_;
  std::string name_;
  std::optional<OutputFile> out_;  ///< empty if the caller moves the file to its final path
  bool is_in_memory_;
  Storage storage_;
  int id_ = -1;
  std::map<std::string, std::pair<int, std::size_t>> dimensions_;
  std::set<std::string> declared_;
  std::vector<std::function<void()>> puts_;
};

}  // namespace meshorder::exodus
