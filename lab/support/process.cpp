// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/support/process.hpp"

#include "base/input_file.hpp"
#include <meshorder/error.hpp>

#include <fcntl.h>
#include <spawn.h>
#include <sys/personality.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <new>
#include <sstream>
#include <system_error>
#include <utility>

namespace meshorder {
namespace fs = std::filesystem;

namespace {

/// Executes the program, in the child after fork, where only system calls are allowed.
[[noreturn]] void become(const char* program, char* const* arguments, int socket, bool fixed_addresses,
                         pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(127);
  struct sigaction ignore {};
  ignore.sa_handler = SIG_IGN;
  ::sigaction(SIGINT, &ignore, nullptr);
  // if standard streams are closed, the socket may have one of their numbers, and exec would close it
  if (socket <= STDERR_FILENO) socket = ::fcntl(socket, F_DUPFD, STDERR_FILENO + 1);
  ::dup2(socket, STDIN_FILENO);
  ::dup2(socket, STDOUT_FILENO);
  if (fixed_addresses) ::personality(ADDR_NO_RANDOMIZE);
  ::execv(program, arguments);
  ::_exit(127);
}

/// Returns pointers to the words (a program and its arguments), then nullptr, as `exec` takes them.
std::vector<char*> pointers_to(std::vector<std::string>& words) {
  std::vector<char*> argv;
  argv.reserve(words.size() + 1);
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  return argv;
}

std::vector<std::string> command_line(const fs::path& program, const std::vector<std::string>& arguments) {
  std::vector<std::string> words{program.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  return words;
}

/// Waits for a child to end. Returns false, with the reason in errno, if there is no such child.
bool wait_for(pid_t child, int& status) {
  pid_t ended = 0;
  do ended = ::waitpid(child, &status, 0);
  while (ended < 0 && errno == EINTR);
  return ended >= 0;
}

bool is_program(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored) && ::access(path.c_str(), X_OK) == 0;
}

[[noreturn]] void throw_errno(int code, const fs::path& program) {
  throw std::system_error(code, std::generic_category(), program.string());
}

/// A child's streams instead of the terminal: no input, and one file for both kinds of output.
class Redirections {
 public:
  Redirections(const fs::path& folder, const fs::path& log) {
    ::posix_spawn_file_actions_init(&actions_);
    ::posix_spawn_file_actions_addopen(&actions_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    ::posix_spawn_file_actions_addopen(&actions_, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC,
                                       0644);
    ::posix_spawn_file_actions_adddup2(&actions_, STDOUT_FILENO, STDERR_FILENO);
    ::posix_spawn_file_actions_addchdir_np(&actions_, folder.c_str());
  }
  ~Redirections() { ::posix_spawn_file_actions_destroy(&actions_); }
  Redirections(const Redirections&) = delete;
  Redirections(Redirections&&) = delete;
  Redirections& operator=(const Redirections&) = delete;
  Redirections& operator=(Redirections&&) = delete;

  [[nodiscard]] const posix_spawn_file_actions_t* get() const noexcept { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_{};
};

std::string last_line_of(const fs::path& log) {
  constexpr std::size_t kMost = std::size_t{1} << 26;
  std::istringstream in(InputFile(log, std::array{log.parent_path()}).text(kMost));
  std::string last;
  for (std::string line; std::getline(in, line);) {
    const auto first = line.find_first_not_of(" \t\r");
    if (first != std::string::npos) last = line.substr(first, line.find_last_not_of(" \t\r") + 1 - first);
  }
  return last;
}

}  // namespace

ChildProcess::ChildProcess(std::filesystem::path program, const std::vector<std::string>& arguments,
                           bool fixed_addresses)
    : program_(std::move(program)) {
  std::array<int, 2> sockets{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, sockets.data()) != 0)
    throw InputError(program_.string(), std::string("cannot be started: ") + std::strerror(errno),
                     "try again");
  std::vector<std::string> words = command_line(program_, arguments);
  const std::vector<char*> argv = pointers_to(words);
  const pid_t parent = ::getpid();
  stream_ = ::fdopen(sockets[0], "r");
  if (stream_ != nullptr) id_ = ::fork();
  if (id_ == 0) become(words.front().c_str(), argv.data(), sockets[1], fixed_addresses, parent);
  const int error = errno;
  ::close(sockets[1]);
  if (id_ > 0) return;
  (void)(stream_ != nullptr ? std::fclose(stream_) : ::close(sockets[0]));
  throw InputError(program_.string(), std::string("cannot be started: ") + std::strerror(error), "try again");
}

ChildProcess::~ChildProcess() {
  std::fclose(stream_);
  if (id_ <= 0) return;
  ::kill(id_, SIGKILL);  // safe: the child owns no files or locks
  int status = 0;
  wait_for(id_, status);
}

void ChildProcess::send(std::string_view line) {
  std::string text(line);
  text += '\n';
  send_bytes(std::as_bytes(std::span(text)));
}

void ChildProcess::send_bytes(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = ::send(::fileno(stream_), bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent < 0) throw_ended();
    bytes = bytes.subspan(static_cast<std::size_t>(sent));
  }
}

void ChildProcess::receive_bytes(std::span<std::byte> bytes) {
  while (!bytes.empty()) {
    std::clearerr(stream_);
    errno = 0;
    const std::size_t received = std::fread(bytes.data(), 1, bytes.size(), stream_);
    bytes = bytes.subspan(received);
    // a signal that the parent handles interrupts the wait
    if (!bytes.empty() && errno != EINTR) throw_ended();
  }
}

std::string ChildProcess::receive() {
  char* buffer = nullptr;
  std::size_t capacity = 0;
  ssize_t length = -1;
  do {  // a signal that the parent handles interrupts the wait
    std::clearerr(stream_);
    errno = 0;
    length = ::getline(&buffer, &capacity, stream_);
  } while (length < 0 && errno == EINTR);
  const int error = errno;
  std::string line = length > 0 ? std::string(buffer, static_cast<std::size_t>(length)) : std::string();
  std::free(buffer);  // NOLINT(cppcoreguidelines-no-malloc): getline allocated it
  if (line.empty() && error == ENOMEM) throw std::bad_alloc();
  if (line.empty()) throw_ended();
  if (line.back() == '\n') line.pop_back();
  return line;
}

void ChildProcess::throw_ended() {
  ::shutdown(::fileno(stream_), SHUT_RDWR);  // ends a child that still waits for a line
  int status = -1;
  if (id_ > 0) wait_for(std::exchange(id_, -1), status);
  std::string how = "ended";
  if (status == -1) throw InputError(program_.string(), "a child process has already ended", "start again");
  if (WIFSIGNALED(status)) how = std::string("was ended by a signal: ") + ::strsignal(WTERMSIG(status));
  if (WIFEXITED(status)) how = "ended with status " + std::to_string(WEXITSTATUS(status));
  throw InputError(program_.string(), "a child process " + how, "is there enough memory?");
}

bool has_fixed_addresses() {
  constexpr unsigned long kAsk = 0xffffffff;
  const int traits = ::personality(kAsk);
  return traits != -1 && (traits & ADDR_NO_RANDOMIZE) != 0;
}

fs::path find_program(std::string_view name) {
  std::error_code code;
  const fs::path self = fs::read_symlink("/proc/self/exe", code);
  if (!code && is_program(self.parent_path() / name)) return self.parent_path() / name;

  const char* const variable = std::getenv("PATH");
  std::string_view folders = variable != nullptr ? variable : "/usr/local/bin:/usr/bin:/bin";
  while (!folders.empty()) {
    const std::string_view folder = folders.substr(0, folders.find(':'));
    folders.remove_prefix(std::min(folders.size(), folder.size() + 1));
    if (folder.empty()) continue;
    const fs::path candidate = fs::path(folder) / name;
    if (is_program(candidate)) return fs::absolute(candidate);
  }
  return {};
}

ExitStatus run_process(const fs::path& program, const std::vector<std::string>& arguments,
                       const fs::path& folder, const fs::path& log) {
  std::vector<std::string> words = command_line(program, arguments);
  const std::vector<char*> argv = pointers_to(words);
  const Redirections redirections(folder, log);
  pid_t child = 0;
  const int failed =
      ::posix_spawn(&child, program.c_str(), redirections.get(), nullptr, argv.data(), ::environ);
  if (failed != 0) throw_errno(failed, program);

  int status = 0;
  if (!wait_for(child, status)) throw_errno(errno, program);
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return {code, last_line_of(log)};
}

}  // namespace meshorder
