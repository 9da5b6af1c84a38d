#include "src/render/aov.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "src/render/driver.h"
#include "tests/support/random_numbers.h"
#include "tests/support/scene_from_text.h"

namespace dapple {
namespace {

using testing::UniformNumbers;
using testing_support::SceneFromText;

constexpr AovSet kAll{.albedo = true, .normal = true, .depth = true, .position = true, .variance = true};

/// A wall that leaves the left half of the picture free, far from the origin of the world: at z = 1004, seen from
/// z = 1000 along z. Behind it a sphere without material hangs in the way: an interface, which nothing sees.
std::unique_ptr<Scene> WallScene(const std::string& camera, const std::string& filter = "\"box\"") {
  return SceneFromText(
      "PixelFilter " + filter +
      "\nFilm \"image\" \"integer xresolution\" [8] \"integer yresolution\" [8]\n"
      "LookAt 100 200 1000  100 200 1001  0 1 0\nCamera " +
      camera +
      "\nWorldBegin\nLightSource \"point\" \"point from\" [100 200 1000]\n"
      "AttributeBegin Material \"none\" Translate 100.5 200 1002 Shape \"sphere\" \"float radius\" 0.4 "
      "AttributeEnd\n"
      "Material \"matte\" \"color Kd\" [0.6 0.5 0.4]\n"
      "Shape \"trianglemesh\" \"point P\" [100 100 1004  300 100 1004  100 300 1004  300 300 1004]\n"
      "  \"integer indices\" [0 1 2  1 3 2]\nWorldEnd\n");
}

Image Render(const Scene& scene, const AovSet& aovs, std::string_view integratorName, int passes) {
  Film film(scene.Settings().resolution, scene.Settings().crop, scene.Settings().filter);
  if (const auto channels = FilmChannels(aovs); !channels.empty()) film.AddExtraChannels(channels);
  IntegratorOptions options;
  options.photonsPerPass = 200;
  const auto integrator = MakeIntegrator(integratorName, options);
  Render(scene, 3, *integrator, film, {.passes = passes, .seconds = {}});
  EXPECT_EQ(film.NonFiniteCount(), 0);
  return ToPicture(film, 1, aovs);
}

float ValueAt(const Image& image, int x, int y, std::string_view channel) {
  return image.At(x, y, image.FindChannel(channel));
}

TEST(Aov, NamesAreReadAndToldInOneOrder) {
  EXPECT_EQ(ParseAovs("albedo,normal,depth,position,variance"), kAll);
  EXPECT_EQ(ToString(*ParseAovs("variance,albedo")), "albedo,variance");
  EXPECT_EQ(ParseAovs(ToString(AovSet())), AovSet());
  EXPECT_FALSE(ParseAovs("albedo,colour").has_value());
  EXPECT_FALSE(ParseAovs("albedo,,depth").has_value());
}

TEST(Aov, AreWhatTheCameraMeetsFirst) {
  for (const char* camera : {"\"perspective\" \"float fov\" 60", "\"orthographic\""}) {
    const auto scene = WallScene(camera);
    const Image image = Render(*scene, kAll, "path", 4);
    EXPECT_EQ(image.ChannelNames(),
              (std::vector<std::string>{"R", "G", "B", "albedo.R", "albedo.G", "albedo.B", "N.X", "N.Y", "N.Z", "Z",
                                        "P.X", "P.Y", "P.Z", "variance.R", "variance.G", "variance.B"}));
    int walls = 0;
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 8; ++x) {
        if (std::isinf(ValueAt(image, x, y, "Z"))) {
          for (const char* channel : {"albedo.R", "N.X", "N.Y", "N.Z", "P.X", "P.Y", "P.Z", "R"})
            EXPECT_EQ(ValueAt(image, x, y, channel), 0) << channel;
          continue;
        }
        ++walls;
        EXPECT_NEAR(ValueAt(image, x, y, "albedo.R"), 0.6, 1e-6);
        EXPECT_NEAR(ValueAt(image, x, y, "albedo.G"), 0.5, 1e-6);
        EXPECT_NEAR(ValueAt(image, x, y, "albedo.B"), 0.4, 1e-6);
        EXPECT_NEAR(ValueAt(image, x, y, "N.Z"), -1, 1e-6) << "toward the viewer";
        EXPECT_NEAR(ValueAt(image, x, y, "Z"), 4, 1e-5) << "along the view, not along the ray";
        EXPECT_NEAR(ValueAt(image, x, y, "P.Z"), 1004, 1e-3);
        EXPECT_GE(ValueAt(image, x, y, "P.X"), 100);
        EXPECT_NEAR(ValueAt(image, x, y, "P.Y"), 200, 4);
      }
    EXPECT_EQ(walls, 32);
  }
}

// A camera all around tells the distance. Of a pixel that half of its rays hit, depth and place are those of the hits.
TEST(Aov, OfCamerasAllAroundDepthIsDistance) {
  const auto scene = WallScene("\"environment\"");
  const Image image = Render(*scene, kAll, "path", 16);
  int hits = 0;
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) {
      const float depth = ValueAt(image, x, y, "Z");
      if (std::isinf(depth)) continue;
      ++hits;
      EXPECT_GE(depth, 4 * 0.9999f);
      EXPECT_NEAR(ValueAt(image, x, y, "P.Z"), 1004, 1e-3);
      EXPECT_LE(ValueAt(image, x, y, "albedo.R"), 0.6f * 1.0001f);
    }
  EXPECT_GE(hits, 8);
  EXPECT_LT(hits, 64);
}

// A filter with negative lobes gives no depth that lies nowhere.
TEST(Aov, AreMeansWithoutNegativeWeights) {
  const auto scene =
      WallScene("\"perspective\" \"float fov\" 60", "\"mitchell\" \"float xwidth\" 2 \"float ywidth\" 2");
  const Image image = Render(*scene, kAll, "path", 32);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) {
      EXPECT_GE(ValueAt(image, x, y, "albedo.R"), 0);
      EXPECT_LE(ValueAt(image, x, y, "albedo.R"), 0.6f * 1.0001f);
      if (std::isinf(ValueAt(image, x, y, "Z"))) continue;
      EXPECT_NEAR(ValueAt(image, x, y, "Z"), 4, 1e-4);
    }
}

TEST(Aov, ChangeNothingOfThePictureOfAnyIntegrator) {
  const auto scene = WallScene("\"perspective\" \"float fov\" 60");
  for (const std::string_view name : IntegratorNames()) {
    const Image with = Render(*scene, kAll, name, 3), without = Render(*scene, {}, name, 3);
    EXPECT_EQ(without.Channels(), 3);
    bool isSame = true;
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 8; ++x) isSame &= with.ColorAt(x, y) == without.ColorAt(x, y);
    EXPECT_TRUE(isSame) << name;
  }
}

// Independent noise of known variance in each pass: the mean of the layer over n pixels is the variance of the pixels'
// means, within five standard deviations (an estimate from two halves has one degree of freedom: sqrt(2 / n) of it).
TEST(Aov, VarianceIsThatOfThePixelsMean) {
  constexpr int kSide = 100;
  for (const int passes : {2, 5}) {
    Film film({kSide, kSide}, {{0, 0}, {kSide, kSide}}, Filter::Box());
    for (int pass = 0; pass < passes; ++pass) {
      UniformNumbers random(static_cast<uint64_t>(pass));
      for (int i = 0; i < kSide * kSide; ++i)
        film.AddSample({i % kSide, i / kSide}, Color(static_cast<float>(random.Get1D())), pass);
      film.FinishPass(pass);
    }
    const Image image = ToPicture(film, 2, {.variance = true});
    double sum = 0;
    for (int i = 0; i < kSide * kSide; ++i)
      sum += static_cast<double>(ValueAt(image, i % kSide, i / kSide, "variance.G"));
    const double expected = 4. / 12 / passes;
    EXPECT_NEAR(sum / (kSide * kSide), expected, 5 * expected * std::sqrt(2.) / kSide) << passes;
  }
}

}  // namespace
}  // namespace dapple
