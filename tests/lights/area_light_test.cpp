#include "lights/area_light.h"

#include <chrono>
#include <cmath>

#include <gtest/gtest.h>

#include "src/base/numerics.h"
#include "src/geometry/bilinear_mesh.h"
#include "src/geometry/sphere.h"
#include "src/geometry/triangle_mesh.h"
#include "tests/lights/light_cases.h"
#include "tests/support/chi_square.h"

namespace dapple {
namespace {

double Irradiance(const Light& light, const LightContext& at, int samples, double* error) {
  RandomNumbers random(1);
  Mean mean;
  for (int i = 0; i < samples; ++i) {
    const std::optional<LiSample> sample = light.Sample_Li(at, random.Li());
    mean.Add(sample ? static_cast<double>(sample->L.r) * std::max(0.0, Dot(ToDouble(sample->wi), ToDouble(at.n))) /
                          sample->pdf
                    : 0);
  }
  *error = mean.StandardError();
  return mean.Value();
}

// Facing a sphere of radius r at distance d from its centre, the irradiance is pi L (r / d)^2.
TEST(AreaLight, SpheresFromNearToFarGiveTheirIrradiance) {
  const Sphere sphere(Transform(), false, 1);
  const AreaLight light(&sphere, Color(2), false);
  for (const double distance : {1 + 1e-6, 1 + 1e-3, 1.5, 10.0, 1e3, 1e4, 1e6}) {
    const Vec3 toCentre = Normalize(Vec3(1, 2, -2));
    const LightContext at(toCentre * static_cast<float>(-distance), toCentre, false);
    const double truth = 2 * kPiD / Sqr(distance);
    double error;
    const double estimate = Irradiance(light, at, 4000, &error);
    EXPECT_NEAR(estimate / truth, 1, 5 * error / truth + 1e-3) << distance;
    EXPECT_LT(error / truth, 0.02) << distance;  // directions within the cone, not points of the surface
  }
}

// Whoever knows which triangle a ray leaves from may say so: the same comes out as from a search.
TEST(AreaLight, APrimitiveThatIsToldIsTheOneThatIsFound) {
  const TriangleMesh mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-3, 1, 0}, {0, 4, 1}, {5, 5, 5}, {6, 5, 5}, {5, 5, 6}}, {},
                          {}, {0, 1, 2, 2, 3, 4, 5, 6, 7});
  const AreaLight light(&mesh, Color(2), false);
  RandomNumbers random(1);
  const auto holds = [&](int primitive, const Vec3& p) {
    const Vec3 nearest = mesh.SampleArea(primitive, mesh.InvertArea(primitive, p)).p;
    return Length(nearest - p) < 1e-4f;
  };
  for (int i = 0; i < 1000; ++i) {
    const std::optional<LeSample> emitted = light.Sample_Le(random.Le());
    ASSERT_TRUE(emitted);
    const LightPoint told = emitted->From(), sought{emitted->n};
    ASSERT_TRUE(holds(emitted->primitive, emitted->ray.o));
    EXPECT_EQ(light.Pdf_Le(emitted->ray, told).position, light.Pdf_Le(emitted->ray, sought).position);
    EXPECT_EQ(light.Invert_Le(emitted->ray, told).part, light.Invert_Le(emitted->ray, sought).part);
    EXPECT_EQ(light.Invert_Le(emitted->ray, told).position, light.Invert_Le(emitted->ray, sought).position);
    const std::optional<LiSample> seen =
        light.Sample_Li(LightContext(Vec3(1, 1, 9), Vec3(0, 0, -1), false), random.Li());
    EXPECT_TRUE(!seen || holds(seen->primitive, seen->p));
  }
}

TEST(AreaLight, TheInsideOfASphereIsLitFromEverywhere) {
  const Sphere sphere(Transform(), true, 1);
  const AreaLight light(&sphere, Color(2), false);
  for (const float z : {0.f, 0.5f, 0.99f}) {
    double error;
    const double estimate = Irradiance(light, LightContext(Vec3(0, 0, z), Vec3(0.6f, 0, -0.8f), false), 20000, &error);
    EXPECT_NEAR(estimate, 2 * kPiD, 5 * error) << z;
  }
  const AreaLight outward(&sphere, Color(2), true);
  EXPECT_NEAR(outward.Power().r, 2 * 4 * kPiD * 2 * kPiD, 1e-3);
}

TEST(AreaLight, ScaleOfTheSceneDoesNotMatter) {
  for (const double scale : {1e-6, 1.0, 1e6}) {
    const float s = static_cast<float>(scale);
    const TriangleMesh quad({{-s, -s, 0}, {s, -s, 0}, {s, s, 0}, {-s, s, 0}}, {}, {}, {0, 1, 2, 0, 2, 3}, {}, false,
                            false);
    const AreaLight light(&quad, Color(1), false);
    EXPECT_NEAR(light.Area() / (4 * scale * scale), 1, 1e-6);
    double error;
    const double estimate = Irradiance(light, LightContext(Vec3(0, 0, s), Vec3(0, 0, -1), false), 20000, &error);
    // Four corners of the form factor of a rectangle seen from above its corner (Howell, C-11), with sides 1 and 1
    // at 1.
    const double truth = 4 * std::atan(1 / std::sqrt(2.0)) / std::sqrt(2.0);
    EXPECT_NEAR(estimate, truth, 5 * error + 1e-6) << scale;
  }
}

class Ramp final : public ColorTexture {
 public:
  Color Evaluate(const TextureContext& at) const override { return Color(at.uv.x, 2, at.uv.y * at.uv.y); }
};

class HalfHole final : public FloatTexture {
 public:
  float Evaluate(const TextureContext& at) const override { return at.uv.x < 0.5f ? 0.f : 1.f; }
};

TEST(AreaLight, TexturesAndHolesCountInThePower) {
  const BilinearMesh square({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {}, {}, {0, 1, 2, 3});
  const auto ramp = std::make_shared<Ramp>();
  const AreaLight whole(&square, ramp, false);
  EXPECT_NEAR(whole.Power().r / kPiD, 0.5, 1e-3);
  EXPECT_NEAR(whole.Power().g / kPiD, 2, 1e-5);
  EXPECT_NEAR(whole.Power().b / kPiD, 1.0 / 3, 1e-3);
  const AreaLight half(&square, ramp, true, std::make_shared<HalfHole>());
  EXPECT_NEAR(half.Power().r / kPiD, 2 * 0.375, 2e-3);
  RandomNumbers random(2);
  for (int i = 0; i < 1000; ++i) {
    const std::optional<LeSample> sample = half.Sample_Le(random.Le());
    if (sample) {
      ASSERT_GE(sample->ray.o.x, 0.499f);
    }
  }
}

class RampAlpha final : public FloatTexture {
 public:
  float Evaluate(const TextureContext& at) const override { return 1.5f * at.uv.x; }  // cut to 1 beyond 2/3
};

// Rays meet the light with probability alpha and then see all of its radiance; so what leaves it has the share alpha.
TEST(AreaLight, WhatLeavesTheLightHasItsAlpha) {
  const Sphere sphere(Transform::Translate({0, 0, 2}), false, 0.5);
  const BilinearMesh square({{0, 0, 2}, {0, 1, 2}, {1, 0, 2}, {1, 1, 2}}, {}, {}, {0, 1, 2, 3});  // u is y
  const auto L = std::make_shared<ConstantTexture<Color>>(Color(4));
  const AreaLight ball(&sphere, L, false, std::make_shared<ConstantTexture<float>>(0.25f));
  const AreaLight ramp(&square, L, true, std::make_shared<RampAlpha>());
  EXPECT_NEAR(ball.Power().g / (kPiD * ball.Area()), 0.25 * 4, 1e-5);
  EXPECT_NEAR(ramp.Power().g / (2 * kPiD), (1. / 3 + 1. / 3) * 4, 2e-3);
  for (const AreaLight* light : {&ball, &ramp}) {
    const Shape& shape = light == &ball ? static_cast<const Shape&>(sphere) : square;
    RandomNumbers random(3);
    Mean flux;
    for (int i = 0; i < 20000; ++i) {
      const std::optional<LeSample> sample = light->Sample_Le(random.Le());
      flux.Add(sample ? static_cast<double>(sample->Flux().g) : 0);
    }
    const double power = static_cast<double>(light->Power().g);
    EXPECT_NEAR(flux.Value(), power, 5 * flux.StandardError() + 1e-3 * power);
    for (int i = 0; i < 100; ++i) {
      const std::optional<LiSample> sample = light->Sample_Li(LightContext(Vec3(0)), random.Li());
      ASSERT_TRUE(sample);
      const std::optional<SurfaceInteraction> hit = FirstHit(shape, Ray{Vec3(0), sample->wi});
      if (!hit) continue;  // past the rim
      const float coverage = light == &ball ? 0.25f : std::min(1.f, 1.5f * hit->uv.x);
      EXPECT_NEAR(sample->L.g, 4 * coverage, 1e-4);
      EXPECT_EQ(light->L(*hit, -sample->wi), Color(4));
    }
  }
}

constexpr int kGridWidth = 400, kGridHeight = 250;  // 100,000 triangles

/// A right triangle in the corner of each cell of a grid, of random size.
TriangleMesh ScatteredTriangles(std::vector<double>* areas) {
  RandomNumbers random(6);
  std::vector<Vec3> p;
  std::vector<int> indices;
  for (int i = 0; i < kGridWidth * kGridHeight; ++i) {
    const Vec3 corner(static_cast<float>(i % kGridWidth), static_cast<float>(i / kGridWidth), 0);
    const float a = static_cast<float>(0.9 * random.Get1D()), b = static_cast<float>(0.9 * random.Get1D());
    for (const Vec3& offset : {Vec3(0.05f, 0.05f, 0), Vec3(0.05f + a, 0.05f, 0), Vec3(0.05f, 0.05f + b, 0)}) {
      indices.push_back(static_cast<int>(p.size()));
      p.push_back(corner + offset);
    }
    areas->push_back(static_cast<double>(a) * static_cast<double>(b) / 2);
  }
  return TriangleMesh(std::move(p), {}, {}, std::move(indices));
}

// Counts in all triangles against their areas; those that expect fewer than five rays are pooled.
TEST(AreaLight, TrianglesOfABigMeshAreChosenByArea) {
  std::vector<double> areas;
  const TriangleMesh mesh = ScatteredTriangles(&areas);
  const AreaLight light(&mesh, Color(2), false);
  double total = 0;
  for (const double area : areas) total += area;
  EXPECT_NEAR(light.Area() / total, 1, 1e-5);
  constexpr int kRays = 1'000'000;
  std::vector<double> observed(areas.size()), expected;
  RandomNumbers random(7);
  for (int i = 0; i < kRays; ++i) {
    const std::optional<LeSample> sample = light.Sample_Le(random.Le());
    ASSERT_TRUE(sample);
    const Vec3& o = sample->ray.o;
    observed[static_cast<size_t>(static_cast<int>(o.y) * kGridWidth + static_cast<int>(o.x))] += 1;
  }
  for (const double area : areas) expected.push_back(kRays * area / total);
  const testing::ChiSquare fit = testing::CompareCounts(expected, observed);
  EXPECT_TRUE(fit.Passes()) << fit.message;
}

/// Seconds for a ray, the best of several tries.
double SecondsPerRay(const AreaLight& light) {
  constexpr int kRays = 5'000;
  double best = 1;
  for (int attempt = 0; attempt < 20; ++attempt) {
    RandomNumbers random(8);
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < kRays; ++i) {
      if (!light.Sample_Le(random.Le())) ADD_FAILURE();
    }
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    best = std::min(best, seconds / kRays);
  }
  return best;
}

// A search through all triangles would cost ten thousand times as much as for ten; caches make it a few times.
TEST(AreaLight, ARayOfABigMeshCostsLittleMoreThanOfASmallOne) {
  std::vector<double> areas;
  const TriangleMesh big = ScatteredTriangles(&areas);
  const TriangleMesh small({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {}, {}, {0, 1, 2, 2, 1, 3});
  const double ofBig = SecondsPerRay(AreaLight(&big, Color(2), false));
  const double ofSmall = SecondsPerRay(AreaLight(&small, Color(2), false));
  RecordProperty("nanosecondsBig", static_cast<int>(ofBig * 1e9));
  RecordProperty("nanosecondsSmall", static_cast<int>(ofSmall * 1e9));
  EXPECT_LT(ofBig / ofSmall, 50);
}

TEST(AreaLight, DegenerateShapesEmitNothing) {
  const TriangleMesh line({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {}, {}, {0, 1, 2});
  const AreaLight light(&line, Color(1), true);
  EXPECT_TRUE(light.Power().IsBlack());
  EXPECT_FALSE(light.Sample_Le({}));
  EXPECT_FALSE(light.Sample_Li(LightContext(Vec3(0, 0, 1)), {}));
  EXPECT_EQ(light.ImportanceAt(LightContext(Vec3(0, 0, 1))), 0);
}

TEST(AreaLight, ShinesFromItsOutsideOnly) {
  const TriangleMesh triangle({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}, {}, {0, 1, 2});
  const AreaLight light(&triangle, Color(1), false);
  EXPECT_TRUE(light.Sample_Li(LightContext(Vec3(0.2f, 0.2f, 1)), {}));
  EXPECT_FALSE(light.Sample_Li(LightContext(Vec3(0.2f, 0.2f, -1)), {}));
  EXPECT_GT(light.ImportanceAt(LightContext(Vec3(0.2f, 0.2f, 1))), 0);
  EXPECT_EQ(light.ImportanceAt(LightContext(Vec3(0.2f, 0.2f, -1))), 0);
}

}  // namespace
}  // namespace dapple
