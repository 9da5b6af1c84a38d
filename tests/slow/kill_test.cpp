// Killed at any moment and started again, a render ends as if nothing had happened; and so it does where pilots, which
// learn from the scene, are part of each start.
#include <chrono>
#include <iostream>
#include <random>

#include <gtest/gtest.h>

#include "integrators/integrator.h"
#include "src/render/render_state.h"
#include "tests/app/program.h"

namespace dapple {
namespace {

constexpr int kKills = 50;

class LongRender : public ProgramTest, public testing::WithParamInterface<std::string_view> {};

// The kills fall at random moments of a life, so that they hit the reading, the preparation, passes and the writing of
// checkpoints, which are saved after each pass. How long a life is is measured first, and again with each: longer after
// one that brought no pass, shorter after one that did, for the machine may have become busier or less busy. However
// many passes a life brought, it begins with a state that can be read.
TEST_P(LongRender, IsTheSameAfterFiftyKillsAtRandomMoments) {
  WriteSceneOfSharedWork("shared.pbrt");
  const std::string command = "shared.pbrt --quiet --photons 9000 --no-guide --radius 0.2 --integrator " +
                              std::string(GetParam()) + " --checkpoint 0.000001 --resume";
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_EQ(Run(command + " --passes 1 -o first.exr").exitCode, 0);
  double life = 1.5 * std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();

  std::mt19937 random(6);
  std::uniform_real_distribution<double> share(0, 1);
  int kills = 0, livesWithPasses = 0;
  int64_t passes = 0;
  while (kills < kKills) {
    ASSERT_TRUE(RunAndKill(command + " --passes 1000000 -o a.exr", life * share(random))) << Read("stderr.txt");
    ++kills;
    const int64_t now = Exists("a.exr.checkpoint") ? ReadState(Path("a.exr.checkpoint")).film.PassCount() : int64_t{0};
    EXPECT_GE(now, passes);
    livesWithPasses += now > passes ? 1 : 0;
    life *= now > passes ? 1 / 1.1 : 1.1;
    passes = now;
    EXPECT_FALSE(Exists("a.exr")) << "no picture before the end";
  }
  std::cout << kills << " kills; " << livesWithPasses << " lives brought " << passes << " passes\n";
  EXPECT_GE(livesWithPasses, kKills / 10);

  const std::string rest = " --passes " + std::to_string(passes + 1);
  const ProgramResult resumed = Run(command + rest + " -o a.exr");
  ASSERT_EQ(resumed.exitCode, 0) << resumed.err;
  ASSERT_EQ(Run(command + rest + " -o whole.exr").exitCode, 0);
  EXPECT_TRUE(Read("a.exr") == Read("whole.exr"));
  EXPECT_EQ(Files(), (std::vector<std::string>{"a.exr", "a.exr.checkpoint", "first.exr", "first.exr.checkpoint",
                                               "shared.pbrt", "whole.exr", "whole.exr.checkpoint"}))
      << "what the dead left behind is cleared away";
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
