// Rays that leave a surface never meet it again: at all scales and places, grazing, from slivers, through instances.
#include <gtest/gtest.h>

#include "src/geometry/accelerator.h"
#include "src/geometry/bilinear_mesh.h"
#include "src/geometry/cylinder.h"
#include "src/geometry/disk.h"
#include "src/geometry/sphere.h"
#include "src/geometry/triangle_mesh.h"
#include "tests/geometry/shape_checks.h"

namespace dapple {
namespace {

/// A direction on either side of `n`, one in two of them grazing, down to the angles that float resolves.
Vec3 LeavingDirection(const Vec3& n, TestRandom* random) {
  if (random->Uniform() < 0.5) return ToFloat(random->Direction());
  Vec3d s, t;
  CoordinateSystem(ToDouble(n), &s, &t);
  const double phi = random->Uniform(0, 2 * kPiD), cosine = std::pow(10, random->Uniform(-8, -1));
  const double sign = random->Uniform() < 0.5 ? -1 : 1;
  return ToFloat(Normalize(s * std::cos(phi) + t * std::sin(phi) + ToDouble(n) * (sign * cosine)));
}

struct Tally {
  int64_t rays = 0, hits = 0;
};

/// Rays from a flat surface, met by rays from all around and by drawn points: any hit is wrong.
Tally LeaveFlatSurface(const Accelerator& accelerator, const Shape& shape, const Transform& groupToRender, int count,
                       TestRandom* random) {
  Tally tally;
  for (int i = 0; i < count; ++i) {
    const ShapeSample sample = shape.SampleArea(0, random->Square());
    const Vec3d target = groupToRender.Point(ToDouble(sample.p));
    const Vec3d corner = groupToRender.Point(ToDouble(shape.PrimitiveBounds(0).min));
    const double size = Distance(corner, groupToRender.Point(ToDouble(shape.PrimitiveBounds(0).max)));
    const Vec3d from = target + random->Direction() * (size * random->Uniform(0.1, 5));
    const Ray toSurface{ToFloat(from), ToFloat(Normalize(target - from)), kInfinity, {}};
    const auto found = accelerator.Intersect(toSurface);
    if (!found) continue;
    for (int j = 0; j < 8; ++j) {
      const Ray leaving = SpawnRay(*found, LeavingDirection(found->ng, random));
      ++tally.rays;
      const auto again = accelerator.Intersect(leaving);
      if (again || accelerator.Occluded(leaving)) ++tally.hits;
    }
  }
  return tally;
}

Tally LeaveFlatShape(const Shape& shape, int count, TestRandom* random) {
  const Accelerator accelerator({{&shape}}, {}, {});
  return LeaveFlatSurface(accelerator, shape, Transform(), count, random);
}

TEST(SelfIntersection, TrianglesOfAllSizesAndPlaces) {
  TestRandom random(1);
  Tally total;
  for (const double size : {1e-6, 1e-3, 1.0, 1e3, 1e6}) {
    for (const double offset : {0.0, 1.0, 1e4}) {
      for (int i = 0; i < 10; ++i) {
        const Vec3d centre = random.Direction() * (i % 2 == 0 ? offset * size : offset);
        std::vector<Vec3> p;
        for (int corner = 0; corner < 3; ++corner) p.push_back(ToFloat(centre + random.Box(-size, size)));
        const TriangleMesh mesh(p, {}, {}, {0, 1, 2});
        if (!(mesh.PrimitiveArea(0) > 0.01 * size * size)) continue;  // rounded away, or a sliver
        const Tally tally = LeaveFlatShape(mesh, 200, &random);
        EXPECT_EQ(tally.hits, 0) << "size " << size << " offset " << offset;
        total.rays += tally.rays;
      }
    }
  }
  EXPECT_GT(total.rays, 100000);
}

TEST(SelfIntersection, GroundPlanesMoveRaysByNextToNothing) {
  TestRandom random(2);
  const TriangleMesh ground({{-1000, -1000, 0}, {1000, -1000, 0}, {0, 1000, 0}}, {}, {}, {0, 1, 2});
  const TriangleMesh raised({{-1000, -1000, 3.7f}, {1000, -1000, 3.7f}, {0, 1000, 3.7f}}, {}, {}, {0, 1, 2});
  EXPECT_EQ(LeaveFlatShape(ground, 10000, &random).hits, 0);
  EXPECT_EQ(LeaveFlatShape(raised, 10000, &random).hits, 0);
  EXPECT_LT(ground.SampleArea(0, {0.3, 0.4}).pError, 1e-6f);
  EXPECT_LT(raised.SampleArea(0, {0.3, 0.4}).pError, 2e-6f);
}

TEST(SelfIntersection, SliversToOneInAThousand) {
  TestRandom random(3);
  Tally total;
  for (int i = 0; i < 60; ++i) {
    const Vec3d a = random.Box(-1, 1), along = random.Direction(), across = Normalize(Cross(along, random.Direction()));
    const double width = std::pow(10, random.Uniform(-3, -1));
    const Vec3d third = along * random.Uniform(0, 1) + across * width;  // both needles and flat ones
    const TriangleMesh mesh({ToFloat(a), ToFloat(a + along), ToFloat(a + third)}, {}, {}, {0, 1, 2});
    const Tally tally = LeaveFlatShape(mesh, 200, &random);
    total.rays += tally.rays;
    total.hits += tally.hits;
  }
  EXPECT_GT(total.rays, 20000);
  EXPECT_EQ(total.hits, 0);
}

TEST(SelfIntersection, DisksAndPatches) {
  TestRandom random(4);
  for (const double size : {1e-6, 1e-3, 1.0, 1e3, 1e6}) {
    for (const double offset : {0.0, 1e4}) {
      const Transform place = Transform::Translate(random.Direction() * offset) *
                              Transform::Rotate(random.Uniform(0, 360), random.Direction()) *
                              Transform::Scale(Vec3d(size));
      if (size < 1e-2 && offset > 0) continue;  // smaller than a float can say there
      EXPECT_EQ(LeaveFlatShape(Disk(place, false, 0.5, 1, 0, 360), 1000, &random).hits, 0) << size << " " << offset;
      std::vector<Vec3> p;
      for (const Vec3d& corner : {Vec3d(0, 0, 0), Vec3d(1, 0, 0), Vec3d(0, 1, 0), Vec3d(1, 1, 0)})
        p.push_back(ToFloat(place.Point(corner)));
      // Rounding the corners of a turned rectangle bends it: a grazing ray may truly meet it again.
      const BilinearMesh flat({{0, 0, p[0].z}, {p[1].x, 0, p[0].z}, {0, p[2].y, p[0].z}, {p[1].x, p[2].y, p[0].z}}, {},
                              {}, {0, 1, 2, 3});
      EXPECT_EQ(LeaveFlatShape(flat, 1000, &random).hits, 0) << size << " " << offset;
    }
  }
}

TEST(SelfIntersection, SpheresOutsideAndInside) {
  TestRandom random(5);
  for (const double radius : {1e-6, 1e-3, 1.0, 1e3, 1e6}) {
    for (const double offset : {0.0, 1e4}) {
      if (radius < 1e-2 && offset > 0) continue;
      const Vec3d centre = random.Direction() * offset;
      const Sphere sphere(Transform::Translate(centre), false, radius);
      const Accelerator accelerator({{&sphere}}, {}, {});
      for (int i = 0; i < 3000; ++i) {
        const Vec3d from = centre + random.Direction() * (radius * 3);
        const Vec3d to = centre + random.Direction() * (radius * random.Uniform(0, 0.9999));
        const auto found = accelerator.Intersect({ToFloat(from), ToFloat(Normalize(to - from)), kInfinity, {}});
        ASSERT_TRUE(found);
        const Vec3 w = LeavingDirection(found->ng, &random);
        const Ray leaving = SpawnRay(*found, w);
        const auto again = accelerator.Intersect(leaving);
        const double cosine = Dot(w, found->ng);
        if (cosine > 0) {
          ASSERT_FALSE(again) << radius << " " << offset << " " << cosine;
        }
        // Inside, the far end of the chord, as far as float can place both.
        if (cosine < 0) {
          ASSERT_TRUE(again);
        }
        const double slack = 1e-5 * radius + 4 * found->pError;
        if (cosine < -1e-2) {
          ASSERT_NEAR(again->t, -2 * radius * cosine, slack - slack / cosine) << radius << " " << offset;
        }
      }
    }
  }
}

TEST(SelfIntersection, CylindersAlongAndAcross) {
  TestRandom random(6);
  for (const double size : {1e-3, 1.0, 1e3}) {
    const Transform place = Transform::Translate(random.Direction() * (2 * size)) *
                            Transform::Rotate(random.Uniform(0, 360), random.Direction()) *
                            Transform::Scale(Vec3d(size));
    const Cylinder cylinder(place, false, 1, -3, 3, 360);
    const Accelerator accelerator({{&cylinder}}, {}, {});
    for (int i = 0; i < 5000; ++i) {
      const ShapeSample sample = cylinder.SampleArea(0, random.Square());
      const Vec3 from = sample.p + sample.n * static_cast<float>(size);
      const auto found = accelerator.Intersect({from, -sample.n, kInfinity, {}});
      if (!found) continue;
      Vec3 w = LeavingDirection(found->ng, &random);
      if (Dot(w, found->ng) < 0) w = -w;
      ASSERT_FALSE(accelerator.Intersect(SpawnRay(*found, w))) << size;
      // Along the axis, the straight direction on the surface.
      const Vec3 axis = ToFloat(Normalize(place.Vector({0, 0, 1})));
      if (Dot(axis, found->ng) >= 0) {
        ASSERT_FALSE(accelerator.Intersect(SpawnRay(*found, axis)));
      }
    }
  }
}

TEST(SelfIntersection, InstancesTurnedScaledAndFarAway) {
  TestRandom random(7);
  Tally total;
  for (int i = 0; i < 60; ++i) {
    const double size = std::pow(10, random.Uniform(-2, 3)), scale = std::pow(10, random.Uniform(-3, 3));
    std::vector<Vec3> p;
    const Vec3d centre = random.Box(-3 * size, 3 * size);
    for (int corner = 0; corner < 3; ++corner) p.push_back(ToFloat(centre + random.Box(-size, size)));
    const TriangleMesh mesh(p, {}, {}, {0, 1, 2});
    if (!(mesh.PrimitiveArea(0) > 0.03 * size * size)) continue;
    const double offset = i % 3 == 0 ? 0 : i % 3 == 1 ? size * scale * 10 : size * scale * 1e4;
    const Transform place = Transform::Translate(random.Direction() * offset) *
                            Transform::Rotate(random.Uniform(0, 360), random.Direction()) *
                            Transform::Scale(Vec3d(scale, scale * random.Uniform(0.2, 5), i % 2 ? -scale : scale));
    const Accelerator accelerator({{&mesh}}, {{{0}}}, {{0, place}});
    const Tally tally = LeaveFlatSurface(accelerator, mesh, place, 300, &random);
    EXPECT_EQ(tally.hits, 0) << "of " << tally.rays << ": size " << size << " scale " << scale << " offset " << offset;
    total.rays += tally.rays;
  }
  EXPECT_GT(total.rays, 50000);
}

}  // namespace
}  // namespace dapple
