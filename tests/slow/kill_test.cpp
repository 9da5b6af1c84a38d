// Killed at any moment and started again, a render ends as if nothing had happened; and so it does where pilots, which
// learn from the scene, are part of each start.
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <map>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "integrators/integrator.h"
#include "src/image/image_io.h"
#include "src/render/render_state.h"
#include "src/render/snapshots.h"
#include "tests/app/program.h"

namespace dapple {
namespace {

constexpr int kKills = 50;

class LongRender : public ProgramTest, public testing::WithParamInterface<std::string_view> {
 protected:
  /// Whether some bytes of a picture stand in a temporary file of the process (one that only tries whether there can be
  /// one has none).
  bool IsWriting(int process) const {
    return std::ranges::any_of(Files(), [&](const std::string& name) {
      std::error_code gone;
      const bool isPicture = name.starts_with(".a.exr." + std::to_string(process) + ".");
      const auto bytes = isPicture ? std::filesystem::file_size(Path(name), gone) : 0;
      return !gone && bytes > 0;
    });
  }
};

/// The picture that stands there, by its passes. One that is half written cannot be read.
void AddPicture(const std::string& path, const std::string& bytes, std::map<int, std::string>* pictures) {
  const int passes = std::get<int>(ReadExrMetadata(path).at("passes"));
  ReadImage(path);
  const auto [picture, isNew] = pictures->emplace(passes, bytes);
  EXPECT_TRUE(isNew || picture->second == bytes) << passes << " passes";
}

// The kills fall at random moments of a life, so that they hit the reading, the preparation, passes and the writing of
// checkpoints, which are saved after each pass. Every other life has few passes to render, and is killed when it is
// seen to write its picture, if it is seen. How long a life is is measured first, and again with each: longer after one
// that brought no pass, shorter after one that did, for the machine may have become busier or less busy. However many
// passes a life brought, it leaves a state that can be read, and a picture, if there is one, that is that of its
// passes.
TEST_P(LongRender, IsTheSameAfterFiftyKillsAtRandomMoments) {
  WriteSceneOfSharedWork("shared.pbrt");
  const std::string command = "shared.pbrt --quiet " + ShortRender(GetParam(), 9000) + "--integrator " +
                              std::string(GetParam()) + " --checkpoint 0.000001 --resume";
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_EQ(Run(command + " --passes 1 -o first.exr").exitCode, 0);
  double life = 1.5 * std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();

  std::mt19937 random(6);
  std::uniform_real_distribution<double> share(0, 1);
  int kills = 0, lives = 0, livesWithPasses = 0, killsInPicture = 0;
  int64_t passes = 0;
  std::map<int, std::string> pictures;
  for (; kills < kKills; ++lives) {
    const bool mayEnd = lives % 2 == 1;
    const std::string asked = " -o a.exr --passes " + std::to_string(mayEnd ? passes + 1 + lives / 2 % 3 : 1000000);
    const bool isKilled = mayEnd ? RunAndKillWhen(command + asked, [&](int process) { return IsWriting(process); })
                                 : RunAndKill(command + asked, life * share(random));
    ASSERT_TRUE(isKilled || mayEnd) << Read("stderr.txt");
    ASSERT_TRUE(isKilled || Read("stderr.txt").empty()) << Read("stderr.txt");
    kills += isKilled ? 1 : 0;
    const int64_t now = Exists("a.exr.checkpoint") ? ReadState(Path("a.exr.checkpoint")).film.PassCount() : int64_t{0};
    EXPECT_GE(now, passes);
    livesWithPasses += now > passes ? 1 : 0;
    if (!mayEnd) life *= now > passes ? 1 / 1.1 : 1.1;
    passes = now;
    if (Exists("a.exr")) AddPicture(Path("a.exr"), Read("a.exr"), &pictures);
    killsInPicture += mayEnd && isKilled ? 1 : 0;
  }
  std::cout << kills << " kills, " << killsInPicture << " while a picture was written; " << livesWithPasses << " of "
            << lives << " lives brought " << passes << " passes and " << pictures.size() << " pictures\n";
  EXPECT_GE(livesWithPasses, kKills / 10);

  const std::string rest = " --passes " + std::to_string(passes + 1);
  const ProgramResult resumed = Run(command + rest + " -o a.exr");
  ASSERT_EQ(resumed.exitCode, 0) << resumed.err;
  EXPECT_EQ(Files(),
            (std::vector<std::string>{"a.exr", "a.exr.checkpoint", "first.exr", "first.exr.checkpoint", "shared.pbrt"}))
      << "what the dead left behind is cleared away";
  ASSERT_EQ(Run(command + rest + " -o whole.exr --snapshots 1").exitCode, 0);
  EXPECT_TRUE(Read("a.exr") == Read("whole.exr"));
  for (const auto& [count, bytes] : pictures)
    EXPECT_TRUE(Read(SnapshotName("whole.exr", count)) == bytes) << count << " passes";
}

TEST_P(LongRender, IsTheSameWithAnyThreadsAndABreakWherePilotsLearn) {
  WriteSceneOfSharedWork("shared.pbrt");
  const std::string command =
      "shared.pbrt --quiet --photons 9000 --checkpoint 60 -o a.exr --integrator " + std::string(GetParam());
  ASSERT_EQ(Run(command + " --passes 3 --threads 1").exitCode, 0);
  const std::string whole = Read("a.exr");
  for (const std::string threads : {"1", "2", "3", "16"}) {
    ASSERT_EQ(Run(command + " --passes 1 --threads " + threads).exitCode, 0);
    ASSERT_EQ(Run(command + " --passes 3 --resume --threads " + threads).exitCode, 0);
    EXPECT_TRUE(Read("a.exr") == whole) << threads << " threads";
  }
}

std::vector<std::string_view> Names() { return IntegratorNames(); }

INSTANTIATE_TEST_SUITE_P(All, LongRender, testing::ValuesIn(Names()),
                         [](const auto& instance) { return std::string(instance.param); });

}  // namespace
}  // namespace dapple
