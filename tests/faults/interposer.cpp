// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
//
// Preloaded into the command (LD_PRELOAD): counts its calls by kind from the first line of main to the end of
// the process, and makes chosen ones fail. Environment variables control it:
//
// - FAULTS_COUNTERS=FILE: keeps in FILE the number of calls of each kind and that of failures, 64 bits each;
// - FAULTS_FAIL=KIND:N[+]:WHAT: the Nth call of a kind fails, counted from 1; with + also all later ones;
// - FAULTS_LOG=FILE: appends a line for each call that changes files, and the stack of an abort;
// - FAULTS_OPENED=FILE: appends the path, links resolved, of each file that is opened.
//
// KIND is a word of `kKindNames`. WHAT is a number of errno, `short` (half of the bytes), `kill` (SIGKILL
// before the call) or `torn` (half of the bytes, then SIGKILL). The interposer does not see calls within the
// C library: it sees the opening of stdio's files, but not their writes and closing. The list of opened files
// lacks listed folders, loaded libraries and the C library's own files (locales). Programs that the command
// starts run without the interposer. Syncing does nothing, to save time.
#include <dlfcn.h>
#include <execinfo.h>
#include <fcntl.h>
#include <pthread.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

// the C library's own functions; its manual allows a replacement to call them
extern "C" void* __libc_malloc(std::size_t size);
extern "C" void* __libc_calloc(std::size_t count, std::size_t size);
extern "C" void* __libc_realloc(void* block, std::size_t size);
extern "C" void* __libc_memalign(std::size_t alignment, std::size_t size);

namespace {

enum Kind : std::size_t { kAllocation, kOpen, kRead, kWrite, kSync, kClose, kRename, kThread, kKinds };
constexpr std::array<const char*, kKinds> kKindNames{"allocation", "open",  "read",   "write",
                                                     "sync",       "close", "rename", "thread"};

enum class What { error, half, kill, torn };

struct Fault {
  std::size_t kind = kKinds;
  std::uint64_t nth = 0;
  bool later = false;
  What what = What::error;
  int error = 0;
};

// NOLINTBEGIN(cppcoreguidelines-avoid-non-const-global-variables): interposed functions have no other state
bool active = false;
Fault fault;
int log_file = -1;
int opened_file = -1;
std::array<std::uint64_t, kKinds + 1> unshared_counters{};
std::uint64_t* counters = unshared_counters.data();
int (*real_main)(int, char**, char**) = nullptr;
std::FILE* (*real_fopen)(const char*, const char*) = nullptr;
int (*real_pthread_create)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*) = nullptr;
// NOLINTEND(cppcoreguidelines-avoid-non-const-global-variables)

void log_line(const char* verb, const char* first, const char* second = "") {
  if (log_file < 0) return;
  std::array<char, 4096> line{};
  const int length =
      std::snprintf(line.data(), line.size(), "%s %s%s%s\n", verb, first, *second != '\0' ? " " : "", second);
  syscall(SYS_write, log_file, line.data(), static_cast<std::size_t>(length));
}

void log_descriptor(const char* verb, int descriptor) {
  if (log_file < 0) return;
  std::array<char, 64> link{};
  std::snprintf(link.data(), link.size(), "/proc/self/fd/%d", descriptor);
  std::array<char, 2048> path{};
  if (syscall(SYS_readlink, link.data(), path.data(), path.size() - 1) > 0) log_line(verb, path.data());
}

/// Logs an opened file, unless O_PATH opened it only as a step to another one.
void log_opened(int descriptor, int flags) {
  if (opened_file < 0 || descriptor < 0 || (flags & O_PATH) != 0) return;
  std::array<char, 64> link{};
  std::snprintf(link.data(), link.size(), "/proc/self/fd/%d", descriptor);
  std::array<char, 4096> path{};
  const auto length = syscall(SYS_readlink, link.data(), path.data(), path.size() - 1);
  if (length <= 0) return;
  path[static_cast<std::size_t>(length)] = '\n';
  syscall(SYS_write, opened_file, path.data(), static_cast<std::size_t>(length) + 1);
}

/// Opens a file of the interposer, with a descriptor above all others: the command's descriptors stay the
/// same.
int own_file(const char* path) {
  constexpr int kAboveAll = 500;
  const int file = static_cast<int>(syscall(SYS_openat, AT_FDCWD, path, O_WRONLY | O_APPEND | O_CREAT, 0644));
  const int moved = fcntl(file, F_DUPFD_CLOEXEC, kAboveAll);
  syscall(SYS_close, file);
  return moved;
}

[[noreturn]] void die() {
  syscall(SYS_kill, getpid(), SIGKILL);
  for (;;) pause();
}

/// Writes a line and then the call stack to the log.
void log_functions(const char* why, const char* what) {
  if (log_file < 0) return;
  active = false;
  std::array<void*, 64> frames{};
  log_line(why, what);
  backtrace_symbols_fd(frames.data(), backtrace(frames.data(), static_cast<int>(frames.size())), log_file);
  active = true;
}

/// Counts a call. Returns its fault, or nullptr. Does not return if the fault is `kill`.
const Fault* fault_of(Kind kind) {
  if (!active) return nullptr;
  const std::uint64_t count = __atomic_add_fetch(&counters[kind], 1, __ATOMIC_RELAXED);
  if (fault.kind != kind || (fault.later ? count < fault.nth : count != fault.nth)) return nullptr;
  __atomic_add_fetch(&counters[kKinds], 1, __ATOMIC_RELAXED);
  if (fault.what == What::kill) die();
  if (kind == kAllocation) log_functions("failed", kKindNames[kind]);
  if (fault.what == What::error) errno = fault.error;
  return &fault;
}

/// Returns whether a call that cannot be done in part must fail.
bool fails(Kind kind) {
  const Fault* const found = fault_of(kind);
  return found != nullptr && found->what == What::error;
}

/// Reads or writes `size` bytes by `call`, or half of them, or fails.
template <class Call>
ssize_t transfer(Kind kind, std::size_t size, const Call& call) {
  const Fault* const found = fault_of(kind);
  if (found == nullptr) return call(size);
  if (found->what == What::error) return -1;
  const ssize_t done = call(size > 1 ? size / 2 : size);
  if (found->what == What::torn) die();
  return done;
}

void set_fault(const char* text) {
  std::array<char, 16> kind{}, nth{}, what{};
  if (std::sscanf(text, "%15[a-z]:%15[0-9+]:%15[a-z0-9]", kind.data(), nth.data(), what.data()) != 3) die();
  const auto* const name = std::find_if(kKindNames.begin(), kKindNames.end(), [&](const char* each) {
    return std::strcmp(each, kind.data()) == 0;
  });
  if (name == kKindNames.end()) die();
  fault.kind = static_cast<std::size_t>(name - kKindNames.begin());
  fault.nth = std::strtoull(nth.data(), nullptr, 10);
  fault.later = std::strchr(nth.data(), '+') != nullptr;
  if (std::strcmp(what.data(), "short") == 0)
    fault.what = What::half;
  else if (std::strcmp(what.data(), "kill") == 0)
    fault.what = What::kill;
  else if (std::strcmp(what.data(), "torn") == 0)
    fault.what = What::torn;
  else
    fault.error = static_cast<int>(std::strtol(what.data(), nullptr, 10));
}

extern "C" void log_stack(int signal) {
  log_functions("signal", strsignal(signal));
  active = false;
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

void prepare() {
  if (const char* const path = std::getenv("FAULTS_COUNTERS")) {
    const int file = static_cast<int>(syscall(SYS_openat, AT_FDCWD, path, O_RDWR | O_CLOEXEC));
    void* const shared =
        mmap(nullptr, sizeof(unshared_counters), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    if (shared == MAP_FAILED) die();
    counters = static_cast<std::uint64_t*>(shared);
    syscall(SYS_close, file);
  }
  if (const char* const path = std::getenv("FAULTS_LOG")) {
    log_file = own_file(path);
    std::array<void*, 1> frame{};
    backtrace(frame.data(), 1);                         // loads what it needs
    static std::array<char, 1 << 16> handlers_stack{};  // the process's own may have overflowed
    const stack_t stack{.ss_sp = handlers_stack.data(), .ss_flags = 0, .ss_size = handlers_stack.size()};
    sigaltstack(&stack, nullptr);
    struct sigaction action {};
    action.sa_handler = log_stack;
    action.sa_flags = SA_ONSTACK;
    for (const int signal : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL}) sigaction(signal, &action, nullptr);
  }
  if (const char* const path = std::getenv("FAULTS_OPENED")) opened_file = own_file(path);
  if (const char* const text = std::getenv("FAULTS_FAIL")) set_fault(text);
  for (const char* const name :
       {"LD_PRELOAD", "FAULTS_COUNTERS", "FAULTS_LOG", "FAULTS_OPENED", "FAULTS_FAIL"})
    unsetenv(name);
  real_fopen = reinterpret_cast<decltype(real_fopen)>(dlsym(RTLD_NEXT, "fopen"));
  real_pthread_create = reinterpret_cast<decltype(real_pthread_create)>(dlsym(RTLD_NEXT, "pthread_create"));
}

int counted_main(int argc, char** argv, char** environment) {
  prepare();
  active = true;
  return real_main(argc, argv, environment);
}

int open_at(int folder, const char* path, int flags, mode_t mode) {
  if ((flags & O_ACCMODE) != O_RDONLY) log_line("open", path);
  if (fails(kOpen)) return -1;
  const int descriptor = static_cast<int>(syscall(SYS_openat, folder, path, flags, mode));
  const int error = errno;
  log_opened(descriptor, flags);
  errno = error;
  return descriptor;
}

mode_t mode_of(int flags, std::va_list arguments) {
  return (flags & O_CREAT) != 0 || (flags & O_TMPFILE) == O_TMPFILE ? va_arg(arguments, mode_t) : 0;
}

int rename_at(int from_folder, const char* from, int to_folder, const char* to, unsigned flags) {
  if (fails(kRename)) return -1;
  log_line("rename", from, to);
  return static_cast<int>(syscall(SYS_renameat2, from_folder, from, to_folder, to, flags));
}

int sync_descriptor(int descriptor) {
  if (fails(kSync)) return -1;
  log_descriptor("sync", descriptor);
  return 0;
}

ssize_t write_vector(int descriptor, const iovec* parts, int count) {
  log_descriptor("write", descriptor);
  return transfer(kWrite, static_cast<std::size_t>(count),
                  [&](std::size_t some) { return syscall(SYS_writev, descriptor, parts, some); });
}

}  // namespace

extern "C" {

int __libc_start_main(int (*main)(int, char**, char**), int argc, char** argv, void (*init)(), void (*fini)(),
                      void (*rtld_fini)(), void* stack_end) {
  real_main = main;
  const auto real = reinterpret_cast<decltype(&__libc_start_main)>(dlsym(RTLD_NEXT, "__libc_start_main"));
  return real(counted_main, argc, argv, init, fini, rtld_fini, stack_end);
}

void* malloc(std::size_t size) noexcept { return fails(kAllocation) ? nullptr : __libc_malloc(size); }
void* calloc(std::size_t count, std::size_t size) noexcept {
  return fails(kAllocation) ? nullptr : __libc_calloc(count, size);
}
void* realloc(void* block, std::size_t size) noexcept {
  return fails(kAllocation) ? nullptr : __libc_realloc(block, size);
}
void* memalign(std::size_t alignment, std::size_t size) noexcept {
  return fails(kAllocation) ? nullptr : __libc_memalign(alignment, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept { return memalign(alignment, size); }
int posix_memalign(void** block, std::size_t alignment, std::size_t size) noexcept {
  void* const found = memalign(alignment, size);
  if (found == nullptr) return ENOMEM;
  *block = found;
  return 0;
}

int open(const char* path, int flags, ...) {
  std::va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = mode_of(flags, arguments);
  va_end(arguments);
  return open_at(AT_FDCWD, path, flags, mode);
}
int open64(const char* path, int flags, ...) __attribute__((alias("open")));
int openat(int folder, const char* path, int flags, ...) {
  std::va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = mode_of(flags, arguments);
  va_end(arguments);
  return open_at(folder, path, flags, mode);
}
int openat64(int folder, const char* path, int flags, ...) __attribute__((alias("openat")));
std::FILE* fopen(const char* path, const char* mode) {
  if (*mode != 'r') log_line("open", path);
  if (fails(kOpen)) return nullptr;
  std::FILE* const file = real_fopen(path, mode);
  if (file != nullptr) log_opened(fileno(file), 0);
  return file;
}
std::FILE* fopen64(const char* path, const char* mode) __attribute__((alias("fopen")));

ssize_t read(int descriptor, void* into, std::size_t size) {
  return transfer(kRead, size, [&](std::size_t some) { return syscall(SYS_read, descriptor, into, some); });
}
ssize_t pread(int descriptor, void* into, std::size_t size, off_t at) {
  return transfer(kRead, size,
                  [&](std::size_t some) { return syscall(SYS_pread64, descriptor, into, some, at); });
}
ssize_t pread64(int descriptor, void* into, std::size_t size, off_t at) __attribute__((alias("pread")));

ssize_t write(int descriptor, const void* from, std::size_t size) {
  log_descriptor("write", descriptor);
  return transfer(kWrite, size, [&](std::size_t some) { return syscall(SYS_write, descriptor, from, some); });
}
ssize_t pwrite(int descriptor, const void* from, std::size_t size, off_t at) {
  log_descriptor("write", descriptor);
  return transfer(kWrite, size,
                  [&](std::size_t some) { return syscall(SYS_pwrite64, descriptor, from, some, at); });
}
ssize_t pwrite64(int descriptor, const void* from, std::size_t size, off_t at)
    __attribute__((alias("pwrite")));
ssize_t writev(int descriptor, const iovec* parts, int count) {
  return write_vector(descriptor, parts, count);
}

int fsync(int descriptor) { return sync_descriptor(descriptor); }
int fdatasync(int descriptor) { return sync_descriptor(descriptor); }

// the descriptor is free even after a failure, as on Linux
int close(int descriptor) {
  const bool failed = fails(kClose);
  const int error = errno;
  const auto result = static_cast<int>(syscall(SYS_close, descriptor));
  if (failed) errno = error;
  return failed ? -1 : result;
}

int rename(const char* from, const char* to) noexcept { return rename_at(AT_FDCWD, from, AT_FDCWD, to, 0); }
int renameat(int from_folder, const char* from, int to_folder, const char* to) noexcept {
  return rename_at(from_folder, from, to_folder, to, 0);
}
int renameat2(int from_folder, const char* from, int to_folder, const char* to, unsigned flags) noexcept {
  return rename_at(from_folder, from, to_folder, to, flags);
}
int link(const char* from, const char* to) noexcept {
  log_line("link", from, to);
  return static_cast<int>(syscall(SYS_linkat, AT_FDCWD, from, AT_FDCWD, to, 0));
}
int unlink(const char* path) noexcept {
  log_line("unlink", path);
  return static_cast<int>(syscall(SYS_unlink, path));
}

int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*start)(void*),
                   void* argument) noexcept {
  return fails(kThread) ? fault.error : real_pthread_create(thread, attributes, start, argument);
}

}  // extern "C"
