// What is true of every light.
#include "lights/light.h"

#include <gtest/gtest.h>

#include "src/base/frame.h"
#include "src/base/numerics.h"
#include "src/sampling/warps.h"
#include "tests/lights/light_cases.h"
#include "tests/support/chi_square.h"

namespace dapple {
namespace {

constexpr int kComponent = 1;  // green stands for all in statistics

// 5 standard errors, and what float arithmetic may add. With about a hundred comparisons a false alarm has a
// probability below 1e-4, and the seeds are fixed.
double Margin(double standardError, double value) { return 5 * standardError + 2e-5 * std::abs(value); }

TEST(EveryLight, MeanFluxOfItsRaysIsItsPower) {
  for (const LightCase& c : AllLights()) {
    RandomNumbers random(11);
    Mean flux;
    for (int i = 0; i < 20000; ++i) {
      const std::optional<LeSample> sample = c.light->Sample_Le(random.Le());
      flux.Add(sample ? static_cast<double>(sample->Flux()[kComponent]) : 0);
      if (sample) {
        ASSERT_TRUE(sample->Flux().IsFinite());
      }
    }
    const double power = static_cast<double>(c.light->Power()[kComponent]);
    EXPECT_GT(power, 0) << c.name;
    // The mean of a texture is taken over points: its own error.
    const double quadrature = c.name.find("textured") != std::string::npos ? 2e-3 * power : 0;
    EXPECT_NEAR(flux.Value(), power, Margin(flux.StandardError(), power) + quadrature) << c.name;
  }
}

TEST(EveryLight, DensitiesOfARayAreThoseItWasDrawnWith) {
  for (const LightCase& c : AllLights()) {
    RandomNumbers random(12);
    const bool isEllipsoidal = c.name == "ellipsoid" || c.name.find("bilinear") == 0;
    for (int i = 0; i < 2000; ++i) {
      const std::optional<LeSample> sample = c.light->Sample_Le(random.Le());
      if (!sample) continue;
      ASSERT_GT(sample->pdfPos, 0) << c.name;
      ASSERT_GT(sample->pdfDir, 0) << c.name;
      const LePdf pdf = c.light->Pdf_Le(sample->ray, sample->n);
      ASSERT_EQ(pdf.direction, sample->pdfDir) << c.name;
      // Where the density varies over the surface it is taken at the ray's origin, which lies off it.
      ASSERT_NEAR(pdf.position / sample->pdfPos, 1, isEllipsoidal ? 1e-4 : 0) << c.name;
      ASSERT_NEAR(Length(sample->ray.d), 1, 1e-6) << c.name;
    }
  }
}

TEST(EveryLight, RandomNumbersOfARayAreFoundAgain) {
  for (const LightCase& c : AllLights()) {
    RandomNumbers random(13);
    // Float rounding of the ray, magnified where the map from numbers to rays is flat.
    const double tolerance = c.name.find("spot 0.01") == 0 ? 2e-3 : (c.shape ? 3e-3 : 2e-4);
    for (int i = 0; i < 500; ++i) {
      const LeRandom u = random.Le();
      const std::optional<LeSample> sample = c.light->Sample_Le(u);
      if (!sample) continue;
      const LeRandom back = c.light->Invert_Le(sample->ray, sample->n);
      if (!sample->deltaPos) {
        ASSERT_NEAR(back.position.x, u.position.x, tolerance) << c.name;
        ASSERT_NEAR(back.position.y, u.position.y, tolerance) << c.name;
      }
      if (!sample->deltaDir) {
        ASSERT_NEAR(back.direction.x, u.direction.x, tolerance) << c.name;
        ASSERT_NEAR(back.direction.y, u.direction.y, tolerance) << c.name;
      }
      // The part of the light: the same numbers draw the same ray.
      const std::optional<LeSample> again = c.light->Sample_Le(back);
      ASSERT_TRUE(again) << c.name;
      ASSERT_LT(Distance(again->ray.o, sample->ray.o), 0.02f) << c.name;
      ASSERT_LT(Distance(again->ray.d, sample->ray.d), 0.02f) << c.name;
    }
  }
}

TEST(EveryLight, RaysFromAreaLightsLeaveTheirSurfaceAndAreOfItsRadiance) {
  for (const LightCase& c : AllLights()) {
    if (!c.shape) continue;
    RandomNumbers random(14);
    for (int i = 0; i < 500; ++i) {
      const std::optional<LeSample> sample = c.light->Sample_Le(random.Le());
      if (!sample) continue;
      // Back along the ray lies the surface that it came from.
      const std::optional<SurfaceInteraction> hit = FirstHit(*c.shape, Ray{sample->ray(1e-3f), -sample->ray.d});
      if (sample->cosTheta < 0.05f) continue;
      ASSERT_TRUE(hit) << c.name;
      ASSERT_NEAR(hit->t, 1e-3f, 1e-4f) << c.name;
      ASSERT_GT(Dot(hit->ng, sample->n), 0.999f) << c.name;
      if (c.name.find("textured") == std::string::npos) {
        ASSERT_EQ(c.light->L(*hit, sample->ray.d), sample->Le);
      }
    }
  }
}

TEST(EveryLight, RaysFromInfinityHaveAllOfTheSceneAhead) {
  for (const LightCase& c : AllLights()) {
    if (c.shape) continue;
    RandomNumbers random(15);
    for (int i = 0; i < 500; ++i) {
      const std::optional<LeSample> sample = c.light->Sample_Le(random.Le());
      if (!sample || sample->deltaPos) continue;
      const Vec3 inScene = kTestExtent.center + ToFloat(SampleSphere(random.Get2D())) *
                                                    (kTestExtent.radius * static_cast<float>(random.Get1D()));
      ASSERT_GT(Dot(inScene - sample->ray.o, sample->ray.d), 0) << c.name;
      ASSERT_LT(Length(Cross(kTestExtent.center - sample->ray.o, sample->ray.d)), kTestExtent.radius * 1.00001f);
      // Any point of the line has the density of the ray; lines that miss the scene have none.
      const Ray later{sample->ray(2.5f), sample->ray.d};
      ASSERT_EQ(c.light->Pdf_Le(later, sample->n).position, sample->pdfPos) << c.name;
      const Vec3 aside = Frame::FromZ(sample->ray.d).s * (2.1f * kTestExtent.radius);
      ASSERT_EQ(c.light->Pdf_Le(Ray{sample->ray.o + aside, sample->ray.d}, sample->n).position, 0) << c.name;
      ASSERT_FALSE(c.light->IsInfinite() && c.light->Le(Ray{Vec3(0), -sample->ray.d}) != sample->Le) << c.name;
    }
  }
}

// Points that see the lights from near, from far, from behind and edge-on.
std::vector<LightContext> Contexts() {
  return {LightContext({0, 0, 0}), LightContext({0.1f, 0.2f, 0}, {0, 0, 1}, false), LightContext({0.6f, 0.3f, 1.9f}),
          LightContext({0.2f, 0.2f, 3.5f}, {0, 0, -1}, true),
          LightContext({-3, 1, 1.75f}, Normalize(Vec3(1, 0, 0.5f)), false)};
}

TEST(EveryLight, DensityOfADirectionIsThatItWasDrawnWith) {
  for (const LightCase& c : AllLights()) {
    if (c.light->IsDelta()) continue;
    for (const LightContext& at : Contexts()) {
      RandomNumbers random(16);
      int missed = 0;
      for (int i = 0; i < 300; ++i) {
        const std::optional<LiSample> sample = c.light->Sample_Li(at, random.Li());
        if (!sample) continue;
        ASSERT_GT(sample->pdf, 0) << c.name;
        ASSERT_NEAR(Length(sample->wi), 1, 1e-6) << c.name;
        if (!c.shape) {
          ASSERT_EQ(c.light->Pdf_Li(at, sample->wi, nullptr), sample->pdf) << c.name;
          ASSERT_EQ(c.light->Le(Ray{at.p, sample->wi}), sample->L) << c.name;
          ASSERT_GE(Distance(sample->p, kTestExtent.center), kTestExtent.radius);
          continue;
        }
        // The ray may meet another part of the same shape first, or pass its rim.
        const std::optional<SurfaceInteraction> hit = FirstHit(*c.shape, Ray{at.p, sample->wi});
        if (!hit || Distance(hit->p, sample->p) > 1e-3f) {
          ++missed;
          continue;
        }
        const double cosTheta = AbsDot(ToDouble(sample->n), ToDouble(sample->wi));
        if (cosTheta < 0.02) continue;
        ASSERT_NEAR(c.light->Pdf_Li(at, sample->wi, &*hit) / sample->pdf, 1, 2e-3) << c.name;
        if (c.name.find("textured") == std::string::npos) {
          ASSERT_EQ(c.light->L(*hit, -sample->wi), sample->L) << c.name;
        }
      }
      if (c.name == "sphere" || c.name == "disk") {
        EXPECT_LE(missed, 3) << c.name;
      }
    }
  }
}

TEST(EveryLight, RandomNumbersOfADirectionAreFoundAgain) {
  for (const LightCase& c : AllLights()) {
    if (c.light->IsDelta()) continue;
    for (const LightContext& at : Contexts()) {
      RandomNumbers random(17);
      for (int i = 0; i < 100; ++i) {
        const LiRandom u = random.Li();
        const std::optional<LiSample> sample = c.light->Sample_Li(at, u);
        if (!sample) continue;
        std::optional<SurfaceInteraction> hit;
        if (c.shape) {
          hit = FirstHit(*c.shape, Ray{at.p, sample->wi});
          if (!hit || Distance(hit->p, sample->p) > 1e-3f || AbsDot(sample->n, sample->wi) < 0.02f) continue;
        }
        const LiRandom back = c.light->Invert_Li(at, sample->wi, hit ? &*hit : nullptr);
        // Some shapes are seen by area from some points, which float directions resolve less well.
        const double tolerance = c.shape ? 1e-2 : 1e-4;
        ASSERT_NEAR(back.direction.x, u.direction.x, tolerance) << c.name;
        ASSERT_NEAR(back.direction.y, u.direction.y, tolerance) << c.name;
        const std::optional<LiSample> again = c.light->Sample_Li(at, back);
        ASSERT_TRUE(again) << c.name;
        ASSERT_LT(Distance(again->wi, sample->wi), 0.02f) << c.name;
      }
    }
  }
}

// Shapes sampled by area have a density that is not bounded toward their silhouette, where no statistic holds.
constexpr float kLeastCosine = 0.1f;

// All places of the shape along a ray that shine back along it, each with the density that `Sample_Li` has there.
double DensityThroughShape(const LightCase& c, const LightContext& at, const Vec3& wi) {
  double density = 0;
  const Ray ray{at.p, wi};
  for (int i = 0; i < c.shape->PrimitiveCount(); ++i) {
    const PrimitiveHits hits = c.shape->IntersectAll(ray, i);
    for (int j = 0; j < hits.count; ++j) {
      PrimitiveHit place = hits.hits[j];
      place.primitive = i;
      SurfaceInteraction hit = c.shape->Interact(ray, place);
      hit.primitive = i;
      if (AbsDot(hit.ng, wi) > kLeastCosine && !c.light->L(hit, -wi).IsBlack())
        density += c.light->Pdf_Li(at, wi, &hit);
    }
  }
  return density;
}

// The cone around all of the shape as seen from a point, cut into cells of equal solid angle.
class ConeOfShape {
 public:
  ConeOfShape(const Shape& shape, const Vec3& p) {
    Bounds3 bounds;
    for (int i = 0; i < shape.PrimitiveCount(); ++i) bounds.extendBy(shape.PrimitiveBounds(i));
    const double radius = static_cast<double>(Length(bounds.size())) / 2;
    const double distance = static_cast<double>(Distance(bounds.center(), p));
    oneMinusCosMax_ = radius < distance ? OneMinusSqrtOneMinus(Sqr(radius / distance)) : 2;
    frame_ = Frame::FromZ(Normalize(bounds.center() - p));
  }

  Vec3 Sample(const Vec2d& u) const { return frame_.ToWorld(ToFloat(SampleCone(u, oneMinusCosMax_))); }
  double Pdf() const { return ConePdf(oneMinusCosMax_); }
  size_t CellOf(const Vec3& w) const {
    const Vec2d u = InvertCone(ToDouble(frame_.ToLocal(w)), oneMinusCosMax_);
    const int row = std::min(static_cast<int>(u.x * kRows), kRows - 1);
    return static_cast<size_t>(row * kColumns + std::min(static_cast<int>(u.y * kColumns), kColumns - 1));
  }

  static constexpr int kRows = 8, kColumns = 12;

 private:
  Frame frame_;
  double oneMinusCosMax_;
};

// The probability that drawn directions and the density (integrated by uniform directions, for it has sharp borders
// that a grid of points misses) differ so much by chance.
double CompareWithDensity(const LightCase& c, const LightContext& at) {
  constexpr int kSamples = 2000, kRaysPerSample = 8;
  constexpr size_t kCells = ConeOfShape::kRows * ConeOfShape::kColumns;
  const ConeOfShape cone(*c.shape, at.p);
  RandomNumbers random(21);
  std::vector<double> difference(kCells), variance(kCells);
  for (int i = 0; i < kSamples; ++i) {
    const std::optional<LiSample> drawn = c.light->Sample_Li(at, random.Li());
    if (drawn && AbsDot(drawn->n, drawn->wi) > kLeastCosine) {
      const size_t cell = cone.CellOf(drawn->wi);
      difference[cell] += 1;
      variance[cell] += 1;
    }
    for (int j = 0; j < kRaysPerSample; ++j) {
      const Vec3 w = cone.Sample(random.Get2D());
      const double expected = DensityThroughShape(c, at, w) / (cone.Pdf() * kRaysPerSample);
      difference[cone.CellOf(w)] -= expected;
      variance[cone.CellOf(w)] += Sqr(expected);
    }
  }
  double statistic = 0, pooledDifference = 0, pooledVariance = 0;
  int cells = 0;
  for (size_t i = 0; i < kCells; ++i) {
    pooledDifference += difference[i];
    pooledVariance += variance[i];
    if (pooledVariance < 40) continue;
    statistic += Sqr(pooledDifference) / pooledVariance;
    ++cells;
    pooledDifference = pooledVariance = 0;
  }
  return cells > 0 ? testing::ChiSquareTail(statistic, cells) : 1;
}

TEST(EveryLight, DirectionsToShapesFollowTheirDensity) {
  const std::vector<LightCase> lights = AllLights();
  const std::vector<LightContext> contexts = Contexts();
  const double level = testing::SidakLevel(0.01, static_cast<int>(lights.size() * contexts.size()));
  for (const LightCase& c : lights) {
    if (!c.shape) continue;
    for (const LightContext& at : contexts) {
      EXPECT_GT(CompareWithDensity(c, at), level) << c.name << " from " << at.p;
    }
  }
}

TEST(EveryLight, DirectionsToTheEnvironmentFollowTheirDensity) {
  constexpr int kTests = 5;
  for (const LightCase& c : AllLights()) {
    if (!c.light->IsInfinite()) continue;
    for (const LightContext& at : {LightContext(Vec3(0)), LightContext(Vec3(0), Vec3(0.6f, 0, 0.8f), false)}) {
      const auto sample = [&](double part, const Vec2d& u) -> std::optional<Vec3> {
        const std::optional<LiSample> drawn = c.light->Sample_Li(at, {part, u});
        return drawn ? std::optional(drawn->wi) : std::nullopt;
      };
      if (LengthSquared(at.n) > 0 && c.name != "uniform environment") continue;  // maps do not ask for it
      const auto pdf = [&](const Vec3& wi) { return c.light->Pdf_Li(at, wi, nullptr); };
      const testing::ChiSquare fit =
          testing::ChiSquareOnSphere(sample, pdf, {.samples = 10000, .rows = 6, .columns = 8, .seed = 5});
      EXPECT_GT(fit.pValue, testing::SidakLevel(0.01, kTests)) << c.name << ": " << fit.message;
    }
  }
}

// A disk of the scene that receives light on its upper side.
struct Patch {
  Vec3 center;
  Frame frame;
  float radius;
};

constexpr int kPatchSamples = 12000;

double FluxByRays(const LightCase& c, const Patch& patch, double* error) {
  RandomNumbers random(18);
  Mean flux;
  for (int i = 0; i < kPatchSamples; ++i) {
    const std::optional<LeSample> sample = c.light->Sample_Le(random.Le());
    double received = 0;
    if (sample && Dot(sample->ray.d, patch.frame.n) < 0) {
      const float t = Dot(patch.center - sample->ray.o, patch.frame.n) / Dot(sample->ray.d, patch.frame.n);
      const bool hits = t > 0 && Distance(sample->ray(t), patch.center) < patch.radius;
      // Convex or not: the light's own shape may stand in the way.
      const bool isOpen = !c.shape || !FirstHit(*c.shape, Ray{sample->ray.o, sample->ray.d, t});
      if (hits && isOpen) received = static_cast<double>(sample->Flux()[kComponent]);
    }
    flux.Add(received);
  }
  *error = flux.StandardError();
  return flux.Value();
}

double FluxByDirections(const LightCase& c, const Patch& patch, double* error) {
  RandomNumbers random(19);
  Mean flux;
  const double area = kPiD * Sqr(static_cast<double>(patch.radius));
  for (int i = 0; i < kPatchSamples; ++i) {
    const Vec2d d = SampleDiskConcentric(random.Get2D()) * static_cast<double>(patch.radius);
    const Vec3 p = patch.center + patch.frame.s * static_cast<float>(d.x) + patch.frame.t * static_cast<float>(d.y);
    const LightContext at(p, patch.frame.n, false);
    const std::optional<LiSample> sample = c.light->Sample_Li(at, random.Li());
    double irradiance = 0;
    if (sample) {
      const double cosTheta = std::max(0.0, Dot(ToDouble(sample->wi), ToDouble(patch.frame.n)));
      const bool isOpen = !c.shape || !FirstHit(*c.shape, Ray{p, sample->wi, Distance(p, sample->p) * 0.999f});
      if (isOpen) irradiance = static_cast<double>(sample->L[kComponent]) * cosTheta / sample->pdf;
    }
    flux.Add(irradiance * area);
  }
  *error = flux.StandardError();
  return flux.Value();
}

TEST(EveryLight, BothSidesGiveTheSameLightOnAPatch) {
  const Patch patches[] = {{Vec3(0.25f, 0, 0), Frame::FromZ(Normalize(Vec3(0.1f, 0, 1))), 1.5f},
                           {Vec3(0.5f, 0, 3.25f), Frame::FromZ(Normalize(Vec3(0, 0.2f, -1))), 1.f}};
  for (const LightCase& c : AllLights()) {
    if (c.name.find("spot 0.01") == 0) continue;  // lights too little of the patch for this statistic
    for (const Patch& patch : patches) {
      double errorByRays, errorByDirections;
      const double byRays = FluxByRays(c, patch, &errorByRays);
      const double byDirections = FluxByDirections(c, patch, &errorByDirections);
      EXPECT_NEAR(byRays, byDirections, Margin(std::hypot(errorByRays, errorByDirections), byRays)) << c.name;
    }
  }
}

// As LightContext has it: what comes from behind an opaque surface does not.
bool Counts(const LightContext& at, const Vec3& wi) {
  return at.transmissive || LengthSquared(at.n) == 0 || Dot(at.n, wi) > 0;
}

TEST(EveryLight, NoImportanceMeansNoLightThatCounts) {
  for (const LightCase& c : AllLights()) {
    RandomNumbers random(20);
    for (int i = 0; i < 300; ++i) {
      const Vec3 p = kTestExtent.center + ToFloat(SampleSphere(random.Get2D())) *
                                              (kTestExtent.radius * static_cast<float>(std::cbrt(random.Get1D())));
      const Vec3 n = ToFloat(SampleSphere(random.Get2D()));
      const LightContext at = i % 4 == 1 ? LightContext(p) : LightContext(p, n, i % 4 == 0);
      const double importance = c.light->ImportanceAt(at);
      ASSERT_TRUE(std::isfinite(importance) && importance >= 0) << c.name;
      if (importance > 0) continue;
      for (int j = 0; j < 50; ++j) {
        const std::optional<LiSample> sample = c.light->Sample_Li(at, random.Li());
        ASSERT_FALSE(sample && Counts(at, sample->wi)) << c.name;
      }
    }
  }
}

}  // namespace
}  // namespace dapple
