#include "src/image/atomic_file.h"

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "src/base/error.h"
#include "tests/image/temporary_folder.h"

namespace dapple {
namespace {

// A process that is dead, and whose number nobody has again so soon.
pid_t DeadProcess() {
  const pid_t child = fork();
  if (child == 0) _exit(0);
  waitpid(child, nullptr, 0);
  return child;
}

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

TEST(AtomicFile, ClearsWhatTheDeadLeftBehindAndNothingElse) {
  const TemporaryFolder folder;
  const std::string dead = std::to_string(DeadProcess()), living = std::to_string(getppid());
  const std::string stale = ".a." + dead + ".0.tmp";
  const std::vector<std::string> others = {".a." + living + ".0.tmp", ".a.b." + dead + ".0.tmp",
                                           ".b." + dead + ".0.tmp",   ".a." + dead + ".0",
                                           "a." + dead + ".0.tmp",    ".a.x.0.tmp"};
  folder.Write("a", "old");
  std::filesystem::create_symlink(folder.Path("a"), folder.Path("link"));
  for (const std::string& name : others) folder.Write(name, "");
  for (const std::string target : {"a", "link"}) {
    folder.Write(stale, "half");
    CheckWritable(folder.Path(target));
    EXPECT_FALSE(std::filesystem::exists(folder.Path(stale))) << target;
    folder.Write(stale, "half");
    WriteFileAtomically(folder.Path(target), "new");
    EXPECT_FALSE(std::filesystem::exists(folder.Path(stale))) << target;
  }
  for (const std::string& name : others) EXPECT_TRUE(std::filesystem::exists(folder.Path(name))) << name;
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
