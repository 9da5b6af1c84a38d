// Lights of scenes that lie far away, are tiny or huge: the light that arrives and the power are those of the same
// scene at its place, scaled as physics has it.
#include <cmath>

#include <fmt/format.h>

#include "src/base/numerics.h"
#include "tests/io/build_test_support.h"
#include "tests/support/random_numbers.h"

namespace dapple {
namespace {

struct Kind {
  std::string name, text;
  double irradiance;  ///< the power of the scene's scale with which light that arrives grows
  double power;       ///< and that of the light's power
};

Kind AreaKind(const std::string& name, const std::string& shape) {
  return {name, "AreaLightSource \"diffuse\" \"rgb L\" [3 2 1] \"bool twosided\" true Translate 0.3 0.2 2 " + shape, 0,
          2};
}

std::vector<Kind> Kinds() {
  return {
      {"point", R"(LightSource "point" "rgb I" [3 2 1] "point3 from" [0.3 0.2 2])", -2, 0},
      {"spot",
       R"(LightSource "spot" "rgb I" [3 2 1] "point3 from" [0.3 0.2 2] "point3 to" [0 0 0] "float coneangle" 60)", -2,
       0},
      {"projection", R"(Translate 0.3 0.2 2 Rotate 170 1 0.2 0 LightSource "projection" "string filename" "slide.png")",
       -2, 0},
      {"goniometric", R"(Translate 0.3 0.2 2 LightSource "goniometric" "string filename" "lamp.png")", -2, 0},
      {"distant", R"(LightSource "distant" "rgb L" [3 2 1] "point3 from" [1 2 4] "point3 to" [0 0 0])", 0, 2},
      {"environment", R"(LightSource "infinite" "rgb L" [3 2 1])", 0, 2},
      {"environment of an image", R"(LightSource "infinite" "string filename" "lamp.png")", 0, 2},
      AreaKind("sphere", R"(Shape "sphere" "float radius" 0.4)"),
      AreaKind("ellipsoid", R"(Scale 1 0.5 0.25 Shape "sphere" "float radius" 0.4)"),
      AreaKind("disk", R"(Rotate 160 1 0.3 0 Shape "disk" "float radius" 0.4)"),
      AreaKind("cylinder", R"(Rotate 70 1 0.3 0 Shape "cylinder" "float radius" 0.2)"),
      AreaKind("triangles", R"(Shape "trianglemesh" "integer indices" [0 1 2 0 2 3]
                               "point3 P" [0 0 0 0.5 0 0.2 0.5 0.5 0 -0.2 0.6 0.1])"),
      AreaKind("bilinear", R"(Shape "bilinearmesh" "point3 P" [0 0 0 0.5 0 0.2 0 0.5 0.1 0.6 0.6 0])"),
  };
}

/// The light over a floor; all of it times `scale`, then moved.
Built FloorUnder(const Kind& kind, double scale, double offset) {
  const auto at = [&](double x, double y, double z) {
    return fmt::format("{} {} {} ", x * scale + offset, y * scale - offset, z * scale + offset / 2);
  };
  return BuildText("LookAt " + at(0, -3, 4) + at(0, 0, 0) +
                       "0 0 1 Camera \"perspective\" \"float fov\" 30 "
                       "Film \"rgb\" \"integer xresolution\" 32 \"integer yresolution\" 32 WorldBegin " +
                       "Translate " + at(0, 0, 0) + fmt::format("Scale {0} {0} {0} ", scale) +
                       "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] "
                       "\"point3 P\" [-3 -3 0 3 -3 0 3 3 0 -3 3 0] AttributeBegin " +
                       kind.text + " AttributeEnd ",
                   4, {}, std::filesystem::path(DAPPLE_SOURCE_DIR) / "docs" / "scenes");
}

/// An estimate of the irradiance at the floor behind the pixel, by the same random numbers in every scene.
double IrradianceAt(const Scene& scene, const Vec2& film) {
  const std::optional<SurfaceInteraction> hit = scene.Intersect(scene.GetCamera().GenerateRay(film, {0.5, 0.5}, 0).ray);
  if (!hit || scene.AreaLightAt(*hit) >= 0) return 0;
  LightContext at(hit->p, hit->ng, false);
  if (at.n.z < 0) at.n = -at.n;
  constexpr int kSamples = 64;
  testing::UniformNumbers random(7);
  double sum = 0;
  for (int i = 0; i < kSamples; ++i) {
    LiRandom u;
    u.part = random.Get1D(), u.direction = random.Get2D();
    const std::optional<LiSample> sample = scene.Lights()[0]->Sample_Li(at, u);
    if (!sample || Dot(sample->wi, at.n) <= 0 || !scene.Unoccluded(scene.ShadowRay(*hit, *sample))) continue;
    sum += static_cast<double>(sample->L.g * Dot(sample->wi, at.n)) / sample->pdf / kSamples;
  }
  return sum;
}

TEST(MovedLights, FarTinyAndHugeScenesAreLitTheSame) {
  // Float rounding of positions; the edges of a projected slide magnify it most, to 1.1e-5.
  constexpr double kRelativeError = 2e-5;
  const struct { double scale, offset; } kCases[] = {{1, 1e7}, {1e-6, 0}, {1e6, 0}, {1e6, 1e7}};
  for (const Kind& kind : Kinds()) {
    const Built expected = FloorUnder(kind, 1, 0);
    ASSERT_EQ(expected->Lights().size(), 1u) << kind.name;
    for (const auto& c : kCases) {
      const Built built = FloorUnder(kind, c.scale, c.offset);
      ASSERT_EQ(built->Lights().size(), 1u) << kind.name;
      const std::string what = fmt::format("{}, scale {}, offset {}", kind.name, c.scale, c.offset);
      EXPECT_TRUE(built.warnings.empty()) << what << ": " << built.warnings.front();
      const auto power = [](const Built& b) { return static_cast<double>(b->Lights()[0]->Power().g); };
      EXPECT_NEAR(power(built) / power(expected) / std::pow(c.scale, kind.power), 1, kRelativeError) << what;
      int lit = 0;
      for (const Vec2& film : {Vec2(16, 16), Vec2(10, 19), Vec2(19, 22), Vec2(14, 13)}) {
        const double truth = IrradianceAt(*expected.scene, film);
        if (truth > 0) ++lit;
        EXPECT_NEAR(IrradianceAt(*built.scene, film) / std::pow(c.scale, kind.irradiance), truth,
                    kRelativeError * truth)
            << what;
      }
      EXPECT_GE(lit, 3) << what;
    }
  }
}

}  // namespace
}  // namespace dapple
