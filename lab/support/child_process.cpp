// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/support/child_process.hpp"

#include "base/error.hpp"

#include <sys/personality.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <utility>

namespace meshorder {
namespace {

/// What the child does between fork and exec, where only system calls are allowed.
[[noreturn]] void become(const char* program, char* const* arguments, int socket, bool fixed_addresses,
                         pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(127);
  struct sigaction ignore {};
  ignore.sa_handler = SIG_IGN;
  ::sigaction(SIGINT, &ignore, nullptr);
  ::dup2(socket, STDIN_FILENO);
  ::dup2(socket, STDOUT_FILENO);
  if (fixed_addresses) ::personality(ADDR_NO_RANDOMIZE);
  ::execv(program, arguments);
  ::_exit(127);
}

}  // namespace

ChildProcess::ChildProcess(std::filesystem::path program, const std::vector<std::string>& arguments,
                           bool fixed_addresses)
    : program_(std::move(program)) {
  std::array<int, 2> sockets{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, sockets.data()) != 0)
    throw Error(program_.string(), std::string("cannot be started: ") + std::strerror(errno), "try again");
  std::vector<std::string> copies{program_.string()};
  copies.insert(copies.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  argv.reserve(copies.size() + 1);
  for (std::string& argument : copies) argv.push_back(argument.data());
  argv.push_back(nullptr);
  const pid_t parent = ::getpid();
  id_ = ::fork();
  if (id_ == 0) become(copies.front().c_str(), argv.data(), sockets[1], fixed_addresses, parent);
  ::close(sockets[1]);
  socket_ = sockets[0];
  if (id_ > 0) replies_ = ::fdopen(::dup(socket_), "r");
  if (replies_ != nullptr) return;
  ::close(socket_);
  throw Error(program_.string(), std::string("cannot be started: ") + std::strerror(errno), "try again");
}

ChildProcess::~ChildProcess() {
  std::fclose(replies_);
  ::close(socket_);
  if (id_ <= 0) return;
  ::kill(id_, SIGKILL);  // it holds nothing that it would have to bring to an end
  int status = 0;
  while (::waitpid(id_, &status, 0) < 0 && errno == EINTR) {
  }
}

void ChildProcess::send(std::string_view line) {
  std::string text(line);
  text += '\n';
  for (std::string_view left = text; !left.empty();) {
    const ssize_t sent = ::send(socket_, left.data(), left.size(), MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent < 0) throw_ended();
    left.remove_prefix(static_cast<std::size_t>(sent));
  }
}

std::string ChildProcess::receive() {
  char* buffer = nullptr;
  std::size_t capacity = 0;
  ssize_t length = -1;
  do {  // a signal that the parent takes note of interrupts the wait
    std::clearerr(replies_);
    errno = 0;
    length = ::getline(&buffer, &capacity, replies_);
  } while (length < 0 && errno == EINTR);
  std::string line = length > 0 ? std::string(buffer, static_cast<std::size_t>(length)) : std::string();
  std::free(buffer);  // NOLINT(cppcoreguidelines-no-malloc): getline's
  if (line.empty()) throw_ended();
  if (line.back() == '\n') line.pop_back();
  return line;
}

void ChildProcess::throw_ended() {
  int status = 0;
  const pid_t ended = std::exchange(id_, -1);
  while (::waitpid(ended, &status, 0) < 0 && errno == EINTR) {
  }
  std::string how = "ended";
  if (WIFSIGNALED(status)) how = std::string("was ended by a signal: ") + ::strsignal(WTERMSIG(status));
  if (WIFEXITED(status)) how = "ended with status " + std::to_string(WEXITSTATUS(status));
  throw Error(program_.string(), "a process of it " + how, "is there enough memory?");
}

bool has_fixed_addresses() {
  constexpr unsigned long kAsk = 0xffffffff;
  const int traits = ::personality(kAsk);
  return traits != -1 && (traits & ADDR_NO_RANDOMIZE) != 0;
}

}  // namespace meshorder
