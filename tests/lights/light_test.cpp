// What is true of every light.
#include "lights/light.h"

#include <gtest/gtest.h>

#include "src/base/frame.h"
#include "src/base/numerics.h"
#include "src/sampling/warps.h"
#include "tests/lights/light_checks.h"

namespace dapple {
namespace {

TEST(EveryLight, DensitiesOfARayAreThoseItWasDrawnWith) {
  for (const LightCase& c : AllLights()) {
    RandomNumbers random(12);
    const bool isEllipsoidal = c.name.find("ellipsoid") == 0 || c.name.find("bilinear") == 0;
    for (int i = 0; i < 2000; ++i) {
      const std::optional<LeSample> sample = c.light->Sample_Le(random.Le());
      if (!sample) continue;
      ASSERT_GT(sample->pdfPos, 0) << c.name;
      ASSERT_GT(sample->pdfDir, 0) << c.name;
      const LePdf pdf = c.light->Pdf_Le(sample->ray, sample->From());
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
      const LeRandom back = c.light->Invert_Le(sample->ray, sample->From());
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
      ASSERT_EQ(c.light->Pdf_Le(later, sample->From()).position, sample->pdfPos) << c.name;
      const Vec3 aside = Frame::FromZ(sample->ray.d).s * (2.1f * kTestExtent.radius);
      ASSERT_EQ(c.light->Pdf_Le(Ray{sample->ray.o + aside, sample->ray.d}, sample->From()).position, 0) << c.name;
      ASSERT_FALSE(c.light->IsInfinite() && c.light->Le(Ray{Vec3(0), -sample->ray.d}) != sample->Le) << c.name;
    }
  }
}

TEST(EveryLight, DensityOfADirectionIsThatItWasDrawnWith) {
  for (const LightCase& c : AllLights()) {
    if (c.light->IsDelta()) continue;
    for (const LightContext& at : TestContexts()) {
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
    for (const LightContext& at : TestContexts()) {
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
