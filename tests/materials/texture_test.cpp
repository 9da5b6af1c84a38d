// Mappings and computed textures against values worked out by hand.
#include "src/materials/texture.h"

#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "src/base/hash.h"
#include "src/materials/procedural_textures.h"
#include "src/materials/texture_mapping.h"

namespace dapple {
namespace {

TextureContext At(float u, float v) { return TextureContext(Vec2(u, v)); }

TextureContext AtPoint(const Vec3& p) {
  TextureContext context;
  context.p = p;
  return context;
}

/// u, to have something that varies.
class UTexture final : public FloatTexture {
 public:
  float Evaluate(const TextureContext& at) const override { return at.uv.x; }
};

TextureMappingPtr Uv() { return std::make_shared<UvMapping>(); }
FloatTexturePtr Varying() { return std::make_shared<UTexture>(); }
FloatTexturePtr Float(float value) { return MakeConstant(value); }
ColorTexturePtr Rgb(float r, float g, float b) { return MakeConstant(Color(r, g, b)); }

void ExpectNear(const Vec2& v, const Vec2& expected) {
  EXPECT_NEAR(v.x, expected.x, 1e-6f);
  EXPECT_NEAR(v.y, expected.y, 1e-6f);
}

TEST(TextureMapping, UvIsScaledAndMoved) {
  ExpectNear(UvMapping().Map(At(0.25f, -3)), {0.25f, -3});
  ExpectNear(UvMapping({2, -4}, {0.5f, 1}).Map(At(0.25f, 0.5f)), {1, -1});
}

TEST(TextureMapping, PlanarProjectsInTextureSpace) {
  const PlanarMapping world(Transform(), {1, 0, 0}, {0, 0, 2}, {0.5, -1});
  ExpectNear(world.Map(AtPoint({3, 100, 4})), {3.5f, 7});
  // Texture space is twice as large and moved; v1 and v2 are given in it.
  const Transform renderFromTexture = Transform::Translate({10, 0, 0}) * Transform::Scale({2, 2, 2});
  const PlanarMapping moved(renderFromTexture.Inverse(), {1, 0, 0}, {0, 1, 0}, {0, 0});
  ExpectNear(moved.Map(AtPoint({14, 6, 1})), {2, 3});
}

TEST(TextureMapping, SphericalIsThetaAndPhi) {
  const SphericalMapping map((Transform()));
  ExpectNear(map.Map(AtPoint({0, 0, 5})), {0, 0});
  ExpectNear(map.Map(AtPoint({3, 0, 0})), {0.5f, 0});
  ExpectNear(map.Map(AtPoint({0, 2, 0})), {0.5f, 0.25f});
  ExpectNear(map.Map(AtPoint({0, -2, 2})), {0.25f, 0.75f});
  ExpectNear(map.Map(AtPoint({0, 0, -1})), {1, 0});
  EXPECT_TRUE(std::isfinite(map.Map(AtPoint({0, 0, 0})).x));
}

TEST(TextureMapping, CylindricalIsPhiAndHeight) {
  const CylindricalMapping v4(Transform(), CylindricalMapping::Height::kPoint);
  ExpectNear(v4.Map(AtPoint({0, 2, 3})), {0.75f, 3});
  ExpectNear(v4.Map(AtPoint({1, 0, -3})), {0.5f, -3});
  const CylindricalMapping v3(Transform(), CylindricalMapping::Height::kDirection);
  ExpectNear(v3.Map(AtPoint({0, 4, 3})), {0.75f, 0.6f});
}

TEST(Scale, Multiplies) {
  EXPECT_EQ(MakeScale(Varying(), Float(3))->Evaluate(At(0.5f, 0)), 1.5f);
  EXPECT_EQ(MakeScale(Rgb(1, 2, 3), Varying())->Evaluate(At(0.5f, 0)), Color(0.5f, 1, 1.5f));
  EXPECT_EQ(MakeScale(Rgb(1, 2, 3), Rgb(2, 0, 1))->Evaluate(At(0, 0)), Color(2, 0, 3));
}

TEST(Scale, IsConstantWhereItCanBe) {
  EXPECT_TRUE(MakeScale(Float(2), Float(3))->IsConstant());
  EXPECT_TRUE(MakeScale(Rgb(1, 2, 3), Float(3))->IsConstant());
  EXPECT_TRUE(MakeScale(Float(0), Varying())->IsConstant());
  EXPECT_TRUE(MakeScale(Rgb(0, 0, 0), Varying())->Evaluate(At(1, 1)).IsBlack());
  EXPECT_FALSE(MakeScale(Float(2), Varying())->IsConstant());
  // Folded: one lookup, not two.
  EXPECT_TRUE(dynamic_cast<const ConstantTexture<float>*>(MakeScale(Float(2), Float(3)).get()));
}

TEST(Mix, Blends) {
  EXPECT_FLOAT_EQ(MakeMix(Float(2), Float(4), Varying())->Evaluate(At(0.25f, 0)), 2.5f);
  EXPECT_EQ(MakeMix(Rgb(1, 0, 0), Rgb(0, 1, 0), Float(0.5f))->Evaluate(At(0, 0)), Color(0.5f, 0.5f, 0));
  EXPECT_EQ(MakeMix(Float(2), Float(4), Varying())->Evaluate(At(0, 0)), 2);
  EXPECT_EQ(MakeMix(Float(2), Float(4), Varying())->Evaluate(At(1, 0)), 4);
}

TEST(Mix, IsConstantWhereItCanBe) {
  EXPECT_TRUE(MakeMix(Float(2), Float(4), Float(0.5f))->IsConstant());
  EXPECT_TRUE(MakeMix(Float(2), Varying(), Float(0))->IsConstant());
  EXPECT_TRUE(MakeMix(Varying(), Float(4), Float(1))->IsConstant());
  EXPECT_FALSE(MakeMix(Varying(), Float(4), Float(0))->IsConstant());
  EXPECT_FALSE(MakeMix(Float(2), Float(4), Varying())->IsConstant());
}

TEST(Checkerboard, AlternatesAlsoBelowZero) {
  const CheckerboardTexture<float> checks(Uv(), Float(1), Float(2));
  EXPECT_EQ(checks.Evaluate(At(0.5f, 0.5f)), 1);
  EXPECT_EQ(checks.Evaluate(At(1.5f, 0.5f)), 2);
  EXPECT_EQ(checks.Evaluate(At(1.5f, 1.5f)), 1);
  EXPECT_EQ(checks.Evaluate(At(-0.5f, 0.5f)), 2);
  EXPECT_EQ(checks.Evaluate(At(-0.5f, -0.5f)), 1);
  EXPECT_EQ(checks.Evaluate(At(-1.5f, 0.5f)), 1);
  EXPECT_EQ(checks.Evaluate(At(0, 0)), 1);  // a cell owns its lower edges
  EXPECT_EQ(checks.Evaluate(At(1, 0)), 2);
  EXPECT_EQ(checks.Evaluate(At(std::nextafter(1.f, 0.f), 0)), 1);
  EXPECT_EQ(checks.Evaluate(At(1e9f, 0)), 1);
  for (const float bad : {kInfinity, -kInfinity, NAN}) EXPECT_TRUE(std::isfinite(checks.Evaluate(At(bad, 0))));
}

TEST(Checkerboard, AlternatesInSpace) {
  const Checkerboard3Texture<float> checks(Transform::Scale({0.5, 0.5, 0.5}), Float(1), Float(2));
  EXPECT_EQ(checks.Evaluate(AtPoint({1, 1, 1})), 1);
  EXPECT_EQ(checks.Evaluate(AtPoint({3, 1, 1})), 2);
  EXPECT_EQ(checks.Evaluate(AtPoint({3, 3, 1})), 1);
  EXPECT_EQ(checks.Evaluate(AtPoint({3, 3, 3})), 2);
  EXPECT_EQ(checks.Evaluate(AtPoint({-1, 1, 1})), 2);
}

TEST(Bilerp, HasItsCornersAndTheirMean) {
  const auto texture = MakeBilerp<float>(Uv(), 1, 2, 4, 8);
  EXPECT_EQ(texture->Evaluate(At(0, 0)), 1);
  EXPECT_EQ(texture->Evaluate(At(0, 1)), 2);
  EXPECT_EQ(texture->Evaluate(At(1, 0)), 4);
  EXPECT_EQ(texture->Evaluate(At(1, 1)), 8);
  EXPECT_FLOAT_EQ(texture->Evaluate(At(0.5f, 0.5f)), 3.75f);
  EXPECT_FALSE(texture->IsConstant());
  EXPECT_TRUE(MakeBilerp<float>(Uv(), 3, 3, 3, 3)->IsConstant());
}

double Uniform(uint64_t i, uint64_t dimension) { return static_cast<double>(Hash(i, dimension) >> 11) * 0x1p-53; }

TEST(Noise, VanishesOnTheLatticeAndStaysSmall) {
  for (int i = -300; i < 300; i += 7) {
    EXPECT_EQ(Noise({static_cast<float>(i), static_cast<float>(i / 2), static_cast<float>(-i)}), 0);
  }
  double sum = 0, sumOfSquares = 0;
  constexpr int kSamples = 20000;
  for (int i = 0; i < kSamples; ++i) {
    const auto coordinate = [&](int d) { return static_cast<float>(Uniform(i, d) * 200 - 100); };
    const float noise = Noise({coordinate(0), coordinate(1), coordinate(2)});
    EXPECT_LE(std::abs(noise), 1);
    sum += noise;
    sumOfSquares += noise * noise;
  }
  EXPECT_NEAR(sum / kSamples, 0, 0.02);
  EXPECT_GT(sumOfSquares / kSamples, 0.03);
  for (const float bad : {kInfinity, static_cast<float>(NAN), 1e30f}) EXPECT_EQ(Noise({bad, 0.5f, 0.5f}), 0);
}

TEST(Noise, IsContinuous) {
  for (int i = 0; i < 100; ++i) {
    const float x = static_cast<float>(i) - 50, y = static_cast<float>(Uniform(i, 0)) * 9;
    const Vec3 below(std::nextafter(x, -kInfinity), y, 0.3f);
    EXPECT_NEAR(Noise(below), Noise({x, y, 0.3f}), 1e-4f);
  }
}

// A cell has all of its disk, of radius 0.35, or nothing.
TEST(Dots, AreWholeDisksInSomeCells) {
  const DotsTexture<float> dots(Uv(), Float(1), Float(0));
  constexpr int kCells = 12, kSteps = 64;
  int cellsWithDot = 0;
  for (int cell = 0; cell < kCells * kCells; ++cell) {
    const float s = static_cast<float>(cell % kCells) - 6, t = static_cast<float>(cell / kCells) - 6;
    double area = 0;
    for (int i = 0; i < kSteps * kSteps; ++i) {
      const float du = (static_cast<float>(i % kSteps) + 0.5f) / kSteps - 0.5f;
      const float dv = (static_cast<float>(i / kSteps) + 0.5f) / kSteps - 0.5f;
      area += dots.Evaluate(At(s + du, t + dv)) / Sqr(static_cast<double>(kSteps));
    }
    const bool hasDot = area > 0;
    EXPECT_NEAR(area, hasDot ? kPiD * Sqr(0.35) : 0, 0.01);
    cellsWithDot += hasDot;
  }
  EXPECT_GT(cellsWithDot, kCells * kCells / 4);
  EXPECT_LT(cellsWithDot, kCells * kCells * 3 / 4);
}

}  // namespace
}  // namespace dapple
