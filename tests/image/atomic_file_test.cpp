#include "src/image/atomic_file.h"

#include <atomic>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <unistd.h>

#include "src/base/error.h"
#include "tests/image/temporary_folder.h"

namespace dapple {
namespace {

TEST(AtomicFile, ReplacesAndLeavesNothingBehind) {
  const TemporaryFolder folder;
  folder.Write("a", "old and longer");
  WriteFileAtomically(folder.Path("a"), "new");
  EXPECT_EQ(folder.Read("a"), "new");
  EXPECT_EQ(folder.FileCount(), 1u);
}

TEST(AtomicFile, FollowsLinks) {
  const TemporaryFolder folder;
  folder.Write("target", "old");
  std::filesystem::create_symlink(folder.Path("target"), folder.Path("link"));
  WriteFileAtomically(folder.Path("link"), "new");
  EXPECT_TRUE(std::filesystem::is_symlink(folder.Path("link")));
  EXPECT_EQ(folder.Read("target"), "new");
}

TEST(AtomicFile, DevicesStayDevices) {
  WriteFileAtomically("/dev/null", "nothing");
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
  EXPECT_THROW(WriteFileAtomically("/dev/full", "something"), Error);
}

TEST(AtomicFile, FollowsLinksToWhatIsNotThereYet) {
  const TemporaryFolder folder;
  std::filesystem::create_symlink("second", folder.Path("first"));
  std::filesystem::create_symlink(folder.Path("target"), folder.Path("second"));
  WriteFileAtomically(folder.Path("first"), "new");
  EXPECT_TRUE(std::filesystem::is_symlink(folder.Path("first")));
  EXPECT_TRUE(std::filesystem::is_symlink(folder.Path("second")));
  EXPECT_EQ(folder.Read("target"), "new");
  std::filesystem::create_symlink("circle", folder.Path("circle"));
  EXPECT_THROW(WriteFileAtomically(folder.Path("circle"), "new"), Error);
}

// The dead hold no lock, whatever number their process had: in a container each is number one.
TEST(AtomicFile, ClearsWhatTheDeadLeftBehindAndNothingElse) {
  const TemporaryFolder folder;
  const std::string stale = fmt::format(".a.{}.0.tmp", getpid()), alive = fmt::format(".a.{}.1.tmp", getpid());
  const std::vector<std::string> others = {".a.b.7.0.tmp", ".b.7.0.tmp",   ".a.7.0",    "a.7.0.tmp",
                                           ".a.x.0.tmp",   ".a..tmpx",     ".a.tmp",    ".a.5.tmp",
                                           ".a..tmp",      ".a.1.2.3.tmp", ".a.1..tmp", ".a..1.tmp"};
  folder.Write("a", "old");
  std::filesystem::create_symlink(folder.Path("a"), folder.Path("link"));
  for (const std::string& name : others) folder.Write(name, "");
  folder.Write(alive, "half");
  const int writer = open(folder.Path(alive).c_str(), O_WRONLY | O_CLOEXEC);
  ASSERT_EQ(flock(writer, LOCK_EX), 0);
  for (const std::string target : {"a", "link"}) {
    folder.Write(stale, "half");
    CheckWritable(folder.Path(target));
    EXPECT_FALSE(std::filesystem::exists(folder.Path(stale))) << target;
    folder.Write(stale, "half");
    WriteFileAtomically(folder.Path(target), "new");
    EXPECT_FALSE(std::filesystem::exists(folder.Path(stale))) << target;
  }
  EXPECT_EQ(folder.Read(alive), "half");
  close(writer);
  WriteFileAtomically(folder.Path("a"), "newer");
  EXPECT_FALSE(std::filesystem::exists(folder.Path(alive)));
  for (const std::string& name : others) EXPECT_TRUE(std::filesystem::exists(folder.Path(name))) << name;
}

// None takes what another is writing for stale, or is left without its own.
TEST(AtomicFile, ManyMayWriteOneFileAtATime) {
  const TemporaryFolder folder;
  constexpr int kWriters = 4, kTimes = 200;
  std::vector<std::thread> writers;
  std::atomic<int> failures = 0;
  for (int writer = 0; writer < kWriters; ++writer) {
    writers.emplace_back([&, writer] {
      for (int i = 0; i < kTimes; ++i) {
        try {
          WriteFileAtomically(folder.Path("a"), std::string(1000, static_cast<char>('a' + writer)));
        } catch (const Error&) {
          ++failures;
        }
      }
    });
  }
  for (std::thread& writer : writers) writer.join();
  EXPECT_EQ(failures, 0);
  EXPECT_EQ(folder.FileCount(), 1u);
  const std::string content = folder.Read("a");
  EXPECT_EQ(content.size(), 1000u);
  EXPECT_EQ(content.find_first_not_of(content[0]), std::string::npos);
}

TEST(AtomicFile, FailureLeavesTheOldFileAndNoTemporary) {
  const TemporaryFolder folder;
  EXPECT_THROW(WriteFileAtomically(folder.Path("absent/a"), "x"), Error);
  std::filesystem::create_directory(folder.Path("folder"));
  EXPECT_THROW(WriteFileAtomically(folder.Path("folder"), "x"), Error);
  EXPECT_EQ(folder.FileCount(), 1u);
}

}  // namespace
}  // namespace dapple
