// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#pragma once

// HDF5 files, by the C interface of libhdf5 (The HDF Group, HDF5 1.10 reference manual).
//
// libhdf5 is not thread-safe as Debian builds it, and by default it reports faults on standard error.
// Therefore every function here holds one lock for the whole program and keeps the library quiet meanwhile.
// Other code that calls the same library at the same time does not take this lock.

#include "io/hdf5/handle.hpp"
#include "io/hdf5/library.hpp"
#include "io/stream/file_path.hpp"
#include "io/stream/output_file.hpp"
#include <meshorder/mesh.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace meshorder::hdf5 {

/// Size and number type of a dataset.
struct DatasetInfo {
  std::vector<std::uint64_t> shape;  ///< {n} for a list of n values; empty for a single value
  std::size_t alternative = 0;       ///< number type, as an alternative of Values

  /// Returns the number of values.
  [[nodiscard]] std::uint64_t size() const;
};

/// An open HDF5 file. All faults are thrown as InputError, which names the file and the dataset.
class File {
 public:
  /// Opens a file to read it.
  static File open(const FilePath& path);
  /// Opens a file on disk to read it. `name` is for messages.
  static File open(const std::filesystem::path& path, std::string name);
  /// Opens a file on disk to change it. `name` is for messages.
  static File change(const std::filesystem::path& path, std::string name);
  /// Makes a file on disk from its bytes, and opens it to change it. `name` is for messages.
  static File make(const std::filesystem::path& path, std::string_view bytes, std::string name);
  /// Opens a copy of a file's bytes in memory to change it. Makes an empty file, with the properties
  /// `creation`, if there are no bytes.
  static File in_memory(std::string_view bytes, std::string name, hid_t creation = H5P_DEFAULT);

  [[nodiscard]] const std::string& name() const noexcept { return name_; }
  /// Returns the library's handle, for work that the functions below do not do; only within a `Session`.
  [[nodiscard]] hid_t id() const noexcept { return file_.id(); }

  /// Returns the size and number type of a dataset of numbers whose values are in this file. Refuses a
  /// dataset that claims more values than its bytes can hold.
  [[nodiscard]] DatasetInfo info(const std::string& path) const;
  /// Returns the number type of a dataset, as an alternative of Values, even if its values are missing;
  /// nullopt if there is no dataset of plain numbers.
  [[nodiscard]] std::optional<std::size_t> number_type(const std::string& path) const;
  /// Returns the values of a dataset that `info` accepts, row by row, in its own number type.
  [[nodiscard]] Values read(const std::string& path) const;
  /// Returns the whole numbers of a dataset as indices. A number out of range becomes the nearest 32-bit
  /// limit, which is not an index.
  [[nodiscard]] std::vector<Index> read_indices(const std::string& path) const;
  /// Returns the byte offset in the file of the values of a dataset that `info` accepts; 0 if the dataset has
  /// no values. Returns nullopt unless the values are contiguous and in this machine's byte order.
  [[nodiscard]] std::optional<std::uint64_t> place_of_values(const std::string& path) const;
  /// Returns the paths of all datasets with at least one dimension, and the length of each dataset's first
  /// dimension.
  [[nodiscard]] std::vector<std::pair<std::string, std::uint64_t>> datasets() const;

  /// Returns whether there is a group or a dataset of that path.
  [[nodiscard]] bool has(const std::string& path) const;
  /// Returns the names in a group, ascending or as the library lists them (H5_ITER_NATIVE); empty if there is
  /// no such group.
  [[nodiscard]] std::vector<std::string> names(const std::string& group,
                                               H5_iter_order_t order = H5_ITER_INC) const;
  /// Returns the texts of a dataset. Its rows are texts of any length, or texts of one length, at most 1,024
  /// bytes. Cuts all texts at the first zero byte; removes the blanks at the end of texts of one length.
  [[nodiscard]] std::vector<std::string> read_texts(const std::string& path) const;
  /// Returns whether there is a dataset that `read_texts` understands.
  [[nodiscard]] bool has_texts(const std::string& path) const;
  /// Returns the whole number (`text_attribute`: the text) in an attribute of a group or a dataset; nullopt
  /// if the attribute does not exist or is of another kind.
  [[nodiscard]] std::optional<std::int64_t> integer_attribute(const std::string& path,
                                                              const std::string& name) const;
  /// Returns all whole numbers of an attribute; empty if there is no such attribute or it has more than 64.
  [[nodiscard]] std::vector<std::int64_t> integers_attribute(const std::string& path,
                                                             const std::string& name) const;
  [[nodiscard]] std::optional<std::string> text_attribute(const std::string& path,
                                                          const std::string& name) const;

  /// Writes numbers to a dataset. A dataset that exists keeps its number type, attributes, chunks and
  /// compression; it also keeps its shape if the number of values is the same. A new dataset gets the given
  /// type and shape.
  void write(const std::string& path, const Values& values, const std::vector<std::uint64_t>& shape);
  void write(const std::string& path, std::span<const Index> values, const std::vector<std::uint64_t>& shape);
  /// Writes texts to a dataset, as rows of `width` bytes, cut or padded with `filling`. A dataset that exists
  /// keeps its attributes.
  void write_texts(const std::string& path, std::span<const std::string> texts, std::size_t width,
                   char filling = '\0');
  /// Makes a dataset of texts of any length. Its type says ASCII even if there are other characters.
  void write_strings(const std::string& path, std::span<const std::string> texts);
  /// Makes a dataset of numbers; `alternative` is the index of their type in Values. Allocates room in the
  /// file without writing values.
  void make_room(const std::string& path, std::size_t alternative, const std::vector<std::uint64_t>& shape);
  /// Allocates room in the file for the values of a dataset that has no room yet. Writes only the first
  /// value, as zero.
  void give_room(const std::string& path);
  /// Order of the links in a group that `make_group` makes: by name or by creation. `make_group` makes a
  /// group, and its parents, unless the group exists.
  enum class LinkOrder : std::uint8_t { names, made };
  void make_group(const std::string& path, LinkOrder order = LinkOrder::names);
  /// Makes a group that will get links with these names. If they fit into 32 KiB, the group lists its links
  /// in the order in which they are made, also to programs that do not sort them.
  void make_list(const std::string& path, std::span<const std::string> names);
  /// Sets an attribute of a group or a dataset. A single whole number keeps the number type of the old
  /// attribute.
  void set_attribute(const std::string& path, const std::string& name, std::int64_t value);
  void set_attribute(const std::string& path, const std::string& name, double value);
  void set_attribute(const std::string& path, const std::string& name, const std::string& value);
  void set_attribute(const std::string& path, const std::string& name, std::span<const std::int64_t> values);
  /// Moves a group or a dataset to another path.
  void move(const std::string& path, const std::string& new_path);
  /// Removes a group or a dataset if it is there.
  void remove(const std::string& path);

  /// Returns the bytes of a copy of this file in which the datasets at `paths` keep their types, attributes,
  /// chunks and filters, but have no values. A path that ends in "/" is the path of a group that will get a
  /// new member. If several of the paths lead to one dataset or group, each leads to a dataset or group of
  /// its own in the copy. Everything else is copied. Groups that record the order of links keep it; `order`:
  /// H5_ITER_NATIVE for formats whose library lists links unsorted.
  [[nodiscard]] std::string without_values(const std::set<std::string>& paths,
                                           H5_iter_order_t order = H5_ITER_INC) const;
  /// Returns the bytes of a file in memory.
  [[nodiscard]] std::string bytes() const;
  /// Writes all buffers and closes the file. Throws InputError if that fails.
  void close();

 private:
  /// Returns a File for an open file of the library; throws InputError if `file` is negative.
  static File made_of(hid_t file, std::string name, std::string_view what, const char* remedy);
  /// Returns an unused path beside this path.
  [[nodiscard]] std::string free_path(const std::string& path) const;
  File(Handle file, std::string name) : file_(std::move(file)), name_(std::move(name)) {}
  void make_group(const std::string& path, const Handle& creation);
  [[nodiscard]] Handle open_dataset(const std::string& path) const;
  [[nodiscard]] Handle open_object(const std::string& path) const;
  [[nodiscard]] Handle open_dataset_if_there(const std::string& path) const;
  [[nodiscard]] Handle open_attribute(const std::string& path, const std::string& name) const;
  void put_attribute(const std::string& path, const std::string& name,
                     const std::vector<std::uint64_t>& shape, hid_t type, hid_t memory, const void* value);
  void flush() const;
  void read(const std::string& path, hid_t type, void* values) const;
  [[nodiscard]] std::vector<std::string> read_strings(const std::string& path, const Handle& dataset,
                                                      const Handle& type) const;
  void claim(const std::string& path, std::uint64_t bytes) const;
  /// Throws unless the bytes of a dataset can hold `count` values.
  void require_stored(const std::string& path, const Handle& dataset, std::uint64_t count,
                      std::uint64_t bytes_each, std::string_view what) const;
  void write(const std::string& path, hid_t type, const void* values, std::uint64_t count,
             const std::vector<std::uint64_t>& shape);
  [[noreturn]] void fail(const std::string& path, const std::string& what, const std::string& remedy) const;

  Handle file_;
  std::string name_;
};

/// Returns the path with one slash before each part and no slash at its end.
std::string normal_path(std::string_view path);

/// A file that begins as a copy of `bytes` and is moved to `path` after it was changed. Until then it is in
/// memory if the path is in a store, else beside the path. Throws as OutputFile and File.
class NewFile {
 public:
  NewFile(const FilePath& path, const std::string& bytes);
  [[nodiscard]] File& file() { return *file_; }
  /// Closes the file; returns it as a complete output.
  [[nodiscard]] OutputFile finish();

 private:
  FilePath path_;
  OutputFile out_;
  std::optional<File> file_;
};

/// Writes an HDF5 file: opens `bytes` as a `NewFile`, calls `fill` to change it, and moves it to `path`.
void write_from(const FilePath& path, const std::string& bytes, const std::function<void(File&)>& fill);

}  // namespace meshorder::hdf5
