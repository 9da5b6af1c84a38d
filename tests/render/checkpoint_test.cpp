#include "src/render/checkpoint.h"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

namespace dapple {
namespace {

Film SmallFilm(int passes) {
  Film film({3, 2}, {{0, 0}, {3, 2}}, Filter::Gaussian());
  film.ClampTo(100);
  film.AddExtraChannels(FilmChannels({.depth = true}));
  for (int pass = 0; pass < passes; ++pass) {
    film.AddSample({1, 1}, Color(static_cast<float>(pass) + 0.1f), pass);
    film.AddExtras({2, 0}, std::vector<float>{1.5f, 1});
    film.FinishPass(pass);
  }
  return film;
}

RenderOrigin Origin(int seed = 7) {
  RenderOrigin origin;
  origin.identity = MakeIdentity({"abc", "none"}, SmallFilm(0), {.depth = true}, "path", {}, seed);
  origin.record.scene = "a \"scene\"\n\xff.pbrt";
  origin.record.integrator = "path";
  origin.record.seed = seed;
  origin.exposure = 0.1f;
  origin.aovs = {.depth = true};
  origin.record.clamp = 100;
  return origin;
}

class CheckpointTest : public testing::Test {
 protected:
  CheckpointTest() { std::filesystem::remove(path_); }

  std::string path_ =
      testing::TempDir() + "/" + testing::UnitTest::GetInstance()->current_test_info()->name() + ".exr.checkpoint";
};

RenderProgress ProgressOf(const Film& film, double seconds) {
  RenderProgress progress;
  progress.film = &film;
  progress.passesDone = static_cast<int>(film.PassCount());
  progress.seconds = seconds;
  return progress;
}

TEST_F(CheckpointTest, GivesBackTheFilmAndWhatItIsOf) {
  Checkpoint saved(path_, Origin(), 10);
  EXPECT_FALSE(saved.Load({.passes = 5, .seconds = {}}).has_value()) << "there is none yet";
  saved.Save(SmallFilm(3), 2.5);
  Checkpoint loaded(path_, Origin(), 10);
  const std::optional<Film> film = loaded.Load({.passes = 5, .seconds = {}});
  ASSERT_TRUE(film.has_value());
  EXPECT_EQ(*film, SmallFilm(3));
  EXPECT_EQ(loaded.SecondsBefore(), 2.5);
  const RenderState state = ReadState(path_);
  EXPECT_EQ(state.origin.exposure, 0.1f);
  EXPECT_EQ(state.origin.aovs, AovSet{.depth = true});
  EXPECT_EQ(state.origin.identity.fields, Origin().identity.fields);
  EXPECT_EQ(RecordOf(state).passes, 3);
  EXPECT_EQ(RecordOf(state).clamp, 100);
}

TEST_F(CheckpointTest, IsSavedWhenItsTimeHasComeAndThereIsSomethingNew) {
  Checkpoint checkpoint(path_, Origin(), 10);
  const auto passesSaved = [&]() -> int64_t {
    return std::filesystem::exists(path_) ? ReadState(path_).film.PassCount() : 0;
  };
  const auto update = [&](int passes, double seconds) {
    const Film film = SmallFilm(passes);
    EXPECT_FALSE(checkpoint.Update(ProgressOf(film, seconds)).has_value());
    return passesSaved();
  };
  EXPECT_EQ(update(0, 11), 0) << "no pass, nothing to save";
  EXPECT_EQ(update(1, 9), 0);
  EXPECT_EQ(update(2, 10), 2);
  EXPECT_EQ(update(3, 19), 2);
  EXPECT_EQ(update(4, 20), 4);
}

TEST_F(CheckpointTest, RefusesOtherRendersAndPassesOutsideTheBudget) {
  Checkpoint(path_, Origin(), 10).Save(SmallFilm(3), 1);
  EXPECT_THROW(Checkpoint(path_, Origin(8), 10).Load({.passes = 5, .seconds = {}}), Error);
  EXPECT_THROW(Checkpoint(path_, Origin(), 10).Load({.passes = 2, .seconds = {}}), Error);
  EXPECT_THROW(Checkpoint(path_, Origin(), 10).Load({.passes = 5, .seconds = {}, .firstPass = 1}), Error);
  EXPECT_TRUE(Checkpoint(path_, Origin(), 10).Load({.passes = {}, .seconds = 1}).has_value());
}

// Each bit of the file matters: one that is turned is told, wherever it stands.
TEST_F(CheckpointTest, DamageIsFoundWhereverItIs) {
  WriteState(path_, Origin(), SmallFilm(2));
  std::ifstream file(path_, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  for (size_t i = 0; i < bytes.size(); ++i) {
    std::string broken = bytes;
    broken[i] = static_cast<char>(broken[i] ^ (1 << i % 8));
    std::ofstream(path_, std::ios::binary) << broken;
    EXPECT_THROW(ReadState(path_), Error) << i;
  }
  for (size_t length = 0; length < bytes.size(); length += 7) {
    std::ofstream(path_, std::ios::binary) << bytes.substr(0, length);
    EXPECT_THROW(ReadState(path_), Error) << length;
  }
}

TEST_F(CheckpointTest, AnotherVersionsStateIsToldAsOne) {
  WriteState(path_, Origin(), SmallFilm(2));
  std::ifstream file(path_, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(file), {}};
  bytes.replace(0, bytes.find('\n'), "dapple render state 1");
  std::ofstream(path_, std::ios::binary) << bytes;
  try {
    Checkpoint(path_, Origin(), 10).Load({.passes = 5, .seconds = {}});
    ADD_FAILURE() << "it was taken";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("another version of the program"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace dapple
