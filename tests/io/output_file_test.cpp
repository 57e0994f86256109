// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/stream/output_file.hpp"

#include "io/stream/output_journal.hpp"
#include "io/stream/output_place.hpp"
#include "io/stream/output_set.hpp"
#include "io/stream/system_fault.hpp"
#include "support/files.hpp"
#include <meshorder/error.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <bit>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <string>
#include <thread>

namespace meshorder {
namespace {

namespace fs = std::filesystem;
using test::content_of;
using test::TemporaryFolder;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

void write(const FilePath& path, std::string_view content) {
  OutputFile file(path);
  file.write(content);
  file.commit();
}

std::string write_fault(const FilePath& path) {
  try {
    write(path, "new");
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

mode_t mode_of(const fs::path& path) {
  struct stat status {};
  EXPECT_EQ(::stat(path.c_str(), &status), 0);
  return status.st_mode & 07777U;
}

TEST(OutputFile, AppearsWholeOrNotAtAll) {
  const TemporaryFolder folder;
  {
    OutputFile abandoned(folder.path() / "a.txt");
    abandoned.print("{}", 1);
  }
  EXPECT_TRUE(folder.names().empty());
  OutputFile file(folder.path() / "a.txt");
  file.print("{} {}\n", 0.1, 2);
  file.commit();
  EXPECT_EQ(folder.names(), std::vector<std::string>{"a.txt"});
  EXPECT_EQ(content_of(folder.path() / "a.txt"), "0.1 2\n");
}

TEST(OutputFile, WritesNumbersAsFmtDoes) {
  const TemporaryFolder folder;
  const std::vector<double> numbers{0.0,     -0.0,    1.0,        1e15,     1e16, 1e-4, 1e-5,
                                    0.1,     1.0 / 3, 123456.789, -2.5e8,   1e22, 1e23, 5e-324,
                                    1.7e308, -1e-10,  1e-100,     INFINITY, -NAN};
  std::string expected;
  OutputFile file(folder.path() / "a.txt");
  // more than the buffer holds
  for (int k = 0; k < 10'000; ++k) {
    for (const double number : numbers) {
      file.real(" ", number / (k + 1));
      expected += fmt::format(" {}", number / (k + 1));
    }
    file.integer("\n", k);
    expected += fmt::format("\n{}", k);
  }
  file.commit();
  EXPECT_EQ(content_of(folder.path() / "a.txt"), expected);
}

TEST(OutputFile, HasRoomForRows) {
  const TemporaryFolder folder;
  OutputFile file(folder.path() / "a.bin");
  std::string expected;
  for (int k = 0; k < 100'000; ++k) {
    char* const at = file.room(30);
    file.written(put_number(put_number(at, k, std::endian::big), 0.5 * k, std::endian::little));
    for (int shift = 24; shift >= 0; shift -= 8) expected += static_cast<char>((k >> shift) & 255);
    const auto bits = std::bit_cast<std::uint64_t>(0.5 * k);
    for (int shift = 0; shift < 64; shift += 8) expected += static_cast<char>((bits >> shift) & 255U);
  }
  file.commit();
  EXPECT_EQ(content_of(folder.path() / "a.bin"), expected);
}

TEST(OutputFile, RefusesAFolderAndAMissingFolder) {
  const TemporaryFolder folder;
  EXPECT_THROW(OutputFile(folder.path()), InputError);
  EXPECT_THROW(OutputFile(folder.path() / "none" / "a.txt"), InputError);
}

TEST(OutputFile, WritesOverItsStart) {
  const TemporaryFolder folder;
  OutputFile file(folder.path() / "a.txt");
  file.write("0 frames\n1 2 3\n");
  file.write_over_start("7");
  file.write("end\n");
  file.commit();
  EXPECT_EQ(content_of(folder.path() / "a.txt"), "7 frames\n1 2 3\nend\n");
}

TEST(OutputFile, KeepsTheModeOfTheOldFile) {
  const TemporaryFolder folder;
  for (const mode_t mode : {0600U, 0640U, 0644U, 0444U, 0755U}) {
    const fs::path path = folder.file("a.txt", "old");
    ASSERT_EQ(::chmod(path.c_str(), mode), 0);
    write(path, "new");
    EXPECT_EQ(mode_of(path), mode);
    EXPECT_EQ(content_of(path), "new");
    fs::remove(path);
  }
}

TEST(OutputFile, HasTheModeOfTheUmaskWhereNoFileWas) {
  const TemporaryFolder folder;
  const mode_t before = ::umask(027);
  write(folder.path() / "a.txt", "new");
  ::umask(before);
  EXPECT_EQ(mode_of(folder.path() / "a.txt"), 0640U);
}

TEST(OutputFile, FollowsSymbolicLinks) {
  const TemporaryFolder folder;
  fs::create_directory(folder.path() / "store");
  fs::create_symlink("store/hop", folder.path() / "a.txt");
  fs::create_symlink("real", folder.path() / "store/hop");
  for (const char* const content : {"where no file was", "in place of a file"}) {
    write(folder.path() / "a.txt", content);
    EXPECT_TRUE(fs::is_symlink(folder.path() / "a.txt"));
    EXPECT_TRUE(fs::is_symlink(folder.path() / "store/hop"));
    EXPECT_EQ(content_of(folder.path() / "store/real"), content);
  }
  fs::create_symlink("b.txt", folder.path() / "b.txt");
  EXPECT_THAT(write_fault(folder.path() / "b.txt"),
              HasSubstr("b.txt: cannot be written: its symbolic links"));
}

TEST(OutputFile, LeavesHardLinksTheOldContentAndSaysSo) {
  const TemporaryFolder folder;
  const fs::path path = folder.file("a.txt", "old");
  fs::create_hard_link(path, folder.path() / "b.txt");
  OutputSet files;
  write({path, files}, "new");
  files.commit();
  EXPECT_EQ(content_of(path), "new");
  EXPECT_EQ(content_of(folder.path() / "b.txt"), "old");
  EXPECT_THAT(files.notes(), ElementsAre(HasSubstr("a.txt has 1 further name (hard links)")));
}

TEST(OutputFile, WritesThroughAPipeAtCommit) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "pipe";
  ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
  (void)OutputFile(path);  // does not open it: a reader would see its end
  std::string read;
  std::thread reader([&] { read = content_of(path); });
  OutputFile file(path);
  file.write("of ");
  EXPECT_THROW((void)file.temporary(), InputError);
  file.write("a mesh");
  file.write_over_start("OF");
  file.commit();
  reader.join();
  EXPECT_EQ(read, "OF a mesh");
  EXPECT_TRUE(fs::is_fifo(path));
  EXPECT_EQ(folder.names(), std::vector<std::string>{"pipe"});
}

TEST(OutputFile, SaysWhyADeviceCannotBeWritten) {
  EXPECT_EQ(
      write_fault("/dev/full"),
      "/dev/full: cannot be written to the end: the disk is full; free some space or choose another folder");
}

TEST(OutputFile, TakesNamesOfAnyLengthThatTheSystemTakes) {
  const TemporaryFolder folder;
  const std::string name(255, 'n');
  write(folder.path() / name, "new");
  EXPECT_EQ(folder.names(), std::vector<std::string>{name});
  EXPECT_THAT(write_fault(folder.path() / (name + "n")),
              HasSubstr("its name is too long; choose a shorter name"));
}

TEST(OutputFile, RemovesWhatDeadProcessesLeftAndNothingElse) {
  const TemporaryFolder folder;
  const fs::path dead = folder.path() / ".meshorder-0123456789abcdef.new";
  fs::create_directory(dead);
  for (const char* const name : {"lock", "new"}) (void)folder.file(dead.filename() / name, "half");
  const fs::path other = folder.path() / ".meshorder-notes.new";
  fs::create_directory(other);
  const Scratch alive(folder.path() / "b.txt");
  write(folder.path() / "a.txt", "new");
  EXPECT_FALSE(fs::exists(dead));
  EXPECT_TRUE(fs::exists(other));
  EXPECT_TRUE(fs::exists(alive.path()));
}

TEST(OutputSet, PutsAllFilesInPlaceOrNone) {
  const TemporaryFolder folder;
  const fs::path a = folder.file("a.txt", "old a");
  const fs::path c = folder.file("c.txt", "old c");
  {
    OutputSet files;
    write({a, files}, "new a");
    write({folder.path() / "b.txt", files}, "new b");
    files.remove(c);
    EXPECT_EQ(content_of(a), "old a");
  }
  EXPECT_EQ(content_of(a), "old a");
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"a.txt", "c.txt"}));
  OutputSet files;
  write({a, files}, "new a");
  write({folder.path() / "b.txt", files}, "new b");
  files.remove(c);
  files.remove(folder.path() / "none");
  files.commit();
  EXPECT_EQ(content_of(a), "new a");
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"a.txt", "b.txt"}));
}

TEST(OutputSet, PutsTheOldFilesBackIfOneCannotBeReplaced) {
  const TemporaryFolder folder;
  const fs::path a = folder.file("a.txt", "old a");
  const fs::path gone = folder.file("gone.txt", "old");
  OutputSet files;
  write({a, files}, "new a");
  files.remove(gone);
  write({folder.path() / "b.txt", files}, "new b");
  write({folder.path() / "c.txt", files}, "new c");
  fs::create_directory(folder.path() / "c.txt");  // in the way
  EXPECT_THROW(files.commit(), InputError);
  EXPECT_EQ(content_of(a), "old a");
  EXPECT_EQ(content_of(gone), "old");
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"a.txt", "c.txt", "gone.txt"}));
}

TEST(OutputSet, RefusesOneNameForTwoFiles) {
  const TemporaryFolder folder;
  fs::create_symlink("a.txt", folder.path() / "link");
  OutputSet files;
  write({folder.path() / "a.txt", files}, "1");
  write({folder.path() / "link", files}, "2");
  EXPECT_THROW(files.commit(), InputError);
  EXPECT_EQ(folder.names(), std::vector<std::string>{"link"});
}

/// Leaves what a process leaves that is stopped after it has put the first `done` of two files in place; with
/// `journal` as the name of what says so.
void leave_interrupted(const TemporaryFolder& folder, const char* journal, int done) {
  std::vector<JournalEntry> entries;
  for (const char* const name : {"a.txt", "b.txt"}) {
    const fs::path target = folder.file(name, "old");
    const fs::path scratch = scratch_in_set(target);
    fs::create_directory(scratch);
    fs::create_hard_link(target, scratch / kOldFile);
    entries.push_back({Step::replace, scratch, target});
    const auto put = [&](const char* file, const std::string& content) {
      (void)folder.file(scratch.filename() / file, content);
    };
    put("lock", "");
    put("new", "new");
    put(kSetFile, entries.front().scratch.filename());
  }
  if (journal != nullptr)
    (void)folder.file(entries.front().scratch.filename() / journal, journal_text(entries, folder.path()));
  for (int k = 0; k < done; ++k) ASSERT_EQ(apply(entries[static_cast<std::size_t>(k)]), 0);
}

TEST(OutputSet, FinishesWhatAKilledProcessLeft) {
  for (const int done : {0, 1, 2}) {
    for (const char* const first_read : {"a.txt", "b.txt"}) {
      SCOPED_TRACE(fmt::format("{} {}", done, first_read));
      const TemporaryFolder folder;
      leave_interrupted(folder, kJournal, done);
      EXPECT_EQ(FilePath(folder.path() / first_read).read(), "new");
      for (const char* const name : {"a.txt", "b.txt"}) EXPECT_EQ(content_of(folder.path() / name), "new");
      EXPECT_EQ(folder.names(), (std::vector<std::string>{"a.txt", "b.txt"}));
    }
  }
}

TEST(OutputSet, UndoesWhatAKilledProcessHadBegunToUndo) {
  for (const int done : {0, 1, 2}) {
    SCOPED_TRACE(done);
    const TemporaryFolder folder;
    leave_interrupted(folder, kUndo, done);
    write(folder.path() / "b.txt", "newest");
    EXPECT_EQ(content_of(folder.path() / "a.txt"), "old");
    EXPECT_EQ(content_of(folder.path() / "b.txt"), "newest");
    EXPECT_EQ(folder.names(), (std::vector<std::string>{"a.txt", "b.txt"}));
  }
}

TEST(OutputSet, GivesUpWhatAKilledProcessHadNotDecided) {
  const TemporaryFolder folder;
  leave_interrupted(folder, nullptr, 0);
  for (const char* const name : {"b.txt", "a.txt"}) EXPECT_EQ(FilePath(folder.path() / name).read(), "old");
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"a.txt", "b.txt"}));
}

TEST(OutputSet, RefusesFilesThatAnotherProcessPutsInPlace) {
  const TemporaryFolder folder;
  leave_interrupted(folder, kJournal, 1);
  const DeadScratch held(scratch_in_set(folder.path() / "a.txt"));
  ASSERT_EQ(held.state(), DeadScratch::State::dead);
  try {
    (void)FilePath(folder.path() / "b.txt").read();
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("is being replaced by another process; try again"));
  }
}

TEST(SystemFault, HasWordsForFullAndBrokenDisks) {
  for (const int error :
       {ENOSPC, EDQUOT, EFBIG, EIO, EROFS, EACCES, ENAMETOOLONG, EMFILE, ELOOP, EPIPE, ENODEV}) {
    const SystemFault fault = system_fault(error);
    EXPECT_THAT(fault.reason, testing::Not(IsEmpty()));
    EXPECT_THAT(fault.remedy, testing::Not(IsEmpty()));
  }
  EXPECT_EQ(system_fault(EDQUOT).reason, "the quota of the disk is used up");
  EXPECT_EQ(system_fault(ENODEV).reason, "No such device");
}

}  // namespace
}  // namespace meshorder
