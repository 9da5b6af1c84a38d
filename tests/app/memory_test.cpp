#include "src/app/memory.h"

#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "tests/image/temporary_folder.h"

namespace dapple {
namespace {

constexpr int64_t kNoBound = std::numeric_limits<int64_t>::max();

class GroupMemory : public testing::Test {
 protected:
  void Write(const std::string& file, const std::string& text) const {
    const std::filesystem::path path = folder_.Path(file);
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path) << text;
  }
  int64_t LimitOf(const std::string& groups) const {
    return GroupMemoryBytes(folder_.Write("cgroup", groups), folder_.Path("root"));
  }

  TemporaryFolder folder_;
};

TEST_F(GroupMemory, IsTheLeastOfTheGroupAndThoseAroundIt) {
  Write("root/memory.max", "max\n");
  Write("root/jobs/memory.max", "4000000\n");
  Write("root/jobs/mine/memory.max", "5000000\n");
  Write("root/jobs/small/memory.max", "300000\n");
  EXPECT_EQ(LimitOf("0::/\n"), kNoBound);
  EXPECT_EQ(LimitOf("0::/jobs/mine\n"), 4000000);
  EXPECT_EQ(LimitOf("0::/jobs/small\n"), 300000);
  EXPECT_EQ(LimitOf("0::/elsewhere/unseen\n"), kNoBound);
}

TEST_F(GroupMemory, IsThatOfTheMemoryControllerWhereEachHasAHierarchy) {
  Write("root/memory/memory.limit_in_bytes", "9223372036854771712\n");
  Write("root/memory/a/memory.limit_in_bytes", "700000\n");
  Write("root/cpu/a/memory.limit_in_bytes", "1\n");
  EXPECT_EQ(LimitOf("5:cpu,cpuacct:/a\n4:memory:/a/b\n0::/a\n"), 700000);
  EXPECT_EQ(LimitOf("4:hugetlb,memory:/a\n"), 700000);
  EXPECT_EQ(LimitOf("5:cpu,cpuacct:/a\n"), kNoBound);
}

TEST_F(GroupMemory, NoGroupsAreNoBound) {
  EXPECT_EQ(LimitOf(""), kNoBound);
  EXPECT_EQ(GroupMemoryBytes(folder_.Path("none"), folder_.Path("root")), kNoBound);
  EXPECT_GT(MachineMemoryBytes(), 0);
}

}  // namespace
}  // namespace dapple
