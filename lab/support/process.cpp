// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/support/process.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <system_error>

namespace meshorder::models {
namespace fs = std::filesystem;

namespace {

bool is_program(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored) && ::access(path.c_str(), X_OK) == 0;
}

[[noreturn]] void throw_errno(int code, const fs::path& program) {
  throw std::system_error(code, std::generic_category(), program.string());
}

/// What the child finds instead of the terminal: no input, and one file for both kinds of output.
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
  std::ifstream in(log);
  std::string last;
  for (std::string line; std::getline(in, line);) {
    const auto first = line.find_first_not_of(" \t\r");
    if (first != std::string::npos) last = line.substr(first, line.find_last_not_of(" \t\r") + 1 - first);
  }
  return last;
}

}  // namespace

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

Ended run_process(const fs::path& program, const std::vector<std::string>& arguments, const fs::path& folder,
                  const fs::path& log) {
  std::string name = program.string();
  std::vector<std::string> copies = arguments;
  std::vector<char*> argv{name.data()};
  for (std::string& argument : copies) argv.push_back(argument.data());
  argv.push_back(nullptr);

  const Redirections redirections(folder, log);
  pid_t child = 0;
  const int failed =
      ::posix_spawn(&child, program.c_str(), redirections.get(), nullptr, argv.data(), ::environ);
  if (failed != 0) throw_errno(failed, program);

  int status = 0;
  while (::waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) throw_errno(errno, program);
  }
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return {code, last_line_of(log)};
}

}  // namespace meshorder::models
