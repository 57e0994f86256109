// Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
#include "io/stream/output_file.hpp"

#include "io/stream/descriptor.hpp"
#include "io/stream/folder_locks.hpp"
#include "io/stream/output_set.hpp"
#include "io/stream/scratch.hpp"
#include "io/stream/text_rows.hpp"
#include "support/files.hpp"
#include <meshorder/error.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <bit>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <thread>
#include <vector>

namespace {

// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): `flock` has no other input
int interruptions = 0;  // calls of `flock` that a signal will interrupt

}  // namespace

/// Takes the place of the system's function in this program.
extern "C" int flock(int descriptor, int operation) noexcept {
  if (interruptions == 0) return static_cast<int>(::syscall(SYS_flock, descriptor, operation));
  --interruptions;
  errno = EINTR;
  return -1;
}

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

void put(const fs::path& path, std::string_view content) { std::ofstream(path) << content; }

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

TEST(FolderLocks, LeaveOutFoldersThatThisProcessHolds) {
  const TemporaryFolder folder;
  const auto can_be_locked = [&] {
    const int opened = ::open(folder.path().c_str(), O_RDONLY | O_DIRECTORY);
    const bool result = ::flock(opened, LOCK_EX | LOCK_NB) == 0;
    ::close(opened);
    return result;
  };
  {
    const FolderLocks locks({folder.path()});
    EXPECT_FALSE(can_be_locked());
  }
  const int opened = ::open(folder.path().c_str(), O_RDONLY | O_DIRECTORY);
  {
    const HeldFolder held(opened);
    const FolderLocks locks({folder.path()});
    EXPECT_TRUE(can_be_locked());
  }
  const FolderLocks locks({folder.path()});
  EXPECT_FALSE(can_be_locked());
  ::close(opened);
}

TEST(FolderLocks, AndScratchFoldersHoldAQuarterOfAllDescriptors) {
  struct rlimit before {};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &before), 0);
  struct rlimit low = before;
  low.rlim_cur = 128;
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &low), 0);
  const auto open_files = [] { return std::distance(fs::directory_iterator("/proc/self/fd"), {}); };
  const auto first = open_files();
  {
    std::vector<TemporaryFolder> folders(40);
    std::vector<Scratch> scratches;
    std::set<fs::path> paths;
    for (const TemporaryFolder& folder : folders) {
      scratches.emplace_back(folder.path() / "a.txt");
      paths.insert(folder.path());
    }
    const FolderLocks locks(paths);
    EXPECT_EQ(open_files() - first, 32);
  }
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &before), 0);
}

TEST(Descriptor, LocksItsFileAlthoughSignalsInterrupt) {
  const TemporaryFolder folder;
  interruptions = 2;
  const Scratch scratch(folder.path() / "a.txt");
  EXPECT_EQ(interruptions, 0);
  EXPECT_EQ(Descriptor(scratch.file("lock"), O_RDWR).try_lock(), EWOULDBLOCK);
}

TEST(TextRows, AreWrittenInTheirOrder) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "rows.txt";
  for (const Index count : {0, 1, 4095, 4096, 4097, 64 * 4096, 64 * 4096 + 1, 200'000, 600'000}) {
    std::string expected = "head\n";
    for (Index i = 0; i < count; ++i) expected += std::to_string(i) + (i % 3 == 0 ? " x\n" : "\n");
    OutputFile file(path);
    file.write("head\n");
    write_rows(file, count, [](Text& row, Index i) {
      row.integer("", i);
      row.write(i % 3 == 0 ? " x\n" : "\n");
    });
    file.write("tail\n");
    file.commit();
    EXPECT_TRUE(content_of(path) == expected + "tail\n") << count;
  }
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

TEST(OutputFile, FollowsNoLinksInNamesThatItDerives) {
  const TemporaryFolder folder;
  const fs::path precious = folder.file("precious", "old");
  fs::create_directories(folder.path() / "case/constant");
  fs::create_directories(folder.path() / "elsewhere");
  const fs::path link = folder.path() / "mesh.ele";
  fs::create_symlink("precious", link);
  fs::create_symlink("../elsewhere", folder.path() / "case/system");
  const std::string fault =
      "is a symbolic link, and links are followed only in names that you give; remove it";
  EXPECT_THAT(write_fault(FilePath(folder.path() / "mesh.node").companion(".ele")), HasSubstr(fault));
  EXPECT_THAT(write_fault(FilePath(folder.path() / "mesh.xdmf").beside("mesh.ele")), HasSubstr(fault));
  EXPECT_THAT(write_fault(FilePath::derived(link)), HasSubstr("mesh.ele: " + fault));
  EXPECT_THAT(write_fault(FilePath::in(folder.path() / "case", folder.path() / "case/system/dict")),
              HasSubstr("case/system: " + fault));
  EXPECT_EQ(content_of(precious), "old");
  EXPECT_TRUE(fs::is_empty(folder.path() / "elsewhere"));
  write(FilePath::in(folder.path() / "case", folder.path() / "case/constant/order"), "new");
  EXPECT_EQ(content_of(folder.path() / "case/constant/order"), "new");
  // links that the user names are followed, also for names derived below them
  fs::create_symlink("case", folder.path() / "my case");
  write(FilePath::in(folder.path() / "my case/", folder.path() / "my case/constant/order"), "newer");
  EXPECT_EQ(content_of(folder.path() / "case/constant/order"), "newer");
  write(link, "newest");
  EXPECT_EQ(content_of(precious), "newest");
}

TEST(OutputFile, WritesThroughNoPipeThatItDerives) {
  const TemporaryFolder folder;
  const fs::path pipe = folder.path() / "mesh.ele";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THAT(write_fault(FilePath::derived(pipe)),
              HasSubstr("mesh.ele: is not an ordinary file; remove it"));
  EXPECT_TRUE(fs::is_fifo(pipe));
}

TEST(OutputFile, RemovesWhatDeadProcessesLeftAndNothingElse) {
  const TemporaryFolder folder;
  const fs::path dead = folder.path() / ".meshorder-0123456789abcdef.new";
  const fs::path inner = dead / ".meshorder-fedcba9876543210.new";  // of a process that wrote into `dead`
  fs::create_directories(inner);
  for (const fs::path& left : {dead, inner}) {
    for (const char* const name : {"lock", "new", "old"}) put(left / name, "half");
  }
  const fs::path other = folder.path() / ".meshorder-notes-of-mine0.new";
  fs::create_directory(other);
  const Scratch alive(folder.path() / "b.txt");
  write(folder.path() / "a.txt", "new");
  EXPECT_FALSE(fs::exists(dead));
  EXPECT_TRUE(fs::exists(other));
  EXPECT_TRUE(fs::exists(alive.path()));
}

TEST(OutputFile, RemovesNothingOfOthersWhereTheirNamesAreItsOwn) {
  const TemporaryFolder folder;
  const auto scratch = [&](char digit) {
    return folder.path() / (".meshorder-" + std::string(16, digit) + ".new");
  };
  fs::create_directories(folder.path() / "precious/new");
  for (const char* const name : {"lock", "old", "thesis.tex"}) put(folder.path() / "precious" / name, "mine");
  fs::create_symlink("precious", scratch('1'));  // a folder with a file called lock
  fs::create_directory(scratch('2'));            // other files in a folder of that name
  put(scratch('2') / "lock", "");
  put(scratch('2') / "thesis.tex", "mine");
  fs::create_directory(scratch('3'));  // links in it, and a pipe that nobody reads
  fs::create_symlink("../precious/thesis.tex", scratch('3') / "new");
  fs::create_symlink("../precious", scratch('3') / "old");
  ASSERT_EQ(::mkfifo((scratch('3') / "lock").c_str(), 0600), 0);
  put(scratch('4'), "a file");
  fs::create_directories(scratch('5') / "new");  // a folder where a file is expected
  put(scratch('5') / "lock", "");
  write(folder.path() / "a.txt", "new");
  for (const char* const name : {"lock", "old", "thesis.tex"})
    EXPECT_EQ(content_of(folder.path() / "precious" / name), "mine");
  EXPECT_TRUE(fs::is_directory(folder.path() / "precious/new"));
  EXPECT_EQ(content_of(scratch('2') / "thesis.tex"), "mine");
  EXPECT_EQ(content_of(scratch('4')), "a file");
  EXPECT_TRUE(fs::is_directory(scratch('5') / "new"));
}

TEST(OutputFile, ReadingLeavesWhatIsUnfinished) {
  const TemporaryFolder folder;
  const fs::path dead = folder.path() / ".meshorder-0123456789abcdef.new";
  fs::create_directory(dead);
  put(dead / "lock", "");
  EXPECT_EQ(FilePath(folder.file("a.txt", "content")).read(), "content");
  EXPECT_TRUE(fs::exists(dead / "lock"));
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
  fs::create_directory(folder.path() / "c.txt");  // a folder in place of the file
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

TEST(OutputSet, TakesTheFileThatNamesTheOthersAwayFirst) {
  const TemporaryFolder folder;
  const fs::path index = folder.file("index", "old");
  const fs::path piece = folder.file("piece", "old");
  OutputSet files;
  files.remove_first(FilePath::derived(index));
  write({piece, files}, "new");
  write({index, files}, "new");
  files.commit();
  EXPECT_EQ(content_of(index), "new");
  EXPECT_EQ(content_of(piece), "new");
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"index", "piece"}));
}

TEST(OutputSet, PutsTheOldFilesBackIfARenameFails) {
  const TemporaryFolder folder;
  const fs::path index = folder.file("index", "old");
  const fs::path piece = folder.file("piece", "old");
  const fs::path last = folder.file("last", "old");
  const Scratch of_piece(piece);
  const Scratch of_new(piece);
  const Scratch of_last(last);
  put(of_piece.file(), "new");
  put(of_new.file(), "new");
  fs::create_directory(of_last.file());  // replaces no file
  const std::vector<FinishedFile> files{
      {of_piece.path(), piece}, {of_new.path(), folder.path() / "new"}, {of_last.path(), last}};
  const std::vector<FilePath> first{FilePath::derived(index)};
  const std::vector<FilePath> removed{FilePath::derived(folder.file("removed", "old"))};
  EXPECT_THROW(put_in_place(files, first, removed), InputError);
  for (const char* const name : {"index", "piece", "last", "removed"})
    EXPECT_EQ(content_of(folder.path() / name), "old");
  EXPECT_FALSE(fs::exists(folder.path() / "new"));
}

TEST(OutputSet, WaitsWhileAnotherProcessRenamesThere) {
  const TemporaryFolder folder;
  Descriptor held(folder.path(), O_RDONLY | O_DIRECTORY);
  ASSERT_EQ(::flock(held.get(), LOCK_EX), 0);
  OutputSet files;
  write({folder.path() / "a.txt", files}, "new");
  std::thread committing([&] { files.commit(); });
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_FALSE(fs::exists(folder.path() / "a.txt"));
  held.close();
  committing.join();
  EXPECT_EQ(content_of(folder.path() / "a.txt"), "new");
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
