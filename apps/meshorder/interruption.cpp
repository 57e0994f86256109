// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "interruption.hpp"

#include <csignal>
#include <initializer_list>

namespace meshorder::command {
namespace {

// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): a signal handler reaches nothing else
volatile std::sig_atomic_t caught = 0;

extern "C" void set_flag(int signal) {
  caught = signal;
  std::signal(signal, SIG_DFL);
}

}  // namespace

Interruption::Interruption() {
  caught = 0;
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, set_flag);
}

Interruption::~Interruption() {
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, SIG_DFL);
}

int Interruption::signal() noexcept { return caught; }

}  // namespace meshorder::command
