// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "nemesis_outputs.hpp"

#include "base/text.hpp"
#include "distributed/files/nemesis.hpp"
#include "io/all_formats.hpp"
#include "io/format.hpp"
#include "io/stream/descriptor.hpp"
#include <meshorder/error.hpp>

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <system_error>
#include <utility>

namespace meshorder::command {
namespace fs = std::filesystem;
namespace {

/// Returns whether a file has the name of a piece: `name` and two numbers, each after a dot.
bool has_name_of_nemesis_piece(std::string_view file, std::string_view name) {
  constexpr std::string_view kDigits = "0123456789";
  if (!file.starts_with(name)) return false;
  const std::string_view rest = file.substr(name.size());
  const std::size_t dot = rest.find('.', 1);
  return rest.starts_with('.') && dot > 1 && rest.find_first_not_of(kDigits, 1) == dot &&
         dot + 1 < rest.size() && rest.find_first_not_of(kDigits, dot + 1) == std::string_view::npos;
}

}  // namespace

NemesisOutputs::NemesisOutputs(std::string name) : name_(std::move(name)) {
  (void)format_of(name_);   // throws if this build lacks the format
  (void)OutputFile(name_);  // throws if no file can be made there
  (void)old_pieces();
}

/// Returns the pieces that an earlier run left.
std::vector<fs::path> NemesisOutputs::old_pieces() const {
  const fs::path target(name_);
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  std::vector<fs::path> pieces;
  std::error_code code;
  for (fs::directory_iterator entry(folder, code), end; !code && entry != end; entry.increment(code)) {
    const fs::path file = entry->path().filename();
    if (!has_name_of_nemesis_piece(file.string(), target.filename().string())) continue;
    const fs::path path = target.parent_path() / file;
    if (!distributed::is_own_nemesis_piece(path)) {
      throw InputError(path.string(), "has the name of a piece, but meshorder did not write it",
                       "give --pieces another name, or remove the file");
    }
    pieces.push_back(path);
  }
  if (code) throw_system_fault(folder.string(), "cannot be listed", code.value());
  return pieces;
}

std::vector<std::string> NemesisOutputs::open(Index parts) {
  std::vector<std::string> paths;
  for (Index part = 0; part < parts; ++part) {
    names_.push_back(distributed::nemesis_name(name_, parts, part));
    OutputFile& file = files_.emplace_back(FilePath::derived(names_.back()));
    file.close();
    paths.push_back(file.temporary().string());
  }
  return paths;
}

void NemesisOutputs::add_to(OutputSet& set) {
  // remove the old first piece before pieces are put in place: no reader then mixes two runs
  set.remove_first(FilePath::derived(names_.front()));
  for (const fs::path& old : old_pieces()) {
    if (std::find(names_.begin(), names_.end(), old.string()) == names_.end())
      set.remove(FilePath::derived(old));
  }
  for (std::size_t k = 1; k <= files_.size(); ++k)  // adds piece 0 last
    set.add(std::move(files_[k % files_.size()]));
  files_.clear();
}

bool names_nemesis_pieces(const std::string& pieces) {
  const std::string extension = fs::path(pieces).extension().string();
  return std::any_of(kExodusExtensions.begin(), kExodusExtensions.end(),
                     [&](std::string_view known) { return same_but_for_case(known, extension); });
}

}  // namespace meshorder::command
