// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "output_deputy.hpp"

#include "io/format.hpp"
#include "io/stream/descriptor.hpp"
#include "io/stream/output_file.hpp"
#include "io/stream/output_place.hpp"
#include "io/stream/output_set.hpp"
#include <meshorder/error.hpp>

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <exception>
#include <span>
#include <utility>

namespace meshorder::command {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLongestMessage = std::size_t{1} << 16;

// ---- messages: parts that end with a zero byte; the first character of each is its kind

enum Kind : char {
  kScratch = 's',
  kTarget = 't',
  kRemovedFirst = 'f',
  kRemoved = 'r',
  kNote = 'n',
  kFault = 'e'
};

void add(std::string& message, Kind kind, std::string_view text) {
  message += static_cast<char>(kind);
  message += text;
  message += '\0';
}

/// Removes and returns the next part of a message. Throws Error if the part has no end or no kind.
std::pair<char, std::string> next_part(std::string_view& message) {
  const std::size_t end = message.find('\0');
  if (end == std::string_view::npos || end == 0)
    throw Error(Code::internal, "the reading process sent an invalid message");
  std::pair<char, std::string> part(message.front(), message.substr(1, end - 1));
  message.remove_prefix(end + 1);
  return part;
}

/// Waits for the next message and returns it; empty if none can come.
std::string received(int socket) {
  std::string message(kLongestMessage, '\0');
  ssize_t size = 0;
  do {
    size = ::recv(socket, message.data(), message.size(), 0);
  } while (size < 0 && errno == EINTR);
  message.resize(static_cast<std::size_t>(std::max<ssize_t>(size, 0)));
  return message;
}

/// Asks the parent to put files in place; has the parameters and result of `put_in_place`.
std::vector<std::string> ask(int socket, std::span<const FinishedFile> files, std::span<const FilePath> first,
                             std::span<const FilePath> removed) {
  std::string request;
  for (const FinishedFile& file : files) {
    add(request, kScratch, file.scratch.string());
    add(request, kTarget, file.target.string());
  }
  for (const FilePath& file : first) add(request, kRemovedFirst, file.string());
  for (const FilePath& file : removed) add(request, kRemoved, file.string());
  std::string answer;
  if (request.size() <= kLongestMessage && ::send(socket, request.data(), request.size(), MSG_NOSIGNAL) >= 0)
    answer = received(socket);
  if (answer.empty()) throw Error(Code::io, "the outputs could not be moved into place: try --trust");
  std::vector<std::string> notes;
  for (std::string_view rest = answer; !rest.empty();) {
    auto [kind, text] = next_part(rest);
    if (kind == kFault) throw Error(Code::bad_input, text);
    if (kind == kNote && !text.empty()) notes.push_back(std::move(text));
  }
  return notes;
}

}  // namespace

OutputDeputy::OutputDeputy(const std::vector<FilePath>& outputs, std::string maps) : maps_(std::move(maps)) {
  for (const FilePath& output : outputs) {
    if (output.path().empty()) continue;
    (void)OutputFile(output);  // throws if it cannot be written
    const OutputPlace place = output_place(output);
    if (place.is_through) {
      through_.push_back(place.path);
      continue;
    }
    bool is_alone = true;
    try {
      is_alone = format_of(output.path()).single_file;
    } catch (const Error&) {
      // not a mesh
    }
    outputs_.push_back({output, is_alone});
    add_home(place.path);
    if (!is_alone) add_home(output.path());
  }
  if (!maps_.empty()) add_home(maps_);
  if (homes_.empty()) return;
  std::array<int, 2> ends{-1, -1};
  if (::socketpair(AF_UNIX, SOCK_SEQPACKET, 0, ends.data()) != 0)
    throw_system_fault(outputs_.empty() ? maps_ : outputs_.front().path.string(), "cannot be written", errno);
  asking_ = Descriptor(ends[0]);
  answering_ = Descriptor(ends[1]);
  for (const int end : ends) (void)::fcntl(end, F_SETFD, FD_CLOEXEC);
}

void OutputDeputy::add_home(const fs::path& target) {
  const fs::path folder = folder_of(target);
  const bool is_known =
      std::any_of(homes_.begin(), homes_.end(), [&](const Home& home) { return home.folder == folder; });
  if (!is_known) homes_.push_back({folder, Scratch(target)});
}

std::vector<fs::path> OutputDeputy::folders() const {
  std::vector<fs::path> folders;
  for (const Home& home : homes_) folders.push_back(home.scratch.path());
  return folders;
}

void OutputDeputy::serve_this_process() {
  if (homes_.empty()) return;
  (void)answering_.close();
  for (const Home& home : homes_) keep_scratches_in(home.scratch.path(), home.folder);
  put_in_place_by([socket = asking_.get()](
                      std::span<const FinishedFile> files, std::span<const FilePath> first,
                      std::span<const FilePath> removed) { return ask(socket, files, first, removed); });
}

void OutputDeputy::serve_child() {
  if (homes_.empty()) return;
  (void)asking_.close();
  for (std::string request; !(request = received(answering_.get())).empty();) {
    std::string answer;
    try {
      for (const std::string& note : do_as_asked(request)) add(answer, kNote, note);
      add(answer, kNote, "");
    } catch (const std::exception& error) {
      answer.clear();
      add(answer, kFault, error.what());
    }
    answer.resize(std::min(answer.size(), kLongestMessage));
    (void)::send(answering_.get(), answer.data(), answer.size(), MSG_NOSIGNAL);
  }
}

FilePath OutputDeputy::allowed(const std::string& path) const {
  const fs::path target = path;
  const std::string name = target.filename().string();
  const auto is_in_folder_of = [&](const fs::path& output) {
    return !name.empty() && name != ".." && target.parent_path() == output.parent_path();
  };
  for (const Output& output : outputs_) {
    if (path == output.path.string()) return output.path;
    // out.ele and out.face belong to out.node; out.h5 and out_2.h5 to out.xdmf
    const std::string stem = output.path.path().stem().string();
    const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
    if (!output.is_alone && is_in_folder_of(output.path.path()) && name.starts_with(stem) &&
        name.size() > stem.size() && !is_letter(name[stem.size()])) {
      return FilePath::derived(target);
    }
  }
  const bool is_map = name.ends_with(".npy") || name.ends_with(".json");
  if (!maps_.empty() && is_map && is_in_folder_of(maps_) &&
      name.starts_with(fs::path(maps_).filename().string() + ".")) {
    return FilePath::derived(target);
  }
  throw InputError(path, "is not an output of this command", "read the file with --trust if you trust it");
}

Scratch OutputDeputy::taken(const std::string& scratch, const FilePath& target) const {
  const fs::path given = scratch;
  const auto home = std::find_if(homes_.begin(), homes_.end(),
                                 [&](const Home& one) { return one.scratch.path() == given.parent_path(); });
  const std::string name = given.filename().string();
  if (home == homes_.end() || name.empty() || name == "..")
    throw Error(Code::internal, "the reading process sent an invalid message");
  constexpr int kFolder = O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC;
  const Descriptor outer(home->scratch.path(), kFolder);
  const Descriptor inner(::openat(outer.get(), name.c_str(), kFolder));
  Scratch own(output_place(target).path);
  const Descriptor to(own.path(), kFolder);
  const std::string file(Scratch::kNew);
  struct stat status {};
  if (::renameat(inner.get(), file.c_str(), to.get(), file.c_str()) != 0 ||
      ::fstatat(to.get(), file.c_str(), &status, AT_SYMLINK_NOFOLLOW) != 0) {
    throw_system_fault(target.string(), "cannot be written", errno);
  }
  if (!S_ISREG(status.st_mode) || status.st_nlink != 1)
    throw Error(Code::internal, "the reading process did not make an ordinary file");
  constexpr mode_t kOfPrograms = S_ISUID | S_ISGID;  // programs then run as their owner or group
  if ((status.st_mode & kOfPrograms) != 0) {
    const Descriptor opened(own.file(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK);
    (void)::fchmod(opened.get(), status.st_mode & ~kOfPrograms & 07777U);
  }
  return own;
}

std::vector<std::string> OutputDeputy::do_as_asked(std::string_view request) const {
  std::vector<Scratch> scratches;
  std::vector<FinishedFile> files;
  std::vector<FilePath> first;
  std::vector<FilePath> removed;
  std::string scratch;
  while (!request.empty()) {
    const auto [kind, text] = next_part(request);
    if (kind == kScratch) {
      scratch = text;
      continue;
    }
    const FilePath target = allowed(text);
    if (kind == kTarget) {
      scratches.push_back(taken(scratch, target));
      files.push_back({scratches.back().path(), target});
    } else {
      (kind == kRemovedFirst ? first : removed).push_back(target);
    }
  }
  return put_in_place(files, first, removed);
}

}  // namespace meshorder::command
