// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "interruption.hpp"

#include "io/stream/scratch.hpp"
#include "standard_streams.hpp"

#include <unistd.h>

#include <array>
#include <csignal>
#include <cstddef>
#include <string_view>

namespace meshorder::command {
namespace {

struct Ending {
  int signal;
  std::string_view line;
};

constexpr std::array kEndings{
    Ending{SIGINT, "meshorder: stopped by SIGINT; unfinished outputs are removed\n"},
    Ending{SIGTERM, "meshorder: stopped by SIGTERM; unfinished outputs are removed\n"},
    Ending{SIGHUP, "meshorder: stopped by SIGHUP; unfinished outputs are removed\n"},
    Ending{SIGXFSZ,
           "meshorder: stopped by SIGXFSZ: a file would exceed the limit on its size; raise this limit "
           "(ulimit -f)\n"},
    Ending{SIGPIPE, ""},
};

constexpr std::array kNoted{SIGINT, SIGTERM};

// NOLINTBEGIN(cppcoreguidelines-avoid-non-const-global-variables): a signal handler can reach nothing else
volatile std::sig_atomic_t caught = 0;
std::array<struct sigaction, kNoted.size()> actions_before{};
// NOLINTEND(cppcoreguidelines-avoid-non-const-global-variables)

extern "C" void clean_up(int signal) {
  remove_unfinished_outputs();
  for (const Ending& ending : kEndings) {
    if (ending.signal == signal && !ending.line.empty())
      (void)!::write(messages_descriptor(), ending.line.data(), ending.line.size());
  }
  // SA_RESETHAND was set: this ends the process as if the signal had not been caught
  ::raise(signal);
}

extern "C" void clean_up_quietly(int signal) {
  remove_unfinished_outputs();
  ::raise(signal);  // ends the process, as in clean_up
}

extern "C" void set_flag(int signal) {
  caught = signal;
  for (std::size_t k = 0; k < kNoted.size(); ++k) {
    if (kNoted[k] == signal) ::sigaction(signal, &actions_before[k], nullptr);
  }
}

struct sigaction action_of(void (*handler)(int), int flags) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = flags;
  ::sigemptyset(&action.sa_mask);
  return action;
}

void handle_endings(void (*handler)(int)) {
  for (const Ending& ending : kEndings) {
    struct sigaction now {};
    if (::sigaction(ending.signal, nullptr, &now) != 0 || now.sa_handler == SIG_IGN) continue;
    const struct sigaction action = action_of(handler, static_cast<int>(SA_RESETHAND));
    ::sigaction(ending.signal, &action, nullptr);
  }
}

}  // namespace

void clean_up_at_signals() { handle_endings(clean_up); }

void clean_up_quietly_at_signals() {
  std::signal(SIGXFSZ, SIG_IGN);  // the write then fails, and the other processes learn of it
  handle_endings(clean_up_quietly);
}

Interruption::Interruption() {
  caught = 0;
  const struct sigaction action = action_of(set_flag, SA_RESTART);
  for (std::size_t k = 0; k < kNoted.size(); ++k) ::sigaction(kNoted[k], &action, &actions_before[k]);
}

Interruption::~Interruption() {
  for (std::size_t k = 0; k < kNoted.size(); ++k) ::sigaction(kNoted[k], &actions_before[k], nullptr);
}

int Interruption::signal() noexcept { return caught; }

}  // namespace meshorder::command
