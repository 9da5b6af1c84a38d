// Bump and normal maps against normals known in closed form.
#include "src/materials/bump.h"

#include <cmath>
#include <functional>
#include <memory>

#include <gtest/gtest.h>

namespace dapple {
namespace {

/// A displacement given as a function of the texture context.
class FunctionTexture final : public FloatTexture {
 public:
  explicit FunctionTexture(std::function<float(const TextureContext&)> f) : f_(std::move(f)) {}
  float Evaluate(const TextureContext& at) const override { return f_(at); }

 private:
  std::function<float(const TextureContext&)> f_;
};

BumpMap MakeBump(std::function<float(const TextureContext&)> f) {
  return BumpMap(std::make_shared<FunctionTexture>(std::move(f)));
}

/// The plane z = 0 with u = x / scale, v = y / scale.
SurfaceInteraction PlaneHit(const Vec2& uv, float scale = 1) {
  SurfaceInteraction hit;
  hit.p = Vec3(uv.x, uv.y, 0) * scale;
  hit.ng = hit.ns = {0, 0, 1};
  hit.wo = {0, 0, 1};
  hit.uv = uv;
  hit.dpdu = hit.dpdus = {scale, 0, 0};
  hit.dpdv = hit.dpdvs = {0, scale, 0};
  return hit;
}

Vec3d SpherePoint(double u, double v) {
  const double phi = 2 * kPiD * u, theta = kPiD * v;
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

/// The unit sphere with u around and v from pole to pole.
SurfaceInteraction SphereHit(double u, double v) {
  const double h = 1e-5;
  SurfaceInteraction hit;
  hit.p = hit.ng = hit.ns = ToFloat(SpherePoint(u, v));
  hit.wo = hit.ng;
  hit.uv = {static_cast<float>(u), static_cast<float>(v)};
  hit.dpdu = hit.dpdus = hit.dndu = ToFloat((SpherePoint(u + h, v) - SpherePoint(u - h, v)) / (2 * h));
  hit.dpdv = hit.dpdvs = hit.dndv = ToFloat((SpherePoint(u, v + h) - SpherePoint(u, v - h)) / (2 * h));
  return hit;
}

void ExpectNear(const Vec3& v, const Vec3& expected, float tolerance) {
  EXPECT_NEAR(Distance(v, expected), 0, tolerance) << v << " is not " << expected;
}

void ExpectOrthonormal(const Frame& frame) {
  EXPECT_NEAR(Length(frame.s), 1, 1e-5f);
  EXPECT_NEAR(Length(frame.t), 1, 1e-5f);
  EXPECT_NEAR(Length(frame.n), 1, 1e-5f);
  EXPECT_NEAR(Dot(Cross(frame.s, frame.t), frame.n), 1, 1e-5f);
}

TEST(BumpMap, NoDisplacementChangesNothing) {
  const SurfaceInteraction hit = SphereHit(0.3, 0.4);
  const Frame frame = MakeBump([](const TextureContext&) { return 0.f; }).ShadingFrame(hit);
  const Frame smooth = SmoothShadingFrame(hit);
  ExpectNear(frame.n, smooth.n, 1e-5f);
  ExpectNear(frame.s, smooth.s, 1e-5f);
}

TEST(BumpMap, ConstantDisplacementKeepsTheNormal) {
  const SurfaceInteraction hit = SphereHit(0.8, 0.7);
  ExpectNear(MakeBump([](const TextureContext&) { return 0.5f; }).ShadingFrame(hit).n, hit.ns, 1e-5f);
}

TEST(BumpMap, PlaneTiltsAsTheSlope) {
  const BumpMap bump = MakeBump([](const TextureContext& at) { return 0.75f * at.uv.x - 0.5f * at.uv.y; });
  for (const Vec2& uv : {Vec2(0, 0), Vec2(0.3f, 0.8f), Vec2(-0.4f, 0.1f)}) {
    const Frame frame = bump.ShadingFrame(PlaneHit(uv));
    ExpectOrthonormal(frame);
    ExpectNear(frame.n, Normalize(Vec3(-0.75f, 0.5f, 1)), 1e-3f);
    ExpectNear(frame.s, Normalize(Vec3(1, 0, 0.75f)), 1e-3f);
  }
}

// The same slope by way of the point instead of uv: the texture is asked at a moved point.
TEST(BumpMap, DisplacementMayFollowThePoint) {
  const BumpMap bump = MakeBump([](const TextureContext& at) { return 0.75f * at.p.x - 0.5f * at.p.y; });
  ExpectNear(bump.ShadingFrame(PlaneHit({0.3f, 0.2f})).n, Normalize(Vec3(-0.75f, 0.5f, 1)), 1e-3f);
}

TEST(BumpMap, DoesNotDependOnTheScaleOfTheScene) {
  for (const float scale : {1e-6f, 1e6f}) {
    const BumpMap bump = MakeBump([scale](const TextureContext& at) { return 0.75f * scale * at.uv.x; });
    ExpectNear(bump.ShadingFrame(PlaneHit({0.3f, 0.2f}, scale)).n, Normalize(Vec3(-0.75f, 0, 1)), 1e-3f);
  }
}

// Far from the origin of uv the step is rounded; the slope is not.
TEST(BumpMap, LargeUvKeepsTheSlope) {
  const BumpMap bump = MakeBump([](const TextureContext& at) { return 0.5f * (at.uv.x - 1000); });
  ExpectNear(bump.ShadingFrame(PlaneHit({1000.25f, 0.2f})).n, Normalize(Vec3(-0.5f, 0, 1)), 2e-3f);
}

// The normal of a displaced sphere p + h(p) n, by differences of its points in double precision.
TEST(BumpMap, SphereHasTheNormalOfTheDisplacedSurface) {
  const auto height = [](const Vec3d& p) { return 0.1 * std::sin(3 * p.x) * std::cos(2 * p.y + p.z); };
  const auto displaced = [&](double u, double v) {
    const Vec3d p = SpherePoint(u, v);
    return p + p * height(p);
  };
  const BumpMap bump = MakeBump([&](const TextureContext& at) { return static_cast<float>(height(ToDouble(at.p))); });
  for (const auto& [u, v] : {std::pair{0.1, 0.3}, {0.45, 0.6}, {0.77, 0.2}, {0.9, 0.85}}) {
    const double h = 1e-5;
    const Vec3d dpdu = displaced(u + h, v) - displaced(u - h, v), dpdv = displaced(u, v + h) - displaced(u, v - h);
    const SurfaceInteraction hit = SphereHit(u, v);
    const Frame frame = bump.ShadingFrame(hit);
    ExpectOrthonormal(frame);
    ExpectNear(frame.n, FaceForward(ToFloat(Normalize(Cross(dpdu, dpdv))), hit.ng), 5e-3f);
    EXPECT_GT(Distance(frame.n, hit.ns), 0.02f);  // there is something to see
  }
}

TEST(BumpMap, NormalStaysOnTheSideOfTheGeometricNormal) {
  SurfaceInteraction hit = PlaneHit({0.5f, 0.5f});
  hit.ng = hit.ns = {0, 0, -1};
  const BumpMap bump = MakeBump([](const TextureContext& at) { return 0.5f * at.uv.x; });
  // The displacement goes along the normal, so the slope turns with it.
  ExpectNear(bump.ShadingFrame(hit).n, Normalize(Vec3(-0.5f, 0, -1)), 1e-3f);
  hit = SphereHit(0.2, 0.4);
  hit.ng = Normalize(Vec3(hit.ns.y, -hit.ns.x, 0) + hit.ns * 0.01f);  // a grazing shading normal
  const BumpMap steep = MakeBump([](const TextureContext& at) { return 20 * at.uv.x - 30 * at.uv.y; });
  EXPECT_GT(Dot(steep.ShadingFrame(hit).n, hit.ng), 0);
}

TEST(BumpMap, DegenerateDetailGivesTheSmoothFrame) {
  SurfaceInteraction hit = PlaneHit({0.5f, 0.5f});
  const auto expectSmooth = [&](const BumpMap& bump) {
    const Frame frame = bump.ShadingFrame(hit);
    ExpectOrthonormal(frame);
    ExpectNear(frame.n, hit.ns, 1e-6f);
  };
  expectSmooth(MakeBump([](const TextureContext&) { return kInfinity; }));
  expectSmooth(MakeBump([](const TextureContext& at) { return at.uv.x > 0.5f ? kInfinity : 0.f; }));
  hit.dpdus = hit.dpdvs = {0, 0, 0};
  expectSmooth(MakeBump([](const TextureContext& at) { return at.uv.x; }));
  hit = PlaneHit({kInfinity, 0.5f});
  expectSmooth(MakeBump([](const TextureContext&) { return 1.f; }));
}

std::shared_ptr<const Image> UniformImage(const Color& color) {
  Image image = Image::Rgb(4, 2);
  for (int y = 0; y < 2; ++y) {
    for (int x = 0; x < 4; ++x) image.SetColor(x, y, color);
  }
  return std::make_shared<const Image>(std::move(image));
}

TEST(NormalMap, FlatMapChangesNothing) {
  const NormalMap map(UniformImage({0.5f, 0.5f, 1}));
  for (const SurfaceInteraction& hit : {SphereHit(0.3, 0.4), PlaneHit({0, 1}), PlaneHit({-3.2f, 0.999f})}) {
    const Frame frame = map.ShadingFrame(hit), smooth = SmoothShadingFrame(hit);
    ExpectNear(frame.n, smooth.n, 1e-6f);
    ExpectNear(frame.s, smooth.s, 1e-6f);
  }
}

TEST(NormalMap, NormalIsInTheFrameOfTheTangents) {
  const SurfaceInteraction hit = SphereHit(0.15, 0.4);
  const Frame smooth = SmoothShadingFrame(hit);
  const Frame s = NormalMap(UniformImage({0.8f, 0.5f, 0.9f})).ShadingFrame(hit);
  ExpectOrthonormal(s);
  ExpectNear(s.n, smooth.s * 0.6f + smooth.n * 0.8f, 1e-5f);
  const Frame t = NormalMap(UniformImage({0.5f, 0.2f, 0.9f})).ShadingFrame(hit);
  ExpectNear(t.n, smooth.t * -0.6f + smooth.n * 0.8f, 1e-5f);
}

TEST(NormalMap, LengthDoesNotCount) {
  const SurfaceInteraction hit = PlaneHit({0.4f, 0.4f});
  ExpectNear(NormalMap(UniformImage({0.65f, 0.5f, 0.7f})).ShadingFrame(hit).n, {0.6f, 0, 0.8f}, 1e-5f);
}

TEST(NormalMap, FirstRowIsAtTheTop) {
  Image image = Image::Rgb(1, 2);
  image.SetColor(0, 0, {0.8f, 0.5f, 0.9f});
  image.SetColor(0, 1, {0.2f, 0.5f, 0.9f});
  const NormalMap map(std::make_shared<const Image>(std::move(image)));
  EXPECT_GT(map.ShadingFrame(PlaneHit({0.5f, 0.75f})).n.x, 0.5f);
  EXPECT_LT(map.ShadingFrame(PlaneHit({0.5f, 0.25f})).n.x, -0.5f);
}

TEST(NormalMap, BadMapsAreRefusedOrIgnored) {
  EXPECT_THROW(NormalMap(std::make_shared<const Image>()), Error);
  EXPECT_THROW(NormalMap(std::make_shared<const Image>(4, 4, std::vector<std::string>{"Y"})), Error);
  const SurfaceInteraction hit = PlaneHit({0.4f, 0.4f});
  ExpectNear(NormalMap(UniformImage({0.5f, 0.5f, 0.5f})).ShadingFrame(hit).n, hit.ns, 1e-6f);
  EXPECT_GT(NormalMap(UniformImage({0.8f, 0.5f, 0.1f})).ShadingFrame(hit).n.z, 0);
}

}  // namespace
}  // namespace dapple
