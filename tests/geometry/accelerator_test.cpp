#include "src/geometry/accelerator.h"

#include <array>
#include <bit>
#include <memory>

#include <gtest/gtest.h>

#include "src/base/error.h"
#include "src/base/parallel.h"
#include "src/geometry/bilinear_mesh.h"
#include "src/geometry/sphere.h"
#include "src/geometry/triangle_mesh.h"
#include "tests/geometry/shape_checks.h"

namespace dapple {
namespace {

TriangleMesh Soup(int count, double size, uint64_t seed) {
  TestRandom random(seed);
  std::vector<Vec3> p;
  std::vector<int> indices;
  for (int i = 0; i < 3 * count; ++i) {
    const Vec3d centre = i % 3 == 0 ? random.Box(-1, 1) : ToDouble(p[i - i % 3]);
    p.push_back(ToFloat(centre + random.Box(-size, size)));
    indices.push_back(i);
  }
  return {p, {}, {}, indices};
}

Ray RandomRay(TestRandom* random) {
  const Vec3d o = random->Direction() * 3.0;
  return {ToFloat(o), ToFloat(Normalize(random->Box(-1, 1) - o)), kInfinity, {}};
}

/// Lets hits with u + v of the surface below one half pass.
class HalfHole : public HitFilter {
 public:
  bool Accepts(const Shape& shape, const PrimitiveHit& hit, const Ray&) const override {
    const Vec2 uv = shape.Uv(hit);
    return uv.x >= 0.5f;
  }
};

TEST(Accelerator, FindsTheNearestOfAllPrimitives) {
  const TriangleMesh soup = Soup(200, 0.3, 1);
  const Sphere ball(Transform::Translate({0.5, 0.2, -0.3}), false, 0.4);
  const BilinearMesh patch({{-1, -1, 0}, {1, -1, 0.5f}, {-1, 1, 0.5f}, {1, 1, 0}}, {}, {}, {0, 1, 2, 3});
  const std::vector<const Shape*> shapes = {&soup, &ball, &patch};
  const Accelerator accelerator({{&soup}, {&ball}, {&patch}}, {}, {});
  TestRandom random(2);
  int hits = 0;
  for (int i = 0; i < 3000; ++i) {
    const Ray ray = RandomRay(&random);
    float nearest = kInfinity;
    int shape = -1, primitive = -1;
    for (int s = 0; s < 3; ++s) {
      for (int k = 0; k < shapes[s]->PrimitiveCount(); ++k) {
        const auto hit = shapes[s]->Intersect(ray, k);
        if (hit && hit->t < nearest) nearest = hit->t, shape = s, primitive = k;
      }
    }
    const auto found = accelerator.Intersect(ray);
    ASSERT_EQ(found.has_value(), shape >= 0);
    EXPECT_EQ(accelerator.Occluded(ray), shape >= 0);
    if (!found) continue;
    ++hits;
    EXPECT_NEAR(found->t, nearest, 1e-5);
    EXPECT_LE(Distance(found->p, ray(nearest)), 1e-5);
    EXPECT_EQ(found->shape, shape);
    EXPECT_EQ(found->primitive, primitive);
    EXPECT_EQ(found->instance, -1);
    Ray before = ray, after = ray;
    before.tMax = found->t * (1 - 1e-5f), after.tMax = found->t * (1 + 1e-5f);
    EXPECT_FALSE(accelerator.Occluded(before));
    EXPECT_FALSE(accelerator.Intersect(before));
    EXPECT_TRUE(accelerator.Occluded(after));
  }
  EXPECT_GT(hits, 1000);
}

TEST(Accelerator, InstancesEqualBakedCopies) {
  const TriangleMesh soup = Soup(100, 0.3, 3);
  const Sphere ball(Transform::Translate({0.5, 0.2, -0.3}), true, 0.4);
  const Transform place =
      Transform::Translate({0.2, 0.1, -0.4}) * Transform::Rotate(70, {1, 1, 0}) * Transform::Scale({0.8, -0.5, 0.6});
  std::vector<Vec3> baked;
  for (int i = 0; i < soup.VertexCount(); ++i) baked.push_back(ToFloat(place.Point(ToDouble(soup.Position(i)))));
  const TriangleMesh bakedSoup(baked, {}, {}, soup.Indices(), {}, false, true);
  const Sphere bakedBall(place * Transform::Translate({0.5, 0.2, -0.3}), true, 0.4);
  const Accelerator copies({{&bakedSoup}, {&bakedBall}}, {}, {});
  const Accelerator instanced({{&soup}, {&ball}}, {{{0, 1}}}, {{0, place}});
  TestRandom random(4);
  int hits = 0;
  for (int i = 0; i < 10000; ++i) {
    Ray ray = RandomRay(&random);
    ray.state = {0.25f, 550};
    const auto a = copies.Intersect(ray), b = instanced.Intersect(ray);
    ASSERT_EQ(a.has_value(), b.has_value());
    EXPECT_EQ(copies.Occluded(ray), instanced.Occluded(ray));
    if (!a || a->primitive != b->primitive) continue;  // at an edge
    ++hits;
    EXPECT_EQ(a->shape, b->shape);
    EXPECT_EQ(b->instance, 0);
    EXPECT_EQ(b->state.wavelength, 550);
    EXPECT_NEAR(a->t, b->t, 1e-4);
    ExpectNear(a->p, b->p, 1e-4, "p");
    ExpectNear(a->ng, b->ng, 1e-3, "ng");
    ExpectNear(a->ns, b->ns, 1e-3, "ns");
    ExpectNear(a->wo, b->wo, 1e-6, "wo");
    ExpectNear(a->dpdu, b->dpdu, 1e-2, "dpdu");
    ExpectNear(a->dpdv, b->dpdv, 1e-2, "dpdv");
    ExpectNear(a->dndu, b->dndu, 1e-2, "dndu");
    ExpectNear(a->dndv, b->dndv, 1e-2, "dndv");
    ExpectNear({a->uv.x, a->uv.y, 0}, {b->uv.x, b->uv.y, 0}, 1e-3, "uv");
  }
  EXPECT_GT(hits, 1000);
}

TEST(Accelerator, ManyInstancesOfAFewGroupsAreToldApart) {
  const TriangleMesh square({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {}, {}, {0, 1, 2, 1, 3, 2});
  const Sphere ball(Transform::Translate({0.5, 0.5, 0}), false, 0.5);
  const Sphere alone(Transform::Translate({-5, -5, 0}), false, 1);
  std::vector<GeometryInstance> instances;
  for (int i = 0; i < 10; ++i)
    for (int j = 0; j < 10; ++j) instances.push_back({(i + j) % 2, Transform::Translate({2.0 * i, 2.0 * j, 0})});
  const Accelerator accelerator({{&square}, {&alone}, {&ball}}, {{{0}}, {{2}}}, instances);
  for (int i = 0; i < 10; ++i) {
    for (int j = 0; j < 10; ++j) {
      const auto hit = accelerator.Intersect(
          {{2.0f * static_cast<float>(i) + 0.4f, 2.0f * static_cast<float>(j) + 0.3f, 9}, {0, 0, -1}, kInfinity, {}});
      ASSERT_TRUE(hit);
      EXPECT_EQ(hit->instance, 10 * i + j);
      EXPECT_EQ(hit->shape, (i + j) % 2 == 0 ? 0 : 2);
    }
  }
  const auto hit = accelerator.Intersect({{-5, -5, 9}, {0, 0, -1}, kInfinity, {}});
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->shape, 1);
  EXPECT_EQ(hit->instance, -1);
}

TEST(Accelerator, FiltersCutHolesInMeshesAndBehindThemTheRayGoesOn) {
  const std::vector<Vec2> uv = {{0, 0}, {1, 0}, {0, 1}};
  const TriangleMesh front({{0, 0, 1}, {1, 0, 1}, {0, 1, 1}}, {}, uv, {0, 1, 2});
  const TriangleMesh back({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}, uv, {0, 1, 2});
  const HalfHole hole;
  const Accelerator both({{&front, &hole}, {&back}}, {}, {}), only({{&front, &hole}}, {}, {});
  const Ray through{{0.2f, 0.2f, 5}, {0, 0, -1}, kInfinity, {}}, stopped{{0.7f, 0.2f, 5}, {0, 0, -1}, kInfinity, {}};
  EXPECT_EQ(both.Intersect(through)->shape, 1);
  EXPECT_EQ(both.Intersect(stopped)->shape, 0);
  EXPECT_FALSE(only.Intersect(through));
  EXPECT_FALSE(only.Occluded(through));
  EXPECT_TRUE(only.Occluded(stopped));
}

TEST(Accelerator, FiltersOpenTheFrontOfASphereToItsBack) {
  const Sphere ball(Transform(), false, 1);  // u >= 0.5 is the half of negative y
  const HalfHole hole;
  const Accelerator accelerator({{&ball, &hole}}, {}, {});
  const auto hit = accelerator.Intersect({{0.1f, 5, 0}, {0, -1, 0}, kInfinity, {}});
  ASSERT_TRUE(hit);
  EXPECT_LT(hit->p.y, 0);
  EXPECT_FALSE(accelerator.Intersect({{0.1f, 5, 0}, {0, -1, 0}, 5, {}}));
  EXPECT_FALSE(accelerator.Occluded({{0.1f, 5, 0}, {0, -1, 0}, 5, {}}));
  EXPECT_TRUE(accelerator.Occluded({{0.1f, 5, 0}, {0, -1, 0}, kInfinity, {}}));
}

TEST(Accelerator, WhatCastsNoShadowIsSeenButDoesNotOcclude) {
  const TriangleMesh mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}, {}, {0, 1, 2});
  const Sphere ball(Transform::Translate({5, 5, 0}), false, 1);
  const Accelerator accelerator({{&mesh, nullptr, false}, {&ball, nullptr, false}}, {}, {});
  for (const Vec3& o : {Vec3(0.2f, 0.2f, 5), Vec3(5, 5, 5)}) {
    EXPECT_TRUE(accelerator.Intersect({o, {0, 0, -1}, kInfinity, {}}));
    EXPECT_FALSE(accelerator.Occluded({o, {0, 0, -1}, kInfinity, {}}));
  }
}

TEST(Accelerator, AnswersAreTheSameForAnyNumberOfThreads) {
  // Every triangle stands there twice, and the rays aim at shared vertices and edges: many ties. Built and asked anew
  // under each limit, the same primitive must win.
  constexpr int kRays = 20000, kSize = 64;
  TestRandom random(8);
  std::vector<Vec3> p;
  std::vector<int> indices;
  for (int y = 0; y <= kSize; ++y)
    for (int x = 0; x <= kSize; ++x)
      p.push_back({static_cast<float>(x), static_cast<float>(y), static_cast<float>((x * 7 + y * 3) % 5)});
  for (int copy = 0; copy < 2; ++copy) {
    for (int y = 0; y < kSize; ++y) {
      for (int x = 0; x < kSize; ++x) {
        const int a = y * (kSize + 1) + x, b = a + 1, c = a + kSize + 1, d = c + 1;
        indices.insert(indices.end(), {a, b, d, a, d, c});
      }
    }
  }
  const TriangleMesh mesh(p, {}, {}, indices);
  std::vector<Ray> rays;
  for (int i = 0; i < kRays; ++i) {
    const int k = static_cast<int>(random.Uniform() * static_cast<double>(p.size()));
    rays.push_back({{p[k].x, p[k].y, 20}, {0, 0, -1}, kInfinity, {}});
  }
  std::vector<std::vector<int>> winners;
  for (const int threads : {1, 2, 3, 1}) {
    const ThreadLimit limit(threads);
    const Accelerator accelerator({{&mesh}}, {}, {});
    std::vector<int> primitives(kRays);
    ParallelForChunks(kRays, 100, [&](int64_t begin, int64_t end) {
      for (int64_t i = begin; i < end; ++i) {
        const auto hit = accelerator.Intersect(rays[i]);
        primitives[i] = hit ? hit->primitive : -1;
      }
    });
    winners.push_back(primitives);
  }
  for (size_t i = 1; i < winners.size(); ++i) EXPECT_EQ(winners[0], winners[i]);
}

// As above, of large triangles each of which overlaps most others, as a builder that cuts triangles would cut many
// times. The scene is built inside a loop of so many threads, so that so many build it.
TEST(Accelerator, OverlappingTwinsAreFoundTheSameForAnyNumberOfThreads) {
  constexpr int kTriangles = 20000, kRays = 100000, kChunk = 500;
  const TriangleMesh soup = Soup(kTriangles, 0.7, 9), twins = soup;
  TestRandom random(10);
  std::vector<Ray> rays;
  for (int i = 0; i < kRays; ++i) rays.push_back(RandomRay(&random));
  const auto findAll = [&](int threads) {
    const ThreadLimit limit(threads);
    std::unique_ptr<Accelerator> accelerator;
    ParallelFor(1, [&](int64_t) {
      accelerator = std::make_unique<Accelerator>(std::vector<GeometryEntry>{{&soup}, {&twins}},
                                                  std::vector<GeometryGroup>{}, std::vector<GeometryInstance>{});
    });
    std::vector<std::array<int, 3>> found(kRays);
    ParallelForChunks(kRays, kChunk, [&](int64_t begin, int64_t end) {
      for (int64_t i = begin; i < end; ++i)
        if (const auto hit = accelerator->Intersect(rays[i]))
          found[i] = {hit->shape, hit->primitive, std::bit_cast<int>(hit->t)};
    });
    return found;
  };
  const auto one = findAll(1);
  for (const int threads : {2, 3, 16}) EXPECT_TRUE(findAll(threads) == one) << threads;
}

TEST(Accelerator, BoundsAndMemoryAreThoseOfTheScene) {
  const Accelerator empty({}, {}, {});
  EXPECT_TRUE(empty.Bounds().isEmpty());
  EXPECT_FALSE(empty.Intersect({{0, 0, 0}, {0, 0, 1}, kInfinity, {}}));
  EXPECT_FALSE(empty.Occluded({{0, 0, 0}, {0, 0, 1}, kInfinity, {}}));
  const TriangleMesh soup = Soup(10000, 0.05, 5);
  const Sphere ball(Transform(), false, 0.5);
  const Accelerator accelerator({{&soup}, {&ball}}, {{{1}}}, {{0, Transform::Translate({10, 0, 0})}});
  EXPECT_NEAR(accelerator.Bounds().max.x, 10.5, 1e-4);
  EXPECT_NEAR(accelerator.Bounds().min.x, -1.05, 0.05);
  EXPECT_GT(accelerator.MemoryBytes(), 100000);
}

TEST(Accelerator, RefusesPositionsThatAreNotFinite) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const float bad : {nan, kInfinity, -kInfinity, 1e30f}) {
    const TriangleMesh mesh({{0, 0, 0}, {1, 0, 0}, {0, bad, 0}}, {}, {}, {0, 1, 2});
    EXPECT_THROW(Accelerator({{&mesh}}, {}, {}), Error);
    const BilinearMesh patch({{0, 0, 0}, {1, 0, 0}, {0, bad, 0}, {1, 1, 0}}, {}, {}, {0, 1, 2, 3});
    EXPECT_THROW(Accelerator({{&patch}}, {}, {}), Error);
  }
}

}  // namespace
}  // namespace dapple
