// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// The public functions that read and write meshes, on disk and in memory.
#include "base/arena.hpp"
#include "io/format.hpp"
#include "mesh/degenerate.hpp"
#include "mesh/reorder.hpp"
#include <meshorder/error.hpp>
#include <meshorder/io.hpp>

#include <algorithm>
#include <istream>
#include <iterator>
#include <ostream>
#include <string>
#include <utility>

namespace meshorder {
namespace {

/// The files of one mesh in memory: one to read and its companions, or those that were written.
class MemoryStore : public FileStore {
 public:
  MemoryStore() = default;
  MemoryStore(const std::filesystem::path& path, std::string bytes,
              std::function<std::string(std::string_view)> companion)
      : companion_(std::move(companion)) {
    files_.push_back({path.string(), std::move(bytes)});
  }

  [[nodiscard]] bool has(const std::filesystem::path& path) const override { return !read(path).empty(); }
  [[nodiscard]] std::string read(const std::filesystem::path& path) const override {
    const std::string name = path.string();
    for (const MemoryFile& file : files_) {
      if (file.name == name) return file.bytes;
    }
    return companion_ ? companion_(name) : std::string();
  }
  void write(const std::filesystem::path& path, std::string bytes) override {
    files_.push_back({path.string(), std::move(bytes)});
  }

  std::vector<MemoryFile> files() && { return std::move(files_); }

 private:
  std::vector<MemoryFile> files_;
  std::function<std::string(std::string_view)> companion_;
};

Mesh read_checked(const FilePath& path, const Format& format, const ReadOptions& options) {
  Notes ignored;
  Notes& notes = options.notes != nullptr ? *options.notes : ignored;
  return in_arena(options.run, [&] {
    Mesh mesh = format.read(path, notes);
    mesh.format = format.key();
    if (mesh.cell_count() == 0) throw InputError(path.string(), "has no cells", "a mesh needs at least one");
    try {
      check_mesh(mesh);
    } catch (const InvalidArgument& fault) {
      throw InputError(path.string(), fault.what(), "the file may be damaged");
    }
    const std::vector<Index> degenerate = degenerate_cells(mesh.cells);
    if (!degenerate.empty()) {
      notes.push_back(std::to_string(degenerate.size()) +
                      (degenerate.size() == 1 ? " cell names a vertex twice and is kept"
                                              : " cells name a vertex twice and are kept") +
                      ": the first is cell " + std::to_string(degenerate.front()) + ", counted from 0");
    }
    return mesh;
  });
}

Mesh read_from_memory(std::string bytes, const ReadOptions& options) {
  const std::string name = options.name.empty() ? "<memory>" : options.name;
  const Format* format = options.format.empty() ? format_of_bytes(bytes) : &format_named(options.format);
  if (format == nullptr) {
    throw InputError(name, "does not look like a mesh of a known format", "name its format");
  }
  MemoryStore store(name, std::move(bytes), options.companion);
  return read_checked({name, store}, *format, options);
}

Permutation write_checked(const Mesh& mesh, const FilePath& path, const Format& format, Notes* notes) {
  Notes ignored;
  Notes& noted = notes != nullptr ? *notes : ignored;
  check_mesh(mesh);
  if ((format.groups_cells_by_type || format.places != nullptr) && mesh.format != format.key()) {
    std::vector<Index> blocks;
    Permutation places = format.places != nullptr ? format.places(mesh, blocks) : places_by_type(mesh.cells);
    if (!places.is_identity()) {
      Mesh arranged = mesh;
      arrange_cells(arranged, format);
      format.write(arranged, path, noted);
      return places;
    }
  }
  format.write(mesh, path, noted);
  return Permutation::identity(mesh.cell_count());
}

}  // namespace

inline namespace v0_2 {

Mesh read_mesh(const std::filesystem::path& path, const ReadOptions& options) {
  return read_checked(path, options.format.empty() ? format_of(path) : format_named(options.format), options);
}

Mesh read_mesh(std::span<const std::byte> bytes, const ReadOptions& options) {
  std::string text(bytes.size(), '\0');
  std::transform(bytes.begin(), bytes.end(), text.begin(), [](std::byte b) { return static_cast<char>(b); });
  return read_from_memory(std::move(text), options);
}

Mesh read_mesh(std::istream& stream, const ReadOptions& options) {
  return read_from_memory(std::string(std::istreambuf_iterator<char>(stream), {}), options);
}

Permutation write_mesh(const Mesh& mesh, const std::filesystem::path& path, Notes* notes) {
  return write_checked(mesh, path, format_of(path), notes);
}

Permutation write_mesh(const Mesh& mesh, std::ostream& stream, std::string_view format, Notes* notes) {
  const Format& known = format_named(format);
  if (known.name == "TetGen") {
    throw InvalidArgument("a mesh in the format 'tetgen' is several files, which do not fit one stream");
  }
  const MemoryFiles written = write_mesh_to_memory(mesh, format, "<stream>", notes);
  const std::string& bytes = written.files.front().bytes;
  stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!stream) throw Error(Code::io, "the stream cannot be written to the end");
  return written.cells;
}

MemoryFiles write_mesh_to_memory(const Mesh& mesh, std::string_view format, std::string_view name,
                                 Notes* notes) {
  MemoryStore store;
  Permutation cells = write_checked(mesh, {std::string(name), store}, format_named(format), notes);
  return {std::move(store).files(), std::move(cells)};
}

}  // namespace v0_2
}  // namespace meshorder
