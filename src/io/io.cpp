// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// The public functions that read and write meshes, on disk and in memory.
#include "base/parallel.hpp"
#include "io/format.hpp"
#include "io/kept_cells.hpp"
#include "io/stream/gzip.hpp"
#include "io/stream/output_set.hpp"
#include "io/stream/read_limits.hpp"
#include "mesh/cells.hpp"
#include "mesh/reorder.hpp"
#include "mesh/stored_matrix.hpp"
#include <meshorder/error.hpp>
#include <meshorder/io.hpp>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <istream>
#include <ostream>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

namespace meshorder {
namespace {

/// The files of one mesh in memory: the file to read and its companions, or the files that were written.
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

/// Returns whether the folder of a path on disk was written to after `since` or less than 1 s before.
bool is_written_to(const FilePath& path, std::chrono::file_clock::time_point since) {
  std::error_code code;
  const std::filesystem::path folder = path.path().parent_path();
  const auto last = std::filesystem::last_write_time(folder.empty() ? "." : folder, code);
  return path.store() == nullptr && !code && last > since - std::chrono::seconds(1);
}

/// Reads a mesh. Tries again if its files do not fit together and their folder has just been written to.
Mesh read_together(const FilePath& path, const Format& format, Notes& notes) {
  constexpr int kAttempts = 20;
  constexpr std::chrono::milliseconds kPause{50};
  for (int attempt = 1;; ++attempt) {
    const auto began = std::chrono::file_clock::now();
    Notes found;
    try {
      Mesh mesh = format.read(path, found);
      notes.insert(notes.end(), found.begin(), found.end());
      return mesh;
    } catch (const NotTogether&) {
      if (attempt == kAttempts || !is_written_to(path, began)) throw;
    } catch (const InputError&) {
      refuse_other_content(path, format);
      throw;
    }
    std::this_thread::sleep_for(kPause);
  }
}

/// Throws the InputError for a file without cells.
[[noreturn]] void refuse_empty(const FilePath& path, const Mesh& mesh) {
  const StoredMatrix* const stored = stored_matrix(mesh);
  if (stored == nullptr) throw InputError(path.string(), "has no cells", "a mesh needs at least one");
  if (stored->is_graph) throw InputError(path.string(), "has no edges", "a graph needs at least one");
  throw InputError(path.string(), "has no entries", "a matrix needs at least one");
}

/// @param stored  size in bytes of a compressed file in memory; 0 if the file is not compressed or is on disk
Mesh read_checked(const FilePath& path, const Format& format, const ReadOptions& options,
                  std::uint64_t stored = 0) {
  Notes ignored;
  Notes& notes = options.notes != nullptr ? *options.notes : ignored;
  return in_arena(options.run, [&] {
    const ReadScope scope(path, options.memory_limit, options.include_folders);
    if (stored > 0) count_file(path, stored);
    Mesh mesh = read_together(path, format, notes);
    mesh.format = format.key();
    if (mesh.cell_count() == 0) refuse_empty(path, mesh);
    try {
      check_mesh(mesh);
    } catch (const InvalidArgument& fault) {
      throw InputError(path.string(), fault.what(), "the file may be damaged");
    }
    const std::vector<Index> degenerate = degenerate_cells(mesh.cells);
    if (!degenerate.empty()) notes.push_back(note_of_degenerate(std::ssize(degenerate), degenerate.front()));
    return mesh;
  });
}

std::string name_in_memory(const ReadOptions& options) {
  return options.name.empty() ? "<memory>" : options.name;
}

Mesh read_from_memory(std::string bytes, const ReadOptions& options) {
  const std::string name = name_in_memory(options);
  const std::uint64_t stored = bytes.size();
  {
    const FilePath file(name);
    const ReadScope scope(file, options.memory_limit);
    count_file(file, bytes.size());
    bytes = uncompressed(std::move(bytes), name);
  }
  const Format* format = options.format.empty() ? format_of_bytes(bytes) : &format_named(options.format);
  if (format == nullptr) {
    throw InputError(name, "does not look like a mesh of a known format", "name its format");
  }
  const bool is_as_stored = bytes.size() == stored;
  MemoryStore store(name, std::move(bytes), options.companion);
  return read_checked({name, store}, *format, options, is_as_stored ? 0 : stored);
}

/// Returns the new positions of all cells: first the kept cells, in the order `of_kept`, then the others.
Permutation places_of(const std::vector<Index>& kept, const Permutation& of_kept, Index count) {
  std::vector<Index> old_to_new(static_cast<std::size_t>(count), -1);
  for (Index k = 0; k < index_size(kept); ++k) old_to_new[kept[k]] = of_kept.old_to_new()[k];
  Index next = index_size(kept);
  for (Index& place : old_to_new) {
    if (place < 0) place = next++;
  }
  return Permutation::from_old_to_new(std::move(old_to_new));
}

/// Returns whether the cells of a mesh are in the order of a file of the format.
bool has_places_of(const Format& format, const Mesh& mesh) {
  if (mesh.format == format.key()) return true;
  std::vector<Index> blocks;
  if (format.places != nullptr) return format.places(mesh, blocks).is_identity();
  return !format.groups_cells_by_type || !places_by_type(mesh.cells);
}

/// Writes the mesh to memory and throws InputError if anything is lost.
void refuse_losses(const Mesh& mesh, const FilePath& path, const Format& format) {
  Notes lost;
  MemoryStore store;
  format.write(mesh, {path.path(), store}, lost);
  if (!lost.empty())
    throw InputError(path.string(), lost.front(), "file not written: --strict forbids data loss");
}

}  // namespace

void write_arranged(const Mesh& mesh, const FilePath& path, const WriteOptions& options,
                    const Format& format) {
  Notes ignored;
  Notes& notes = options.notes != nullptr ? *options.notes : ignored;
  if (options.strict) refuse_losses(mesh, path, format);
  if (path.store() != nullptr || path.set() != nullptr) return format.write(mesh, path, notes);
  OutputSet files;
  format.write(mesh, {path, files}, notes);
  files.commit();
  notes.insert(notes.end(), files.notes().begin(), files.notes().end());
}

std::optional<Permutation> write_mesh_to(const Mesh& mesh, const FilePath& path, const WriteOptions& options,
                                         const Format* format) {
  if (format == nullptr) format = &output_format_of(path.path(), mesh.format);
  Notes left_out;
  const std::vector<Index> kept = cells_to_write(mesh, path, *format, options.strict, left_out);
  std::optional<Permutation> places;
  std::optional<Mesh> arranged;
  if (index_size(kept) < mesh.cell_count() || !has_places_of(*format, mesh)) {
    arranged = mesh;
    keep_cells_at(*arranged, kept, left_out);
    places =
        places_of(kept, arrange_cells(*arranged, *format).value_or(Permutation::identity(index_size(kept))),
                  mesh.cell_count());
  }
  if (options.notes != nullptr) options.notes->insert(options.notes->end(), left_out.begin(), left_out.end());
  write_arranged(arranged ? *arranged : mesh, path, options, *format);
  return places;
}

Mesh read_mesh_from(const FilePath& path, const ReadOptions& options) {
  return read_checked(path, options.format.empty() ? format_of_file(path) : format_named(options.format),
                      options);
}

inline namespace v0_3 {

Mesh read_mesh(const std::filesystem::path& path, const ReadOptions& options) {
  return read_mesh_from(path, options);
}

Mesh read_mesh(std::span<const std::byte> bytes, const ReadOptions& options) {
  std::string text(bytes.size(), '\0');
  std::transform(bytes.begin(), bytes.end(), text.begin(), [](std::byte b) { return static_cast<char>(b); });
  return read_from_memory(std::move(text), options);
}

Mesh read_mesh(std::istream& stream, const ReadOptions& options) {
  const std::string name = name_in_memory(options);
  const FilePath file(name);
  const ReadScope scope(file, options.memory_limit);
  return read_from_memory(read_to_end(stream, name), options);
}

Permutation write_mesh(const Mesh& mesh, const std::filesystem::path& path, Notes* notes) {
  return write_mesh(mesh, path, WriteOptions{.notes = notes});
}

Permutation write_mesh(const Mesh& mesh, const std::filesystem::path& path, const WriteOptions& options) {
  check_mesh(mesh);
  return write_mesh_to(mesh, path, options).value_or(Permutation::identity(mesh.cell_count()));
}

Permutation write_mesh(const Mesh& mesh, std::ostream& stream, std::string_view format, Notes* notes) {
  const Format& known = format_named(format);
  if (!known.single_file) {
    throw InvalidArgument("a mesh in the format '" + known.key() +
                          "' has several files, which cannot be written to one stream");
  }
  const MemoryFiles written = write_mesh_to_memory(mesh, format, "<stream>", notes);
  const std::string& bytes = written.files.front().bytes;
  stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!stream) throw Error(Code::io, "the stream cannot be written to the end");
  return written.cells;
}

MemoryFiles write_mesh_to_memory(const Mesh& mesh, std::string_view format, std::string_view name,
                                 Notes* notes) {
  check_mesh(mesh);
  MemoryStore store;
  const std::optional<Permutation> cells =
      write_mesh_to(mesh, {std::string(name), store}, {.notes = notes}, &format_named(format));
  return {std::move(store).files(), cells ? *cells : Permutation::identity(mesh.cell_count())};
}

}  // namespace v0_3
}  // namespace meshorder
