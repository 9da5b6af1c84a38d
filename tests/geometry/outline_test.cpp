// Circles around what is seen of a scene from any side.
#include "src/geometry/outline.h"

#include <gtest/gtest.h>

#include "src/base/frame.h"
#include "src/base/numerics.h"
#include "src/geometry/bilinear_mesh.h"
#include "src/geometry/cylinder.h"
#include "src/geometry/disk.h"
#include "src/geometry/smallest_circle.h"
#include "src/geometry/sphere.h"
#include "src/geometry/triangle_mesh.h"
#include "tests/geometry/shape_checks.h"

namespace dapple {
namespace {

double Reach(const Vec2d& center, const std::vector<Vec2d>& points) {
  double reach = 0;
  for (const Vec2d& p : points) reach = std::max(reach, (p - center).length());
  return reach;
}

TEST(SmallestCircle, HoldsAllPointsAndNoOtherCentreDoesBetter) {
  TestRandom random(1);
  for (int round = 0; round < 300; ++round) {
    std::vector<Vec2d> points;
    const int count = 1 + round % 40;
    const double flatness = round % 3 == 0 ? 1e-9 : 1;
    for (int i = 0; i < count; ++i) {
      const Vec3d p = random.Box(-1, 1);
      points.emplace_back(p.x + 100, p.y * flatness);
    }
    const Circle circle = SmallestCircle(points);
    ASSERT_NEAR(Reach(circle.center, points), circle.radius, 1e-11);
    // The reach of a centre is convex: a local minimum is the global one.
    for (int i = 0; i < 16; ++i) {
      const Vec2d step = Vec2d(std::cos(i * kPiD / 8), std::sin(i * kPiD / 8)) * 1e-4;
      ASSERT_GT(Reach(circle.center + step, points), circle.radius - 1e-11) << round;
    }
  }
}

TEST(SmallestCircle, OfPointsInLineOrInOnePlace) {
  const std::vector<Vec2d> line = {{0, 0}, {1, 1}, {3, 3}, {2, 2}};
  EXPECT_NEAR(SmallestCircle(line).radius, 1.5 * std::sqrt(2), 1e-14);
  const std::vector<Vec2d> place(5, Vec2d(1e7, -3));
  EXPECT_EQ(SmallestCircle(place).radius, 0);
}

TEST(BallTree, FindsTheFarthest) {
  TestRandom random(2);
  std::vector<HullBall> balls;
  for (int i = 0; i < 1000; ++i)
    balls.push_back({ToFloat(random.Box(-1, 1)), i % 2 == 0 ? 0 : 0.1f * static_cast<float>(random.Uniform())});
  const BallTree tree(balls);
  for (int i = 0; i < 100; ++i) {
    const Vec3d w = random.Direction();
    const auto reach = [&](const HullBall& ball) {
      return Dot(ToDouble(ball.center), w) + static_cast<double>(ball.radius);
    };
    double farthest = -10, expected = -10;
    int place = -1;
    tree.Search(reach, &farthest, [&](const HullBall& ball, int index, double distance) {
      EXPECT_EQ(ball.center, balls[static_cast<size_t>(index)].center);
      farthest = distance, place = index;
    });
    for (const HullBall& ball : balls) expected = std::max(expected, reach(ball));
    ASSERT_EQ(farthest, expected);
    ASSERT_EQ(reach(balls[static_cast<size_t>(place)]), expected);
  }
}

TriangleMesh Cloud(int points, uint64_t seed) {
  TestRandom random(seed);
  std::vector<Vec3> p;
  std::vector<int> indices;
  for (int i = 0; i < points; ++i) p.push_back(ToFloat(random.Box(-1, 1) * Vec3d(1, 2, 0.5)));
  for (int i = 0; i + 2 < points; ++i) indices.insert(indices.end(), {i, i + 1, i + 2});
  // A vertex of no triangle cannot be hit.
  p.emplace_back(50.f, 0.f, 0.f);
  return {p, {}, {}, indices};
}

TEST(Outline, CylindersOfMeshesAreSmallestCircles) {
  const TriangleMesh mesh = Cloud(500, 3);
  const Outline outline(std::vector<GeometryEntry>{{&mesh}}, {}, {});
  TestRandom random(4);
  for (int i = 0; i < 100; ++i) {
    const Vec3d w = i < 3 ? Vec3d(i == 0, i == 1, i == 2) : random.Direction();
    Vec3d s(0), t(0);
    CoordinateSystem(w, &s, &t);
    std::vector<Vec2d> seen;
    for (int vertex = 0; vertex < 500; ++vertex) {
      const Vec3d p = ToDouble(mesh.Position(vertex));
      seen.emplace_back(Dot(p, s), Dot(p, t));
    }
    const EnclosingCylinder cylinder = outline.CylinderAlong(w, 1e-6);
    ASSERT_GE(cylinder.radius, Reach({Dot(cylinder.center, s), Dot(cylinder.center, t)}, seen) - 1e-14);
    ASSERT_NEAR(cylinder.radius / SmallestCircle(seen).radius, 1, 1.001e-6);
    ASSERT_NEAR(outline.CylinderAlong(w, 1e-2).radius / SmallestCircle(seen).radius, 1, 1.001e-2);
  }
}

// Every shape, also cut and flattened: points of the surface lie inside, and from each side the circle is little larger
// than that of many of them.
TEST(Outline, CylindersOfShapesAreCloseAround) {
  const Transform place = Transform::Translate({1, -2, 3}) * Transform::Rotate(40, {1, 2, 3});
  const Transform flat = place * Transform::Scale({1, 0.5, 0.1});
  std::vector<std::unique_ptr<Shape>> shapes;
  shapes.push_back(std::make_unique<Sphere>(place, false, 1.5));
  shapes.push_back(std::make_unique<Sphere>(flat, false, 1.5));
  shapes.push_back(std::make_unique<Sphere>(flat, false, 1.5, -0.5, 1.2, 200));
  shapes.push_back(std::make_unique<Disk>(place, false, 0.5, 2, 0.5, 360));
  shapes.push_back(std::make_unique<Disk>(flat, false, 0.5, 2, 1.5, 50));
  shapes.push_back(std::make_unique<Cylinder>(place, false, 1, -1, 3, 360));
  shapes.push_back(std::make_unique<Cylinder>(flat, false, 1, -1, 3, 120));
  shapes.push_back(std::make_unique<BilinearMesh>(std::vector<Vec3>{{0, 0, 0}, {2, 0, 1}, {0, 1, 1}, {1, 1, 0}},
                                                  std::vector<Vec3>{}, std::vector<Vec2>{},
                                                  std::vector<int>{0, 1, 2, 3}));
  TestRandom random(5);
  for (size_t k = 0; k < shapes.size(); ++k) {
    const Outline outline(std::vector<GeometryEntry>{{shapes[k].get()}}, {}, {});
    std::vector<Vec3d> points;
    for (int y = 0; y <= 100; ++y)
      for (int x = 0; x <= 100; ++x) points.push_back(ToDouble(shapes[k]->SampleArea(0, {x / 100.0, y / 100.0}).p));
    for (int i = 0; i < 30; ++i) {
      const Vec3d w = random.Direction();
      const EnclosingCylinder cylinder = outline.CylinderAlong(w, 1e-6);
      double reach = 0;
      for (const Vec3d& p : points) reach = std::max(reach, Length(Cross(p - cylinder.center, w)));
      ASSERT_LE(reach, cylinder.radius + 1e-6) << k;
      ASSERT_GE(reach, cylinder.radius * 0.99) << k;
    }
  }
}

TEST(Outline, InstancesCountWhereTheyStand) {
  const TriangleMesh mesh = Cloud(200, 6);
  const Sphere ball(Transform(), false, 0.5);
  const std::vector<GeometryEntry> shapes = {{&mesh}, {&ball}};
  const std::vector<GeometryGroup> groups = {{{0, 1}}};
  std::vector<GeometryInstance> instances;
  for (int i = 0; i < 40; ++i)
    instances.push_back({0, Transform::Translate({i * 1.5, 0, i * i * 0.1}) * Transform::Rotate(10 * i, {1, 1, 0}) *
                                Transform::Scale({1, 1 + 0.1 * i, -1})});
  const Outline outline(shapes, groups, instances);
  TestRandom random(7);
  for (int i = 0; i < 50; ++i) {
    const Vec3d w = random.Direction();
    const EnclosingCylinder cylinder = outline.CylinderAlong(w, 1e-6);
    double reach = 0;
    for (const GeometryInstance& instance : instances) {
      for (int vertex = 0; vertex < 200; ++vertex) {
        const Vec3d p = instance.groupToRender.Point(ToDouble(mesh.Position(vertex)));
        reach = std::max(reach, Length(Cross(p - cylinder.center, w)));
      }
      for (int k = 0; k < 20; ++k) {
        const Vec3d p = instance.groupToRender.Point(random.Direction() * 0.5);
        reach = std::max(reach, Length(Cross(p - cylinder.center, w)));
      }
    }
    ASSERT_LE(reach, cylinder.radius);
    ASSERT_GE(reach, cylinder.radius * (1 - 1e-5));
  }
  EXPECT_TRUE(Outline(shapes, groups, {}).IsEmpty());
}

}  // namespace
}  // namespace dapple
