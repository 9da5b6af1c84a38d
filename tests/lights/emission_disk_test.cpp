#include "lights/emission_disk.h"

#include <gtest/gtest.h>

#include "src/base/numerics.h"
#include "src/sampling/warps.h"
#include "tests/lights/light_cases.h"

namespace dapple {
namespace {

TEST(EmissionDisk, CoversTheScene) {
  RandomNumbers random(1);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 w = ToFloat(SampleSphere(random.Get2D()));
    const EmissionDisk disk(kTestExtent, w);
    EXPECT_NEAR(disk.area, kPiD * 16, 1e-9);
    // The scene's outline as seen along w: its light passes through the rim of the disk.
    const Frame across = Frame::FromZ(w);
    const float phi = static_cast<float>(random.Get1D()) * 2 * kPi;
    const Vec3 rim = kTestExtent.center + (across.s * std::cos(phi) + across.t * std::sin(phi)) * kTestExtent.radius;
    ASSERT_EQ(disk.Pdf(rim), 1 / disk.area);
    ASSERT_EQ(disk.Pdf(kTestExtent.center + (rim - kTestExtent.center) * 1.001f), 0);
    ASSERT_GT(Dot(disk.center - kTestExtent.center, w), kTestExtent.radius);
  }
}

TEST(EmissionDisk, DrawAndInverseAgree) {
  RandomNumbers random(2);
  const Vec3 w = Normalize(Vec3(1, -2, 3));
  // Near the origin, far from it, tiny and huge.
  for (const SceneExtent& extent :
       {kTestExtent, SceneExtent{Vec3(100, 0, 0), 1}, SceneExtent{Vec3(0), 1e-6f}, SceneExtent{Vec3(1e5f), 1e6f}}) {
    const EmissionDisk disk(extent, w);
    for (int i = 0; i < 1000; ++i) {
      const Vec2d u = random.Get2D();
      const Vec3 p = disk.Sample(u);
      const double tolerance = 1e-5 * (1 + static_cast<double>(Length(extent.center) / extent.radius));
      ASSERT_EQ(disk.Pdf(p), 1 / disk.area);
      ASSERT_NEAR(disk.Invert(p).x, u.x, tolerance);
      ASSERT_NEAR(disk.Invert(p).y, u.y, tolerance);
      ASSERT_NEAR(disk.Invert(p - w * extent.radius).x, u.x, tolerance);
    }
    EXPECT_EQ(disk.Pdf(disk.Sample({0, 0})), 1 / disk.area);
    EXPECT_EQ(disk.Pdf(disk.Sample({1 - 0x1p-53, 0.5})), 1 / disk.area);
  }
}

}  // namespace
}  // namespace dapple
