// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Preloaded into the command (LD_PRELOAD), it acts like libhdf5 or libnetcdf under the control of an
// attacker: the first opening of a file runs the attack HOSTILE and prints to stdout whether it succeeded.
//
//   HOSTILE=ATTACK      a name in the table of `attacks`; "be absent": the libraries cannot be loaded
//   HOSTILE_PATH=PATH   the target of the attack
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/ptrace.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string>

namespace {

constexpr const char* kVersion = "GLIBC_2.34";  // of dlsym and dlopen

const char* path() {
  const char* const value = std::getenv("HOSTILE_PATH");
  return value != nullptr ? value : "";
}

// ---- faults, which do not return

int crash() {
  int* volatile nowhere = nullptr;
  return *nowhere;
}
int give_back_nonsense() {
  alignas(16) static std::array<char, 64> nonsense{};
  void* volatile chosen = nonsense.data() + 16;
  std::free(chosen);
  return 0;
}
int loop() {
  volatile bool is_endless = true;
  while (is_endless) continue;
  return 0;
}
int wait_for_ever() {
  for (;;) ::pause();
}

// ---- attacks: −1 if the system refuses them

int read_file() { return ::open(path(), O_RDONLY); }
int write_file() { return ::open(path(), O_WRONLY | O_CREAT | O_TRUNC, 0666); }
int cut_file() { return ::truncate(path(), 0); }
int remove_file() { return ::unlink(path()); }
int rename_file() { return ::rename(path(), (std::string(path()) + ".gone").c_str()); }
int make_link() { return ::symlink("/etc/passwd", path()); }
int make_hard_link() { return ::link(path(), (std::string(path()) + ".link").c_str()); }
int make_folder() { return ::mkdir(path(), 0777); }
int change_mode() { return ::chmod(path(), 0777); }
int use_network() { return ::socket(AF_INET, SOCK_STREAM, 0); }
int use_local_socket() { return ::socket(AF_UNIX, SOCK_STREAM, 0); }
int start_process() {
  const pid_t process = ::fork();
  if (process == 0) ::_exit(0);
  return process;
}
int start_program() { return ::access("/bin/true", X_OK) == 0 ? ::execl("/bin/true", "true", nullptr) : -1; }
int signal_parent() { return ::kill(::getppid(), 0); }
int trace_parent() { return static_cast<int>(::ptrace(PTRACE_SEIZE, ::getppid(), nullptr, nullptr)); }
int type_into_terminal() { return ::ioctl(STDIN_FILENO, TIOCSTI, "#"); }

struct Attack {
  const char* name;
  int (*run)();
};
constexpr Attack kAttacks[]{
    {"crash", crash},
    {"give back nonsense", give_back_nonsense},
    {"abort",
     [] {
       std::abort();
       return 0;
     }},
    {"loop", loop},
    {"wait", wait_for_ever},
    {"read", read_file},
    {"write", write_file},
    {"cut", cut_file},
    {"remove", remove_file},
    {"rename", rename_file},
    {"link", make_link},
    {"hard link", make_hard_link},
    {"make a folder", make_folder},
    {"change the mode", change_mode},
    {"use the network", use_network},
    {"use a local socket", use_local_socket},
    {"start a process", start_process},
    {"start a program", start_program},
    {"signal the parent", signal_parent},
    {"trace the parent", trace_parent},
    {"type", type_into_terminal},
};

void attack() {
  const char* const wanted = std::getenv("HOSTILE");
  for (const auto& [name, run] : kAttacks) {
    if (wanted == nullptr || std::strcmp(name, wanted) != 0) continue;
    errno = 0;
    const bool was_possible = run() >= 0;
    const std::string line = std::string("hostile: ") + name +
                             (was_possible ? " done\n" : ": " + std::string(std::strerror(errno)) + "\n");
    (void)!::write(STDOUT_FILENO, line.data(), line.size());
  }
}

void attack_once() {
  static const bool has_attacked = (attack(), true);
  (void)has_attacked;
}

using Opening = std::int64_t(const char* name, unsigned flags, std::int64_t access);
using ClassicOpening = int(const char* name, int mode, std::size_t* buffer, int* file);

// the libraries' own functions
Opening* real_opening = nullptr;
ClassicOpening* real_classic_opening = nullptr;

std::int64_t open_file(const char* name, unsigned flags, std::int64_t access) {
  attack_once();
  return real_opening(name, flags, access);
}

// opens files of netCDF-3, which libhdf5 does not see
int open_classic_file(const char* name, int mode, std::size_t* buffer, int* file) {
  attack_once();
  return real_classic_opening(name, mode, buffer, file);
}

}  // namespace

/// The command finds the functions of both libraries by their names. Returns the attacking ones instead.
extern "C" void* dlsym(void* library, const char* name) {
  static const auto find =
      reinterpret_cast<void* (*)(void*, const char*)>(::dlvsym(RTLD_NEXT, "dlsym", kVersion));
  void* const found = find(library, name);
  if (std::strcmp(name, "H5Fopen") == 0) {
    real_opening = reinterpret_cast<Opening*>(found);
    return reinterpret_cast<void*>(open_file);
  }
  if (std::strcmp(name, "nc__open") == 0) {
    real_classic_opening = reinterpret_cast<ClassicOpening*>(found);
    return reinterpret_cast<void*>(open_classic_file);
  }
  return found;
}

/// Fails to load any library if HOSTILE is "be absent".
extern "C" void* dlopen(const char* name, int mode) {
  static const auto load =
      reinterpret_cast<void* (*)(const char*, int)>(::dlvsym(RTLD_NEXT, "dlopen", kVersion));
  const char* const wanted = std::getenv("HOSTILE");
  const bool is_absent = wanted != nullptr && std::strcmp(wanted, "be absent") == 0;
  return load(is_absent && name != nullptr ? "libabsent.so.1" : name, mode);
}
