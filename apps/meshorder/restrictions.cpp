// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "restrictions.hpp"

#include <sys/resource.h>

#ifdef __linux__
#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <new>
#include <set>
#include <system_error>
#endif

namespace meshorder::command {
#ifdef __linux__
namespace {

namespace fs = std::filesystem;

// ---- Landlock; its numbers are given here because the headers of older systems lack some of them

constexpr long kCreateRuleset = 444;
constexpr long kAddRule = 445;
constexpr long kRestrictSelf = 446;

enum : std::uint64_t {
  kWriteFile = 1U << 1U,
  kReadFile = 1U << 2U,
  kReadFolder = 1U << 3U,
  kRead = kReadFile | kReadFolder,
  kOfVersion1 = (1U << 13U) - 1,
  kMakeDevices = (1U << 6U) | (1U << 9U) | (1U << 10U) | (1U << 11U),  // also sockets and pipes
  kMakeLinks = 1U << 12U,
  kExecute = 1U << 0U,
  kMoveBetweenFolders = 1U << 13U,  // of version 2
  kTruncate = 1U << 14U,            // of version 3
  kControlDevices = 1U << 15U,      // of version 5
  kChange = (kOfVersion1 & ~kRead & ~kExecute) | kMoveBetweenFolders | kTruncate,
};

struct RulesetAttributes {
  std::uint64_t files;
  std::uint64_t network;  // from version 4 on: 1 listen, 2 connect
  std::uint64_t scopes;   // from version 6 on: 1 abstract sockets, 2 signals
};

struct [[gnu::packed]] PathAttributes {
  std::uint64_t allowed;
  std::int32_t descriptor;
};

constexpr std::array kSystemFiles{"/usr",
                                  "/lib",
                                  "/lib32",
                                  "/lib64",
                                  "/nix/store",
                                  "/gnu/store",
                                  "/etc/ld.so.cache",
                                  "/etc/localtime",
                                  "/sys/devices/system",
                                  "/sys/fs/cgroup",
                                  "/sys/kernel/mm",
                                  "/proc/self",
                                  "/proc/cpuinfo",
                                  "/proc/meminfo",
                                  "/proc/stat",
                                  "/proc/version",
                                  "/proc/sys",
                                  "/dev/null",
                                  "/dev/zero",
                                  "/dev/random",
                                  "/dev/urandom"};

}  // namespace

/// A set of rules for what the process may do with files. Everything that no rule allows is denied.
class Ruleset {
 public:
  /// Makes a set that denies all that the system can deny.
  Ruleset() {
    const long version = version_of_system();
    if (version < 1) return;
    RulesetAttributes attributes{kOfVersion1, 0, 0};
    if (version >= 2) attributes.files |= kMoveBetweenFolders;
    if (version >= 3) attributes.files |= kTruncate;
    if (version >= 4) attributes.network = 3;
    if (version >= 5) attributes.files |= kControlDevices;
    if (version >= 6) attributes.scopes = 3;
    create(attributes);
  }
  /// Makes a set that denies these actions, if the system can deny them all.
  explicit Ruleset(std::uint64_t denied) {
    constexpr long kWithTruncate = 3;
    if (version_of_system() >= kWithTruncate) create({denied, 0, 0});
  }
  ~Ruleset() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  Ruleset(const Ruleset&) = delete;
  Ruleset(Ruleset&&) = delete;
  Ruleset& operator=(const Ruleset&) = delete;
  Ruleset& operator=(Ruleset&&) = delete;

  void allow(const fs::path& path, std::uint64_t allowed) const noexcept {
    if (descriptor_ < 0) return;
    const int descriptor = ::open(path.c_str(), O_PATH | O_CLOEXEC);
    struct stat status {};
    if (descriptor >= 0 && ::fstat(descriptor, &status) == 0) {
      constexpr std::uint64_t kOfFiles = kExecute | kWriteFile | kReadFile | kTruncate | kControlDevices;
      if (!S_ISDIR(status.st_mode)) allowed &= kOfFiles;
      const PathAttributes attributes{allowed & handled_, descriptor};
      (void)::syscall(kAddRule, descriptor_, 1, &attributes, 0);
    }
    if (descriptor >= 0) ::close(descriptor);
  }

  [[nodiscard]] bool is_possible() const noexcept { return descriptor_ >= 0; }
  [[nodiscard]] bool enforce() const noexcept {
    return descriptor_ >= 0 && ::syscall(kRestrictSelf, descriptor_, 0) == 0;
  }

 private:
  static long version_of_system() noexcept { return ::syscall(kCreateRuleset, nullptr, 0, 1); }
  void create(const RulesetAttributes& attributes) noexcept {
    handled_ = attributes.files;
    descriptor_ = static_cast<int>(::syscall(kCreateRuleset, &attributes, sizeof attributes, 0));
  }

  int descriptor_ = -1;
  std::uint64_t handled_ = 0;
};

namespace {

void restrict_files(const Reach& reach) noexcept {
  const Ruleset rules;
  for (const char* const path : kSystemFiles) rules.allow(path, kRead);
  rules.allow("/dev/null", kReadFile | kWriteFile);
  for (const fs::path& path : reach.read) rules.allow(path, kRead);
  for (const fs::path& path : reach.through) rules.allow(path, kWriteFile);
  for (const fs::path& path : reach.write) {
    rules.allow(path,
                (kOfVersion1 & ~kMakeDevices & ~kMakeLinks & ~kExecute) | kMoveBetweenFolders | kTruncate);
  }
  (void)rules.enforce();
}

/// Allows changes to everything below a folder but the paths of `denied`, which are below it.
void allow_changes(const Ruleset& rules, const fs::path& folder, const std::vector<fs::path>& denied) {
  std::set<fs::path> on_the_way;  // entries of the folder that are denied or contain what is
  for (const fs::path& path : denied) on_the_way.insert(folder / *path.lexically_relative(folder).begin());
  std::error_code code;
  for (fs::directory_iterator entry(folder, code), end; !code && entry != end; entry.increment(code)) {
    std::error_code ignored;
    if (!on_the_way.contains(entry->path()) && !entry->is_symlink(ignored))
      rules.allow(entry->path(), kChange);
  }
  for (const fs::path& path : on_the_way) {
    std::vector<fs::path> below;
    std::ranges::copy_if(denied, std::back_inserter(below), [&](const fs::path& other) {
      return *other.lexically_relative(path).begin() != "..";
    });
    if (std::ranges::find(below, path) == below.end()) allow_changes(rules, path, below);
  }
}

// ---- seccomp

#if defined(__x86_64__)
constexpr std::uint32_t kArchitecture = AUDIT_ARCH_X86_64;
#elif defined(__aarch64__)
constexpr std::uint32_t kArchitecture = AUDIT_ARCH_AARCH64;
#elif defined(__riscv) && __riscv_xlen == 64
constexpr std::uint32_t kArchitecture = AUDIT_ARCH_RISCV64;
#else
constexpr std::uint32_t kArchitecture = 0;
#endif

// LeakSanitizer uses clone to make a process that attaches to all threads
#ifdef MESHORDER_IS_SANITIZED
constexpr bool kIsWatched = true;
#else
constexpr bool kIsWatched = false;
#endif

// calls that the headers of older systems lack; from 424 on, all architectures share the numbers
enum : std::uint32_t {
  kPidfdSendSignal = 424,
  kIoUringSetup = 425,
  kOpenTree = 428,
  kMoveMount = 429,
  kFsopen = 430,
  kPidfdOpen = 434,
  kClone3 = 435,
  kPidfdGetfd = 438,
  kFchmodat2 = 452,
  kSetxattrat = 463,
  kRemovexattrat = 466,
};

constexpr std::array<std::uint32_t, 67> kDenied{
    // the network
    SYS_socket, SYS_connect, SYS_bind, SYS_listen, SYS_accept, SYS_accept4,
    // programs and other processes
    SYS_execve, SYS_execveat, SYS_process_vm_readv, SYS_process_vm_writev, SYS_rt_sigqueueinfo,
    SYS_rt_tgsigqueueinfo, SYS_kcmp, SYS_setns, SYS_unshare, kPidfdOpen, kPidfdSendSignal, kPidfdGetfd,
    SYS_shmget, SYS_shmat, SYS_semget, SYS_semctl, SYS_msgget, SYS_msgctl, SYS_mq_open, SYS_mq_unlink,
    // files by their paths
    SYS_truncate, SYS_fchmodat, kFchmodat2, SYS_fchownat, SYS_setxattr, SYS_lsetxattr, kSetxattrat,
    SYS_removexattr, SYS_lremovexattr, kRemovexattrat, SYS_open_by_handle_at, SYS_inotify_init1,
    SYS_fanotify_init,
    // the system
    SYS_mount, SYS_umount2, SYS_pivot_root, SYS_chroot, kOpenTree, kMoveMount, kFsopen, SYS_swapon,
    SYS_swapoff, SYS_reboot, SYS_init_module, SYS_finit_module, SYS_delete_module, SYS_kexec_load, SYS_bpf,
    SYS_perf_event_open, SYS_userfaultfd, SYS_keyctl, SYS_add_key, SYS_request_key, SYS_clock_settime,
    SYS_settimeofday, SYS_adjtimex, SYS_clock_adjtime, SYS_sethostname, SYS_acct, SYS_syslog, kIoUringSetup};

#ifdef SYS_fork  // older calls, which newer architectures lack
constexpr std::array<std::uint32_t, 8> kDeniedOld{SYS_fork,   SYS_vfork, SYS_chmod,  SYS_chown,
                                                  SYS_lchown, SYS_utime, SYS_utimes, SYS_futimesat};
#else
constexpr std::array<std::uint32_t, 0> kDeniedOld{};
#endif

/// A program for the kernel's packet filter that allows or refuses system calls.
class CallFilter {
 public:
  CallFilter() {
    load(offsetof(seccomp_data, arch));
    jump_unless(BPF_JEQ, kArchitecture, 0, 1);
    add(BPF_JMP | BPF_JA, 1);
    refuse(EPERM);
    load(offsetof(seccomp_data, nr));
#ifdef __x86_64__
    constexpr std::uint32_t kX32 = 0x40000000;
    jump_unless(BPF_JGE, kX32, 0, 1);
    refuse(EPERM);
#endif
  }

  void deny(std::uint32_t call, int error = EPERM) {
    jump_unless(BPF_JEQ, call, 0, 1);
    refuse(error);
  }

  /// Allows a call only if `comparison` of the argument's lower half with the value is true.
  void allow_where(std::uint32_t call, std::uint32_t argument, std::uint16_t comparison,
                   std::uint32_t value) {
    jump_unless(BPF_JEQ, call, 0, 4);
    load_argument(argument);
    jump_unless(comparison, value, 0, 1);
    allow();
    refuse(EPERM);
  }

  /// Denies a call if the argument's lower half equals the value.
  void deny_where(std::uint32_t call, std::uint32_t argument, std::uint32_t value) {
    jump_unless(BPF_JEQ, call, 0, 4);
    load_argument(argument);
    jump_unless(BPF_JEQ, value, 0, 1);
    refuse(EPERM);
    load(offsetof(seccomp_data, nr));
  }

  void enforce() {
    allow();
    const sock_fprog program{static_cast<unsigned short>(code_.size()), code_.data()};
    // without this flag, older kernels add slow protections against speculative execution
    constexpr unsigned kNoSlowerCode = 1U << 2U;
    if (::syscall(SYS_seccomp, SECCOMP_SET_MODE_FILTER, kNoSlowerCode, &program) != 0)
      (void)::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program);
  }

 private:
  void add(unsigned code, std::uint32_t value, unsigned if_true = 0, unsigned if_false = 0) {
    code_.push_back({static_cast<std::uint16_t>(code), static_cast<std::uint8_t>(if_true),
                     static_cast<std::uint8_t>(if_false), value});
  }
  void load(std::size_t offset) { add(BPF_LD | BPF_W | BPF_ABS, static_cast<std::uint32_t>(offset)); }
  void load_argument(std::uint32_t argument) {  // only for machines that store the lower half first
    load(offsetof(seccomp_data, args) + sizeof(std::uint64_t) * argument);
  }
  void jump_unless(unsigned comparison, std::uint32_t value, unsigned if_true, unsigned if_false) {
    add(BPF_JMP | BPF_K | comparison, value, if_true, if_false);
  }
  void refuse(int error) { add(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | static_cast<std::uint32_t>(error)); }
  void allow() { add(BPF_RET | BPF_K, SECCOMP_RET_ALLOW); }

  std::vector<sock_filter> code_;
};

void restrict_calls() {
  if constexpr (kArchitecture == 0) return;
  CallFilter filter;
  for (const std::uint32_t call : kDenied) filter.deny(call);
  const auto self = static_cast<std::uint32_t>(::getpid());
  for (const auto call : std::array<std::uint32_t, 3>{SYS_kill, SYS_tkill, SYS_tgkill})
    filter.allow_where(call, 0, BPF_JEQ, self);
  filter.allow_where(SYS_prlimit64, 0, BPF_JEQ, 0);
  filter.allow_where(SYS_utimensat, 1, BPF_JEQ, 0);  // only by descriptor, without a path
  for (const auto request : std::array<std::uint32_t, 2>{TIOCSTI, TIOCLINUX})
    filter.deny_where(SYS_ioctl, 1, request);
  if constexpr (!kIsWatched) {
    for (const std::uint32_t call : kDeniedOld) filter.deny(call);
    filter.deny(SYS_ptrace);
    filter.deny(kClone3, ENOSYS);  // the filter cannot see its flags; the C library then calls clone
    filter.allow_where(SYS_clone, 0, BPF_JSET, CLONE_THREAD);
  }
  filter.enforce();
}

}  // namespace

void give_up_rights(const Reach& reach) noexcept {
  const struct rlimit none {};
  (void)::setrlimit(RLIMIT_CORE, &none);
  if (::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) return;
  restrict_files(reach);
  try {
    restrict_calls();
  } catch (const std::bad_alloc&) {
    // access to files is restricted nevertheless
  }
}

WriteProtection::WriteProtection(const std::vector<fs::path>& originals, const fs::path& allowed)
    : rules_(std::make_unique<const Ruleset>(kChange)) {
  if (!rules_->is_possible()) return;
  std::vector<fs::path> denied;
  denied.reserve(originals.size());
  for (const fs::path& original : originals) denied.push_back(fs::canonical(original));
  if (std::ranges::find(denied, "/") == denied.end()) {
    allow_changes(*rules_, "/", denied);
  } else {
    rules_->allow("/dev", kChange);
  }
  rules_->allow(allowed, kChange);
}

bool WriteProtection::is_possible() const noexcept { return rules_->is_possible(); }

bool WriteProtection::enforce() const noexcept {
  return ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 && rules_->enforce();
}
#else
class Ruleset {};

void give_up_rights(const Reach& /*reach*/) noexcept {
  const struct rlimit none {};
  (void)::setrlimit(RLIMIT_CORE, &none);
}

WriteProtection::WriteProtection(const std::vector<std::filesystem::path>& /*originals*/,
                                 const std::filesystem::path& /*allowed*/) {}
bool WriteProtection::is_possible() const noexcept { return false; }
bool WriteProtection::enforce() const noexcept { return false; }
#endif

WriteProtection::~WriteProtection() = default;

}  // namespace meshorder::command
