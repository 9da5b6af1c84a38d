// Lights at the limits: answers in closed form, relative errors below 1e-5.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "lights/area_light.h"
#include "lights/distant_light.h"
#include "lights/environment_light.h"
#include "lights/point_light.h"
#include "src/base/numerics.h"
#include "src/geometry/sphere.h"
#include "src/geometry/triangle_mesh.h"
#include "tests/lights/light_cases.h"

namespace dapple {
namespace {

constexpr double kRelativeError = 1e-5;

/// The irradiance at `at` by the midpoint rule over the light's own random numbers.
double IrradianceByMidpoints(const Light& light, const LightContext& at, int rows, int columns) {
  double sum = 0;
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) {
      LiRandom u;
      u.part = 0.5, u.direction = Vec2d((i + 0.5) / rows, (j + 0.5) / columns);
      const std::optional<LiSample> sample = light.Sample_Li(at, u);
      if (!sample) continue;
      const double cosTheta = std::max(0.0, Dot(ToDouble(sample->wi), ToDouble(at.n)));
      sum += static_cast<double>(sample->L.r) * cosTheta / sample->pdf / (rows * columns);
    }
  }
  return sum;
}

// Facing a sphere of radius 1 at distance d from its centre, the irradiance is pi L / d^2; the cosine is linear in the
// random number, so that midpoints give it exactly.
TEST(LightStress, SphereFromAMillionthToAMillionRadiiAway) {
  const Sphere sphere(Transform(), false, 1);
  const AreaLight light(&sphere, Color(2), false);
  for (const double height : {1e-6, 1e-5, 1e-3, 0.1, 1.0, 10.0, 1e3, 1e6}) {
    const auto z = static_cast<float>(1 + height);
    const double truth = 2 * kPiD / Sqr(static_cast<double>(z));
    const double estimate = IrradianceByMidpoints(light, LightContext(Vec3(0, 0, z), Vec3(0, 0, -1), false), 64, 4);
    EXPECT_NEAR(estimate / truth, 1, kRelativeError) << height;
  }
}

// Wherever a point is inside, a plane there has the irradiance pi L.
TEST(LightStress, SphereFromInside) {
  const Sphere sphere(Transform(), true, 1);
  const AreaLight light(&sphere, Color(2), false);
  for (const float z : {0.f, 0.5f, 0.999f, 0.999999f, -0.999999f}) {
    for (const float up : {1.f, -1.f}) {
      const LightContext at(Vec3(0, 0, z), Vec3(0, 0, up), false);
      EXPECT_NEAR(IrradianceByMidpoints(light, at, 64, 4) / (2 * kPiD), 1, kRelativeError) << z << " " << up;
    }
  }
}

// And the point that is drawn lies where the direction meets the sphere, from a millionth of a radius off its wall too,
// in long double; which the random numbers come back from.
TEST(LightStress, PointsOfASphereFromInside) {
  const Sphere sphere(Transform(), true, 1);
  const Vec3d aside = Normalize(Vec3d(1, -2, 0.7));
  for (const double radius : {0.0, 0.3, 0.999, 0.999999}) {
    const Vec3 reference = ToFloat(aside * radius);
    const Vec3d from = ToDouble(reference);
    for (int i = 0; i < 16 * 16; ++i) {
      const Vec2d u((i % 16 + 0.5) / 16, (i / 16 + 0.5) / 16);
      const auto sample = sphere.SampleSolidAngle(0, reference, u);
      ASSERT_TRUE(sample);
      const double length = Length(sample->toPoint);
      const Vec3d w = sample->toPoint / length;
      const auto of = [](double x) { return static_cast<long double>(x); };
      const long double along = of(from.x) * of(w.x) + of(from.y) * of(w.y) + of(from.z) * of(w.z);
      const long double squared = of(from.x) * of(from.x) + of(from.y) * of(from.y) + of(from.z) * of(from.z);
      const long double root = std::sqrt(along * along + (1 - squared));
      const long double truth = along > 0 ? (1 - squared) / (along + root) : root - along;
      EXPECT_NEAR(length / static_cast<double>(truth), 1, kRelativeError) << radius << " " << u;
      EXPECT_NEAR(Length(ToDouble(sample->p)), 1, 1e-6);
      EXPECT_NEAR(sphere.PdfSolidAngle(0, reference, sample->p, sample->n) * 4 * kPiD, 1, kRelativeError);
      // A float point on a sphere of radius one tells directions to a few 1e-8 over its distance.
      const Vec2d back = sphere.InvertSolidAngle(0, reference, sample->p);
      EXPECT_NEAR(back.y, u.y, 1e-6 / length);
    }
  }
}

// Of a ball of any size the same, and of a scene that is scaled with it.
TEST(LightStress, SpheresOfAllSizes) {
  for (const double scale : {1e-6, 1e-3, 1.0, 1e3, 1e6}) {
    const Sphere sphere(Transform::Scale(Vec3d(scale)), false, 1);
    const AreaLight light(&sphere, Color(2), false);
    const auto z = static_cast<float>(3 * scale);
    const double estimate = IrradianceByMidpoints(light, LightContext(Vec3(0, 0, z), Vec3(0, 0, -1), false), 64, 4);
    EXPECT_NEAR(estimate / (2 * kPiD / 9), 1, kRelativeError) << scale;
    EXPECT_NEAR(light.Area() / (4 * kPiD * scale * scale), 1, kRelativeError) << scale;
  }
}

TEST(LightStress, PointFromNearToFar) {
  const PointLight light(Vec3(0), Color(3));
  for (const float distance : {1e-6f, 1e-3f, 1.f, 1e3f, 1e6f, 1e10f}) {
    const auto sample = light.Sample_Li(LightContext(Vec3(0, distance, 0)), {});
    ASSERT_TRUE(sample);
    EXPECT_NEAR(static_cast<double>(sample->L.g) * Sqr(static_cast<double>(distance)) / 3, 1, kRelativeError);
    EXPECT_EQ(sample->wi, Vec3(0, -1, 0));
  }
}

TEST(LightStress, LightsAtInfinityInScenesOfAllSizes) {
  for (const double radius : {1e-6, 1e-3, 1.0, 1e3, 1e6}) {
    const double area = kPiD * radius * radius;
    DistantLight distant(Vec3(1, 2, -4), Color(3));
    UniformEnvironmentLight uniform(Color(2));
    EnvironmentLight map(RandomEnvironment(16, 8, 1), Transform(), Color(1), EnvironmentMapping::LatLong);
    for (Light* light : {static_cast<Light*>(&distant), static_cast<Light*>(&uniform), static_cast<Light*>(&map)}) {
      light->Prepare({Vec3(static_cast<float>(radius), 0, 0), static_cast<float>(radius)});
      RandomNumbers random(5);
      for (int i = 0; i < 100; ++i) {
        const auto sample = light->Sample_Le(random.Le());
        if (!sample) continue;
        ASSERT_NEAR(sample->pdfPos * area, 1, kRelativeError) << radius;
        ASSERT_EQ(light->Pdf_Le(sample->ray, sample->From()).position, sample->pdfPos) << radius;
      }
    }
    EXPECT_NEAR(static_cast<double>(distant.Power().g) / (3 * area), 1, kRelativeError) << radius;
    EXPECT_NEAR(static_cast<double>(uniform.Power().g) / (2 * 4 * kPiD * area), 1, kRelativeError) << radius;
    EXPECT_NEAR(static_cast<double>(map.Power().g) / (static_cast<double>(map.Map().Integral().g) * area), 1,
                kRelativeError)
        << radius;
  }
}

// A needle of 1 x 1e-6 at distance 2 above the receiver: it is so narrow that the irradiance is a line's, the integral
// of cos^2 / d^2 along it, = h^2 / (h^2 + x^2)^2 from x = 0 to 1, weighted by the width, which falls from 1 to 0.
TEST(LightStress, NeedleTriangle) {
  constexpr double kWidth = 1e-6, kHeight = 2;
  const auto h = static_cast<float>(kHeight);
  const TriangleMesh needle({{0, 0, h}, {0, static_cast<float>(kWidth), h}, {1, 0, h}}, {}, {}, {0, 1, 2});
  const AreaLight light(&needle, Color(1), false);
  EXPECT_NEAR(light.Area() / (kWidth / 2), 1, kRelativeError);
  double truth = 0;
  constexpr int kSteps = 10000;
  for (int i = 0; i < kSteps; ++i) {
    const double x = (i + 0.5) / kSteps;
    truth += kWidth * (1 - x) * Sqr(kHeight) / Sqr(Sqr(kHeight) + x * x) / kSteps;
  }
  const LightContext at(Vec3(0), Vec3(0, 0, 1), false);
  EXPECT_NEAR(IrradianceByMidpoints(light, at, 512, 512) / truth, 1, kRelativeError);
}

/// The integral over the sphere of the lookup in a latitude-longitude map that is one in one texel, of row `y`, and
/// zero elsewhere. In azimuth it is a tent of the integral 2 pi / width. From the middle t of the row it falls to zero
/// over h = pi / height on both sides, but toward a pole that the row reaches it stays one.
double IntegralOfOneTexel(int width, int height, int y) {
  const double h = kPiD / height, t = h * (y + 0.5);
  // Toward +pi, from `from` on: of sin, or of (1 - (theta - from) / h) sin theta.
  const auto side = [&](double from, bool isPole) {
    return isPole ? 1 + std::cos(from) : std::cos(from) - (std::sin(from + h) - std::sin(from)) / h;
  };
  return 2 * kPiD / width * (side(t, y == height - 1) + side(kPiD - t, y == 0));
}

// One bright texel of a map of any shape, at the poles, alone or beside black rows: all that is drawn is of it, and
// the mean of L / pdf is the integral in closed form, which the map tells too.
TEST(LightStress, MapsWithOneBrightTexel) {
  struct Case {
    int width, height, x, y;
  };
  for (const Case& c : {Case{1, 1, 0, 0},
                        {2, 1, 1, 0},
                        {1, 2, 0, 1},
                        {64, 32, 5, 0},
                        {64, 32, 60, 31},
                        {64, 32, 0, 16},
                        {63, 31, 62, 7}}) {
    Image image = Image::Rgb(c.width, c.height);
    image.SetColor(c.x, c.y, Color(1e4f));
    const EnvironmentMap map(image, EnvironmentMapping::LatLong, Color(1));
    // L / pdf is the same along a row. It jumps between the cells above and below the texel's middle, which takes many
    // points of the midpoint rule. Cells have shares of eighths: thirds keep off their borders.
    constexpr int kColumns = 3, kRows = 1 << 16;
    double mean = 0;
    for (int i = 0; i < kColumns * kRows; ++i) {
      const Vec2d u((i % kColumns + 0.5) / kColumns, (i / kColumns + 0.5) / kRows);
      const RadianceWithPdf value = map.Evaluate(map.Sample(u));
      ASSERT_GT(value.pdf, 0) << c.width << " " << c.y;
      mean += static_cast<double>(value.L.g) / value.pdf / (kColumns * kRows);
    }
    const double truth = 1e4 * IntegralOfOneTexel(c.width, c.height, c.y);
    EXPECT_NEAR(static_cast<double>(map.Integral().g) / truth, 1, kRelativeError) << c.width << " " << c.y;
    EXPECT_NEAR(mean / truth, 1, kRelativeError) << c.width << " " << c.y;
  }
}

}  // namespace
}  // namespace dapple
