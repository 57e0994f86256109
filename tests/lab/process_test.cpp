// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "lab/support/process.hpp"

#include <meshorder/error.hpp>

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/personality.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdlib>
#include <string>

namespace meshorder {
namespace {

TEST(ChildProcess, AnswersLineByLine) {
  ChildProcess cat("/bin/cat", {});
  cat.send("first");
  EXPECT_EQ(cat.receive(), "first");
  const std::string long_line(1 << 18, 'x');
  cat.send(long_line.substr(0, 1 << 15));
  cat.send("");
  EXPECT_EQ(cat.receive().size(), std::size_t{1} << 15);
  EXPECT_EQ(cat.receive(), "");
}

TEST(ChildProcess, ReportsHowItEnded) {
  const auto complaint = [](const std::string& script) {
    ChildProcess shell("/bin/sh", {"-c", script});
    try {
      return shell.receive();
    } catch (const InputError& error) {
      return std::string(error.what());
    }
  };
  EXPECT_EQ(complaint("exit 3"), "/bin/sh: a child process ended with status 3; is there enough memory?");
  EXPECT_EQ(complaint("kill -9 $$"),
            "/bin/sh: a child process was ended by a signal: Killed; is there enough memory?");
  EXPECT_EQ(complaint("echo done; exit 1"), "done");
}

TEST(ChildProcess, RefusesAProgramThatIsNotThere) {
  ChildProcess none("/no/such/program", {});
  EXPECT_THROW(none.receive(), InputError);
}

TEST(ChildProcess, IsNotReachedByCtrlC) {
  ChildProcess shell("/bin/sh", {"-c", "kill -INT $$; echo alive"});
  EXPECT_EQ(shell.receive(), "alive");
}

TEST(ChildProcess, AnswersWhereStandardStreamsAreClosed) {
  const auto ask = [] {
    ::close(STDIN_FILENO);
    ::close(STDOUT_FILENO);
    ChildProcess cat("/bin/cat", {});
    cat.send("first");
    std::exit(cat.receive() == "first" ? 0 : 1);
  };
  EXPECT_EXIT(ask(), testing::ExitedWithCode(0), "");
}

TEST(ChildProcess, EndsWithItsOwner) {
  std::string id;
  {
    ChildProcess shell("/bin/sh", {"-c", "echo $$; exec sleep 1000"});
    id = shell.receive();
  }
  EXPECT_NE(::kill(std::stoi(id), 0), 0);
}

TEST(ChildProcess, EndsWhereItsOwnerIsKilled) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe(ends.data()), 0);
  const pid_t owner = ::fork();
  if (owner == 0) {
    ChildProcess shell("/bin/sh", {"-c", "echo alive; exec sleep 1000"});
    shell.receive();
    ::kill(::getpid(), SIGKILL);
  }
  ::close(ends[1]);
  ASSERT_EQ(::waitpid(owner, nullptr, 0), owner);
  // the child holds the pipe's other end while it is alive
  pollfd ended{.fd = ends[0], .events = POLLIN, .revents = 0};
  EXPECT_EQ(::poll(&ended, 1, 60'000), 1);
  ::close(ends[0]);
}

/// Whether address randomization can be turned off, which containers may forbid.
bool addresses_can_be_fixed() {
  const int before = ::personality(0xffffffff);
  const bool allowed = before != -1 && ::personality(static_cast<unsigned>(before) | ADDR_NO_RANDOMIZE) != -1;
  if (allowed) ::personality(static_cast<unsigned>(before));
  return allowed;
}

TEST(ChildProcess, HasItsMemoryAtTheSameAddressesWhereAskedFor) {
  if (!addresses_can_be_fixed()) GTEST_SKIP() << "the system does not allow it";
  const auto stack = [] {
    ChildProcess shell("/bin/sh", {"-c", "grep stack /proc/self/maps"}, true);
    return shell.receive();
  };
  EXPECT_EQ(stack(), stack());
}

}  // namespace
}  // namespace meshorder
