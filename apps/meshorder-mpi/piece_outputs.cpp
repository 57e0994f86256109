// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "piece_outputs.hpp"

#include "base/text.hpp"
#include "io/format.hpp"
#include "io/stream/descriptor.hpp"
#include "io/stream/file_path.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>

namespace meshorder::command {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kDigits = 4;

/// Returns whether a file has the name of a piece: `name`, an underscore, four digits or more, and ".vtu".
bool is_name_of_piece(std::string_view file, std::string_view name) {
  constexpr std::string_view kExtension = ".vtu";
  if (!file.starts_with(name) || !file.ends_with(kExtension) || file.size() < name.size() + kExtension.size())
    return false;
  file.remove_prefix(name.size());
  file.remove_suffix(kExtension.size());
  return file.size() > kDigits && file.front() == '_' &&
         file.find_first_not_of("0123456789", 1) == std::string_view::npos;
}

/// Returns whether a path has the extension of a mesh format.
bool names_mesh_file(const fs::path& path) {
  const std::string extension = path.extension().string();
  return std::ranges::any_of(all_formats(), [&](const Format& format) {
    return std::ranges::any_of(format.extensions,
                               [&](std::string_view known) { return same_but_for_case(known, extension); });
  });
}

/// Returns the file names in a .pvtu file, as written there; an empty set if the .pvtu file does not exist.
std::set<std::string> named_by(const fs::path& index) {
  constexpr std::string_view kAttribute = "Source=\"";
  constexpr std::size_t kMost = std::size_t{1} << 28;
  std::error_code code;
  if (!fs::exists(index, code)) return {};
  const std::string text = FilePath::in(index.parent_path(), index).open().text(kMost);
  std::set<std::string> names;
  for (std::size_t at = text.find(kAttribute); at != std::string::npos; at = text.find(kAttribute, at)) {
    at += kAttribute.size();
    names.insert(text.substr(at, text.find('"', at) - at));
  }
  return names;
}

}  // namespace

PieceOutputs::PieceOutputs(fs::path folder, std::string name)
    : folder_(std::move(folder)), name_(std::move(name)) {
  std::error_code code;
  if (!fs::exists(folder_, code)) {
    if (names_mesh_file(folder_)) {
      throw InputError(folder_.string(), "--pieces expects a folder and not a file",
                       fmt::format("give a name such as {}; {}.pvtu in it lists the pieces",
                                   fs::path(folder_).replace_extension().string(), name_));
    }
    (void)OutputFile(folder_);  // throws if nothing can be made there
    return;
  }
  if (!fs::is_directory(folder_, code))
    throw InputError(folder_.string(), "is not a folder", "--pieces needs a folder, and makes a missing one");
  (void)OutputFile(FilePath::derived(index()));
  (void)old_pieces();
}

PieceOutputs::~PieceOutputs() {
  files_.clear();
  std::error_code ignored;
  if (is_made_) fs::remove(folder_, ignored);  // does nothing if files are in the folder
}

fs::path PieceOutputs::index() const { return folder_ / (name_ + ".pvtu"); }

/// Returns the pieces that an earlier run left.
std::vector<fs::path> PieceOutputs::old_pieces() const {
  const std::set<std::string> known = named_by(index());
  std::vector<fs::path> pieces;
  std::error_code code;
  for (fs::directory_iterator entry(folder_, code), end; !code && entry != end; entry.increment(code)) {
    const std::string file = entry->path().filename().string();
    if (!is_name_of_piece(file, name_)) continue;
    if (!known.contains(xml_escaped(file))) {
      throw InputError(entry->path().string(),
                       "has the name of a piece, but " + index().filename().string() + " does not list it",
                       "give --pieces another folder, or remove the file");
    }
    pieces.push_back(entry->path());
  }
  if (code) throw_system_fault(folder_.string(), "cannot be listed", code.value());
  return pieces;
}

std::vector<std::string> PieceOutputs::open(Index pieces) {
  std::error_code code;
  is_made_ = fs::create_directory(folder_, code);
  if (code) throw_system_fault(folder_.string(), "cannot be made", code.value());
  std::vector<std::string> paths;
  for (Index k = 0; k < pieces; ++k) {
    names_.push_back(fmt::format("{}_{:0{}}.vtu", name_, k, kDigits));
    OutputFile& file = files_.emplace_back(FilePath::derived(folder_ / names_.back()));
    file.close();
    paths.push_back(file.temporary().string());
  }
  return paths;
}

void PieceOutputs::add_to(OutputSet& set, const std::string& index_text) {
  // remove the old index before pieces are put in place: no reader then mixes two runs
  set.remove_first(FilePath::derived(index()));
  for (const fs::path& old : old_pieces()) {
    if (std::find(names_.begin(), names_.end(), old.filename().string()) == names_.end())
      set.remove(FilePath::derived(old));
  }
  for (OutputFile& file : files_) set.add(std::move(file));
  files_.clear();
  OutputFile file(FilePath::derived(index()));
  file.write(index_text);
  set.add(std::move(file));
}

}  // namespace meshorder::command
