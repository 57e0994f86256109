// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "trial_program.hpp"

#include "base/stopwatch.hpp"
#include "base/text.hpp"
#include "io/stream/descriptor.hpp"
#include "payoff/quantities.hpp"
#include "program_output.hpp"
#include <meshorder/error.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <fstream>
#include <string_view>
#include <system_error>

namespace meshorder::command {
namespace {

namespace fs = std::filesystem;

constexpr int kCannotExecute = 127;

bool is_executable(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored) && ::access(path.c_str(), X_OK) == 0;
}

double seconds_of(const timeval& time) {
  constexpr double kMicro = 1e-6;
  return static_cast<double>(time.tv_sec) + kMicro * static_cast<double>(time.tv_usec);
}

/// Returns the signals that end a process unless it handles them, without SIGKILL and those of its own
/// faults.
std::vector<int> ending_signals() {
  std::vector<int> signals{SIGINT,  SIGTERM, SIGHUP,    SIGQUIT, SIGUSR1, SIGUSR2,
                           SIGPIPE, SIGALRM, SIGVTALRM, SIGPROF, SIGXCPU, SIGXFSZ};
#ifdef __linux__
  signals.insert(signals.end(), {SIGIO, SIGPWR});
  for (int signal = SIGRTMIN; signal <= SIGRTMAX; ++signal) signals.push_back(signal);
#endif
  return signals;
}

sigset_t awaited_signals() {
  sigset_t signals;
  ::sigemptyset(&signals);
  ::sigaddset(&signals, SIGCHLD);
  for (const int signal : ending_signals()) {
    struct sigaction now {};  // ignored signals, as under nohup, do not end a trial
    if (::sigaction(signal, nullptr, &now) != 0 || now.sa_handler != SIG_IGN) ::sigaddset(&signals, signal);
  }
  return signals;
}

/// Waits at most a tenth of a second for one of the blocked signals; returns it, or 0 if none came.
int wait_for_signal(const sigset_t& signals) {
#ifdef __linux__
  constexpr timespec kLongest{.tv_sec = 0, .tv_nsec = 100'000'000};
  return std::max(0, ::sigtimedwait(&signals, nullptr, &kLongest));
#else
  constexpr timespec kStep{.tv_sec = 0, .tv_nsec = 1'000'000};
  (void)::nanosleep(&kStep, nullptr);
  sigset_t pending;
  ::sigpending(&pending);
  for (const int signal : ending_signals()) {
    if (::sigismember(&signals, signal) == 1 && ::sigismember(&pending, signal) == 1) return signal;
  }
  return 0;
#endif
}

// ---- the child

/// Sends the errno of the failed start to the parent, and ends the child.
[[noreturn]] void give_up(int report) {
  const int error = errno;
  (void)!::write(report, &error, sizeof error);
  ::_exit(kCannotExecute);
}

void open_as(const char* path, int flags, int descriptor, int report) {
  constexpr mode_t kOwn = 0600;
  const int opened = ::open(path, flags, kOwn);
  if (opened < 0 || ::dup2(opened, descriptor) < 0) give_up(report);
  if (opened != descriptor) ::close(opened);
}

/// Data of the child, made before the fork: afterwards, the child may call only async-signal-safe functions.
struct Prepared {
  explicit Prepared(const TrialCommand& command)
      : folder(command.folder.string()),
        out(command.log.string() + ".out"),
        err(command.log.string() + ".err"),
        directory("PWD=" + folder),
        temporary("TMPDIR=" + command.temporary.string()),
        protection(command.protection) {
    for (const std::string& word : command.words) words.push_back(word.c_str());
    words.push_back(nullptr);
    const bool has_temporary = !command.temporary.empty();
    for (char** entry = environ; *entry != nullptr; ++entry) {
      const std::string_view variable = *entry;
      if (variable.starts_with("PWD=") || variable.starts_with("OLDPWD=")) continue;
      if (!has_temporary || !variable.starts_with("TMPDIR=")) environment.push_back(*entry);
    }
    environment.push_back(directory.c_str());
    if (has_temporary) environment.push_back(temporary.c_str());
    environment.push_back(nullptr);
  }
  std::string folder;
  std::string out;
  std::string err;
  std::string directory;
  std::string temporary;
  const WriteProtection* protection;
  std::vector<const char*> words;
  std::vector<const char*> environment;
};

/// Puts this child into a process group of its own, and lets it end with its parent.
void begin_child(pid_t parent) {
  (void)::setpgid(0, 0);
#ifdef __linux__
  (void)::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(kCannotExecute);
#else
  (void)parent;
#endif
}

[[noreturn]] void become(const Prepared& prepared, const sigset_t& signals_before, int report) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGCHLD, SIGXFSZ})
    (void)std::signal(signal, SIG_DFL);
  if (::chdir(prepared.folder.c_str()) != 0) give_up(report);
  open_as("/dev/null", O_RDONLY, STDIN_FILENO, report);
  constexpr int kAnew = O_WRONLY | O_CREAT | O_TRUNC;
  open_as(prepared.out.c_str(), kAnew, STDOUT_FILENO, report);
  open_as(prepared.err.c_str(), kAnew, STDERR_FILENO, report);
  if (prepared.protection != nullptr && !prepared.protection->enforce()) give_up(report);
  ::sigprocmask(SIG_SETMASK, &signals_before, nullptr);
  // NOLINTBEGIN(cppcoreguidelines-pro-type-const-cast): execve changes neither
  ::execve(prepared.words.front(), const_cast<char* const*>(prepared.words.data()),
           const_cast<char* const*>(prepared.environment.data()));
  // NOLINTEND(cppcoreguidelines-pro-type-const-cast)
  give_up(report);
}

// ---- the process that waits

/// Returns the children of this process that have not been waited for; empty if the system cannot list them.
std::vector<pid_t> children() {
  std::vector<pid_t> result;
#ifdef __linux__
  const fs::path name = "children";
  std::error_code code;
  for (fs::directory_iterator task("/proc/self/task", code), end; !code && task != end;
       task.increment(code)) {
    std::ifstream list(task->path() / name);
    for (pid_t child = 0; list >> child;) result.push_back(child);
  }
#endif
  return result;
}

/// The processes of a run.
class Processes {
 public:
  explicit Processes(pid_t program) : program_(program) {}

  /// Reaps the processes that have ended and adds their usage; returns whether the program is among them.
  bool reap(TrialRun& run) const {
    bool has_ended = false;
    int status = 0;
    struct rusage usage {};
    for (pid_t ended = 0; (ended = ::wait4(-1, &status, WNOHANG, &usage)) > 0;) {
      add(usage, run);
      if (ended != program_) continue;
      has_ended = true;
      run.exit_status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
      run.signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    }
    return has_ended;
  }

  /// Kills the program, which may have left its process group, and what is in this group.
  void kill_program() const {
    ::kill(-program_, SIGKILL);
    ::kill(program_, SIGKILL);
  }

  /// Kills the processes that the program left running, also outside its process group, and counts them.
  void end_others(TrialRun& run) const {
    const pid_t group = program_;
    (void)::kill(-group, SIGKILL);
    int status = 0;
    struct rusage usage {};
    for (std::vector<pid_t> left = children(); !left.empty(); left = children()) {
      for (const pid_t child : left) (void)::kill(child, SIGKILL);
      for (const pid_t child : left) {
        if (::wait4(child, &status, 0, &usage) != child) continue;
        add(usage, run);
        ++run.left_behind;
      }
    }
  }

 private:
  static void add(const struct rusage& usage, TrialRun& run) {
    run.processor_seconds += seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime);
#ifdef __APPLE__
    constexpr std::int64_t kUnit = 1;
#else
    constexpr std::int64_t kUnit = 1024;
#endif
    const long peak = usage.ru_maxrss;  // NOLINT(cppcoreguidelines-pro-type-union-access): as glibc has it
    run.peak_bytes = std::max(run.peak_bytes, kUnit * std::int64_t{peak});
  }

  pid_t program_;
};

/// Waits until the program ends; kills it at a signal or the timeout. Returns the signal, or 0.
int await(const Processes& processes, double timeout_seconds, TrialRun& run) {
  const Stopwatch stopwatch;
  const sigset_t awaited = awaited_signals();
  int interruption = 0;
  while (!processes.reap(run)) {
    const int signal = wait_for_signal(awaited);
    if (signal != 0 && signal != SIGCHLD) interruption = signal;
    if (timeout_seconds > 0 && stopwatch.seconds() > timeout_seconds) run.timed_out = true;
    if (interruption != 0 || run.timed_out) processes.kill_program();
  }
  run.wall_seconds = stopwatch.seconds();
  return interruption;
}

/// Starts a child, which calls `work`; returns its number. Throws Unavailable.
template <class Work>
pid_t start_child(Work work) {
  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  if (child == 0) {
    begin_child(parent);
    work();
    ::_exit(0);
  }
  if (child < 0) {
    throw Unavailable(
        fmt::format("no process can be started: {}; end other programs, or raise the limit on "
                    "processes (ulimit -u)",
                    std::strerror(errno)));
  }
  (void)::setpgid(child, child);
  return child;
}

/// Waits for a child and ends its descendants. If a signal came, leaves it pending and throws Interrupted.
TrialRun finish(pid_t child, double timeout_seconds) {
  TrialRun run;
  const Processes processes(child);
  const int interruption = await(processes, timeout_seconds, run);
  processes.end_others(run);
  if (interruption == 0) return run;
  ::raise(interruption);  // the signal is blocked, so it stays pending
  throw Interrupted();
}

}  // namespace

TrialSignals::TrialSignals() {
  (void)std::signal(SIGCHLD, SIG_DFL);
  const sigset_t signals = awaited_signals();
  ::pthread_sigmask(SIG_BLOCK, &signals, &before_);
#ifdef __linux__
  (void)::prctl(PR_SET_CHILD_SUBREAPER, 1);
#endif
}

TrialSignals::~TrialSignals() { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

std::string find_program(const std::string& name) {
  if (name.find('/') != std::string::npos) {
    if (is_executable(name)) return fs::absolute(name).lexically_normal().string();
    throw InvalidArgument(fmt::format("{}: there is no executable program of this name", name));
  }
  const char* const path = std::getenv("PATH");
  std::string_view folders = path == nullptr ? "/usr/bin:/bin" : path;
  while (!name.empty() && !folders.empty()) {
    const std::string_view folder = folders.substr(0, folders.find(':'));
    folders.remove_prefix(std::min(folder.size() + 1, folders.size()));
    const fs::path candidate = fs::path(folder) / name;
    if (!folder.empty() && is_executable(candidate))
      return fs::absolute(candidate).lexically_normal().string();
  }
  throw InvalidArgument(fmt::format(
      "{}: no folder of PATH has this program; write ./{} for a program in this folder", name, name));
}

TrialRun run_program(const TrialCommand& command) {
  const Prepared prepared(command);
  std::array<int, 2> ends{};
  if (::pipe(ends.data()) != 0)
    throw Unavailable(fmt::format("no pipe can be made: {}", std::strerror(errno)));
  const Descriptor report(ends[0]);
  Descriptor to_report(ends[1]);
  for (const int end : ends) (void)::fcntl(end, F_SETFD, FD_CLOEXEC);
  sigset_t signals_before;
  ::pthread_sigmask(SIG_SETMASK, nullptr, &signals_before);
  for (const int signal : ending_signals()) ::sigdelset(&signals_before, signal);
  ::sigdelset(&signals_before, SIGCHLD);
  const pid_t child = start_child([&] { become(prepared, signals_before, to_report.get()); });
  to_report.close();
  TrialRun run = finish(child, command.timeout_seconds);
  int error = 0;
  if (::read(report.get(), &error, sizeof error) == sizeof error)
    throw InvalidArgument(
        fmt::format("{}: it cannot be executed: {}", command.words.front(), std::strerror(error)));
  return run;
}

TrialRun run_in_child(const std::function<void()>& work, double timeout_seconds) {
  const pid_t child = start_child([&] {
    try {
      work();
    } catch (...) {
      ::_exit(kCannotExecute);
    }
  });
  return finish(child, timeout_seconds);
}

std::string failure_of(const TrialRun& run, const TrialCommand& command) {
  if (run.timed_out)
    return fmt::format("did not end within {} (--timeout)", duration(command.timeout_seconds));
  std::string line = error_line(command.log);
  for (const std::string& file : {command.log.string() + ".err", command.log.string() + ".out"}) {
    if (line.empty()) line = last_line(file);
  }
  const std::string how = run.signal != 0 ? fmt::format("ended by signal {}", run.signal)
                                          : fmt::format("exit status {}", run.exit_status);
  return line.empty() ? how : how + ": " + line;
}

}  // namespace meshorder::command
