#include "src/render/checkpoint.h"

#include <array>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/image/temporary_folder.h"
#include "tests/render/scarce_memory.h"

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
  TemporaryFolder folder_;
  const std::string output_ = folder_.Path("a.exr"), path_ = folder_.Path("a.exr.checkpoint");
};

RenderProgress ProgressOf(const Film& film, double seconds) {
  RenderProgress progress;
  progress.film = &film;
  progress.passesDone = static_cast<int>(film.PassCount());
  progress.seconds = seconds;
  return progress;
}

TEST_F(CheckpointTest, GivesBackTheFilmAndWhatItIsOf) {
  Checkpoint saved(output_, Origin(), 10);
  EXPECT_FALSE(saved.Load({.passes = 5, .seconds = {}}).has_value()) << "there is none yet";
  saved.Save(SmallFilm(3), 2.5);
  Checkpoint loaded(output_, Origin(), 10);
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
  Checkpoint checkpoint(output_, Origin(), 10);
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
  Checkpoint(output_, Origin(), 10).Save(SmallFilm(3), 1);
  EXPECT_THROW(Checkpoint(output_, Origin(8), 10).Load({.passes = 5, .seconds = {}}), Error);
  EXPECT_THROW(Checkpoint(output_, Origin(), 10).Load({.passes = 2, .seconds = {}}), Error);
  EXPECT_THROW(Checkpoint(output_, Origin(), 10).Load({.passes = 5, .seconds = {}, .firstPass = 1}), Error);
  EXPECT_TRUE(Checkpoint(output_, Origin(), 10).Load({.passes = {}, .seconds = 1}).has_value());
}

// The work of hours must not go for a command that forgot to go on from it.
TEST_F(CheckpointTest, OneThatItDidNotReadIsSetAside) {
  std::vector<std::string> told;
  const auto tell = [&](const std::string& older) { told.push_back(older); };
  const std::string older = path_ + ".old";
  Checkpoint(output_, Origin(), 10, tell).Save(SmallFilm(3), 1);
  EXPECT_TRUE(told.empty()) << "there was none before";

  Checkpoint other(output_, Origin(8), 10, tell);
  EXPECT_EQ(ReadState(path_).film, SmallFilm(3)) << "as long as nothing is saved";
  for (const int passes : {1, 2}) other.Save(SmallFilm(passes), 1);
  EXPECT_EQ(told, std::vector{older}) << "its own ones are replaced";
  EXPECT_EQ(ReadState(older).film, SmallFilm(3));
  EXPECT_EQ(ReadState(path_).film, SmallFilm(2));

  Checkpoint goesOn(output_, Origin(8), 10, tell);
  ASSERT_TRUE(goesOn.Load({.passes = 5, .seconds = {}}).has_value());
  goesOn.Save(SmallFilm(5), 1);
  EXPECT_EQ(told.size(), 1u);
  EXPECT_EQ(ReadState(older).film, SmallFilm(3)) << "what was gone on with is no older one";

  Checkpoint(output_, Origin(9), 10, tell).Save(SmallFilm(1), 1);
  EXPECT_EQ(told.size(), 2u);
  EXPECT_EQ(ReadState(older).film, SmallFilm(5));
}

TEST_F(CheckpointTest, OneThatCannotBeSetAsideIsNotReplaced) {
  Checkpoint(output_, Origin(), 10).Save(SmallFilm(3), 1);
  std::filesystem::create_directory(path_ + ".old");
  EXPECT_THROW(Checkpoint(output_, Origin(), 10).Save(SmallFilm(1), 1), Error);
  EXPECT_EQ(ReadState(path_).film, SmallFilm(3));
}

TEST_F(CheckpointTest, MemoryThatDoesNotSufficeIsAnErrorThatTheRenderOutlives) {
  Checkpoint checkpoint(output_, Origin(), 10);
  checkpoint.Save(SmallFilm(1), 1);
  const Film film = SmallFilm(2);
  const RenderProgress progress = ProgressOf(film, 20);
  const size_t stateBytes = film.Serialize().size();
  std::optional<Error> error;
  {
    const ScarceMemory scarce(stateBytes);
    error = checkpoint.Update(progress);
  }
  ASSERT_TRUE(error.has_value());
  EXPECT_EQ(std::string(error->what()), path_ + ": error: the memory does not suffice to write the state");
  EXPECT_EQ(ReadState(path_).film.PassCount(), 1) << "the one before it stays";
  EXPECT_EQ(checkpoint.PassesSaved(), 1);
}

// Both halves of the file are whole, and not of each other.
TEST_F(CheckpointTest, LayersWithoutTheirChannelsAreRefused) {
  Film film({3, 2}, {{0, 0}, {3, 2}}, Filter::Gaussian());
  film.FinishPass(0);
  WriteState(path_, Origin(), film);
  EXPECT_THROW(ReadState(path_), Error);
  RenderOrigin plain = Origin();
  plain.aovs = {};
  WriteState(path_, plain, SmallFilm(1));
  EXPECT_THROW(ReadState(path_), Error);
  WriteState(path_, Origin(), SmallFilm(1));
  EXPECT_NO_THROW(ReadState(path_));
}

TEST_F(CheckpointTest, AJoinIsOfTheSceneOfItsFirstPassInAnyOrder) {
  const auto part = [](int pass, const std::string& scene) {
    Film film({3, 2}, {{0, 0}, {3, 2}}, Filter::Gaussian());
    film.ClampTo(100);
    film.AddExtraChannels(FilmChannels({.depth = true}));
    film.FinishPass(pass);
    RenderState state{Origin(), std::move(film)};
    state.origin.record.scene = scene;
    return state;
  };
  const RenderState parts[] = {part(4, "four.pbrt"), part(0, "zero.pbrt"), part(2, "two.pbrt")};
  for (const auto& order : {std::array{0, 1, 2}, std::array{1, 0, 2}, std::array{2, 0, 1}, std::array{0, 2, 1}}) {
    RenderState whole = parts[order[0]];
    for (const int i : {order[1], order[2]}) JoinState(parts[i], "part.dapple", &whole);
    EXPECT_EQ(RecordOf(whole).scene, "zero.pbrt");
  }
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
    Checkpoint(output_, Origin(), 10).Load({.passes = 5, .seconds = {}});
    ADD_FAILURE() << "it was taken";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("another version of the program"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace dapple
