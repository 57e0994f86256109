// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "confinement.hpp"

#include "command.hpp"
#include "io/format.hpp"
#include "io/stream/output_place.hpp"
#include "io/stream/read_limits.hpp"
#include "io/stream/scratch.hpp"
#include "output_deputy.hpp"
#include "payoff/calibration_store.hpp"
#include "restrictions.hpp"
#include "standard_streams.hpp"
#include <meshorder/error.hpp>

#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <new>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

namespace meshorder::command {
namespace {

namespace fs = std::filesystem;

constexpr rlim_t kSecondsToRead = 10;                // of processor time
constexpr std::uintmax_t kBytesASecond = 1'000'000;  // file size that allows one second more
constexpr std::uintmax_t kMostSeconds = 10'000'000;
constexpr unsigned kWaiting = 10;  // elapsed seconds for each second of processor time
constexpr std::array kPassedOn{SIGINT, SIGTERM, SIGHUP};
constexpr std::array kCrashes{SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTRAP, SIGSYS};

/// State of the child's work, in shared memory. The parent uses it only for messages, because a malicious
/// file may control the child.
struct Work {
  std::atomic<bool> is_reading{false};
  std::atomic<std::uint32_t> mesh{0};     ///< index of the mesh that is read, or was read last
  std::atomic<std::uint32_t> seconds{0};  ///< limit on the processor time to read it
};

// NOLINTBEGIN(cppcoreguidelines-avoid-non-const-global-variables): state of the process, which a signal
// handler can reach in no other way
bool are_trusted = false;
Work* work = nullptr;  // set in a confined process
std::vector<std::string> meshes;
volatile std::sig_atomic_t child = 0;
volatile std::sig_atomic_t signals_received = 0;
volatile std::sig_atomic_t seconds_to_wait = 0;
// NOLINTEND(cppcoreguidelines-avoid-non-const-global-variables)

/// Returns the library that parses a mesh; empty if meshorder does.
std::string_view library_of(const std::string& mesh) {
  try {
    return format_of(mesh).library;
  } catch (const Error&) {
    return {};  // reading the file reports the fault
  }
}

/// Returns whether a mesh may consist of several files, all in its folder or below it.
bool has_companions(const std::string& mesh) {
  try {
    const Format& format = format_of(mesh);
    return format.library.empty() || !format.single_file;
  } catch (const Error&) {
    return false;
  }
}

// ---- files that the child can reach

/// Adds the files whose paths begin with the prefix and a dot.
void add_files_beginning(const fs::path& prefix, std::vector<fs::path>& files) {
  const std::string start = prefix.filename().string() + ".";
  std::error_code code;
  for (fs::directory_iterator entry(folder_of(prefix), code), end; !code && entry != end;
       entry.increment(code)) {
    if (entry->path().filename().string().starts_with(start)) files.push_back(entry->path());
  }
}

Reach reach_of(const Files& files) {
  Reach reach;
  reach.read.assign(files.others.begin(), files.others.end());
  for (const std::string& mesh : files.meshes) {
    reach.read.emplace_back(mesh);
    if (has_companions(mesh)) reach.read.push_back(folder_of(mesh));
  }
  if (!files.maps_read.empty()) add_files_beginning(files.maps_read, reach.read);
  for (const fs::path& folder : allowed_include_folders()) reach.read.push_back(folder);
  std::vector<fs::path> folders(files.folders.begin(), files.folders.end());
  folders.push_back(calibration_file(key_of_this_machine()).parent_path());
  for (const fs::path& folder : folders) {
    if (folder.empty()) continue;
    std::error_code ignored;  // the code that writes there reports the error
    fs::create_directories(folder, ignored);
    reach.write.push_back(folder);
  }
  return reach;
}

// ---- the child

extern "C" void wait_anew(int /*signal*/) { ::alarm(static_cast<unsigned>(seconds_to_wait)); }

/// While alive, limits the time of this process and drops what libraries print.
class Reading {
 public:
  explicit Reading(const std::string& path) {
    const auto mesh = std::find(meshes.begin(), meshes.end(), path);
    work->mesh = static_cast<std::uint32_t>(mesh - meshes.begin());
    work->is_reading = true;
    std::error_code ignored;
    const std::uintmax_t bytes = fs::file_size(path, ignored);
    const auto seconds = static_cast<std::uint32_t>(
        kSecondsToRead + (ignored ? 0 : std::min(bytes / kBytesASecond, kMostSeconds)));
    struct rusage used {};
    (void)::getrusage(RUSAGE_SELF, &used);
    (void)::getrlimit(RLIMIT_CPU, &before_);
    struct rlimit limit = before_;
    // one second below the hard limit, if there is one: at that limit, the system kills without a message
    const rlim_t hard =
        before_.rlim_max == RLIM_INFINITY || before_.rlim_max < 2 ? before_.rlim_max : before_.rlim_max - 1;
    const auto used_seconds = static_cast<rlim_t>(used.ru_utime.tv_sec + used.ru_stime.tv_sec);
    limit.rlim_cur = std::min({limit.rlim_cur, hard, seconds + used_seconds});
    work->seconds = static_cast<std::uint32_t>(std::min<rlim_t>(limit.rlim_cur, seconds));
    (void)::setrlimit(RLIMIT_CPU, &limit);
    // limits elapsed time, too, since a library may hang on a damaged heap; SIGCONT restarts the clock
    seconds_to_wait = static_cast<int>(kWaiting * work->seconds);
    (void)std::signal(SIGCONT, wait_anew);
    wait_anew(SIGCONT);
    silence_libraries();
  }
  ~Reading() {
    hear_libraries();
    (void)std::signal(SIGCONT, SIG_DFL);
    ::alarm(0);
    (void)::setrlimit(RLIMIT_CPU, &before_);
    work->is_reading = false;
  }
  Reading(const Reading&) = delete;
  Reading(Reading&&) = delete;
  Reading& operator=(const Reading&) = delete;
  Reading& operator=(Reading&&) = delete;

 private:
  struct rlimit before_ {};
};

// ---- the waiting parent

extern "C" void pass_on(int signal, siginfo_t* info, void* /*context*/) {
  const int error = errno;
  // signals from the terminal reach the child anyway; a third signal kills a child that does not end
  constexpr int kPatience = 2;
  if (signals_received >= kPatience) {
    ::kill(static_cast<pid_t>(child), SIGKILL);
  } else if (info->si_code <= 0) {
    ::kill(static_cast<pid_t>(child), signal);
  }
  signals_received = signals_received + 1;
  errno = error;
}

void pass_signals_on() {
  for (const int signal : kPassedOn) {
    struct sigaction action {};
    if (::sigaction(signal, nullptr, &action) != 0 || action.sa_handler == SIG_IGN) continue;
    action = {};
    action.sa_sigaction = pass_on;
    action.sa_flags = SA_SIGINFO | SA_RESTART;
    ::sigemptyset(&action.sa_mask);
    ::sigaction(signal, &action, nullptr);
  }
}

[[noreturn]] void end_by(int signal) {
  std::signal(signal, SIG_DFL);
  sigset_t signals;
  ::sigemptyset(&signals);
  ::sigaddset(&signals, signal);
  ::pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
  ::raise(signal);
  std::_Exit(128 + signal);
}

/// Reports why the child did not end by itself; returns the exit status.
int report_ending(const Work& of_child, int signal) {
  const std::uint32_t number = of_child.mesh;
  const std::string& mesh = meshes[number < meshes.size() ? number : 0];
  const std::string_view library = library_of(mesh);
  const std::string reader = library.empty() ? "meshorder" : fmt::format("the library {}", library);
  std::string fault;
  if (signal == SIGALRM || signal == SIGXCPU) {
    fault = fmt::format("{} did not finish reading it within {} s of processor time", reader,
                        of_child.seconds.load());
  } else if (of_child.is_reading) {
    fault = fmt::format("{} crashed while reading it (signal {})", reader, signal);
  } else {
    fault = fmt::format("meshorder crashed (signal {}) after {} read it", signal, reader);
  }
  const InputError error(mesh, fault, "it is damaged or malicious: get it again from its source");
  return report_failure(error.what(), kBadInput);
}

/// Serves the child until it ends; removes unfinished outputs and unpacked files; reports a crash or a hang
/// of the child, or ends with the child's status.
[[noreturn]] void supervise(const Work& of_child, std::unique_ptr<OutputDeputy> deputy,
                            std::unique_ptr<PrivateFolder> unpacked) {
  deputy->serve_child();
  int status = 0;
  while (::waitpid(static_cast<pid_t>(child), &status, 0) < 0) {
    if (errno != EINTR) break;
  }
  deputy.reset();  // removes unfinished outputs
  unpacked.reset();
  if (!WIFSIGNALED(status)) std::_Exit(WEXITSTATUS(status));
  const int signal = WTERMSIG(status);
  const bool has_crashed = std::find(kCrashes.begin(), kCrashes.end(), signal) != kCrashes.end();
  const bool had_no_end = (signal == SIGXCPU || signal == SIGALRM) && of_child.is_reading;
  if (has_crashed || had_no_end) std::_Exit(report_ending(of_child, signal));
  end_by(signal);
}

}  // namespace

void trust_files() { are_trusted = true; }

void confine(const Files& files) {
  const auto is_of_library = [](const std::string& mesh) { return !library_of(mesh).empty(); };
  if (are_trusted || std::none_of(files.meshes.begin(), files.meshes.end(), is_of_library)) return;
  void* const shared =
      ::mmap(nullptr, sizeof(Work), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (shared == MAP_FAILED) return;
  Work* const of_child = new (shared) Work;
  meshes = files.meshes;

  Reach reach = reach_of(files);
  auto deputy = std::make_unique<OutputDeputy>(files.outputs, files.maps_written);
  for (fs::path& folder : deputy->folders()) reach.write.push_back(std::move(folder));
  reach.through = deputy->through();
  std::unique_ptr<PrivateFolder> unpacked;
  const auto is_compressed = [](const fs::path& mesh) { return without_gz(mesh) != mesh; };
  if (std::any_of(files.meshes.begin(), files.meshes.end(), is_compressed)) {
    unpacked = std::make_unique<PrivateFolder>();
    reach.write.push_back(unpacked->path());
  }
  (void)std::signal(SIGCHLD, SIG_DFL);
  sigset_t passed_on;
  sigset_t before;
  ::sigemptyset(&passed_on);
  for (const int signal : kPassedOn) ::sigaddset(&passed_on, signal);
  ::pthread_sigmask(SIG_BLOCK, &passed_on, &before);
  const pid_t parent = ::getpid();
  child = ::fork();
  if (child > 0) {
    pass_signals_on();
    ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
    supervise(*of_child, std::move(deputy), std::move(unpacked));
  }
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  if (child < 0) return;
#ifdef __linux__
  (void)::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) std::_Exit(1);
#endif
  // never destroyed here: the parent removes their files
  // NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): keeps these objects to the end
  static OutputDeputy* const own_deputy = deputy.release();
  static const PrivateFolder* const own_folder = unpacked.release();
  own_deputy->serve_this_process();
  if (own_folder != nullptr) (void)::setenv("TMPDIR", own_folder->path().c_str(), 1);
  give_up_rights(reach);
  work = of_child;
}

Mesh read_input(const FilePath& path, Notes& notes, std::uint64_t bytes_of_entry) {
  std::optional<Reading> reading;
  if (work != nullptr) reading.emplace(path.string());
  Mesh mesh = read_mesh_from(path, {.notes = &notes});
  limit_joins(left_by_last_reading(), bytes_of_entry);
  return mesh;
}

}  // namespace meshorder::command
