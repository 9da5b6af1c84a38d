#include "lights/light_math.h"

#include <limits>

#include "src/base/numerics.h"

namespace dapple {

Color FiniteColor(const Color& c, double scale) {
  return Map(c, [scale](float x) {
    constexpr double kLargest = std::numeric_limits<float>::max();
    return static_cast<float>(std::clamp(static_cast<double>(x) * scale, -kLargest, kLargest));
  });
}

Color FiniteColor(const Vec3d& sums) {
  return {FiniteColor(Color(1), sums.x).r, FiniteColor(Color(1), sums.y).r, FiniteColor(Color(1), sums.z).r};
}

Color Bilinear(const Color (&c)[4], const Vec2d& t) {
  const float x = static_cast<float>(t.x), y = static_cast<float>(t.y);
  return Lerp(y, Lerp(x, c[0], c[1]), Lerp(x, c[2], c[3]));
}

std::optional<LiSample> SamplePointLi(const LightContext& at, const Vec3& origin, const Color& intensity) {
  // In double: squares of float distances neither overflow nor vanish.
  const Vec3d toLight = ToDouble(origin) - ToDouble(at.p);
  const double distanceSquared = LengthSquared(toLight);
  if (distanceSquared == 0 || intensity.IsBlack()) return std::nullopt;
  LiSample sample;
  sample.L = FiniteColor(intensity, 1 / distanceSquared);
  sample.wi = ToFloat(toLight / std::sqrt(distanceSquared));
  sample.pdf = 1;
  sample.p = origin;
  sample.isDelta = true;
  return sample;
}

double PointImportance(const LightContext& at, const Vec3& origin, double intensity) {
  const Vec3d toLight = ToDouble(origin) - ToDouble(at.p);
  const double distanceSquared = LengthSquared(toLight);
  if (distanceSquared == 0) return 0;
  return intensity / distanceSquared * ReceiverCosine(at, ToFloat(toLight / std::sqrt(distanceSquared)));
}

double ReceiverCosine(const LightContext& at, const Vec3& wi) {
  if (LengthSquared(at.n) == 0) return 1;
  const double cosTheta = Dot(ToDouble(at.n), ToDouble(wi));
  return at.transmissive ? std::abs(cosTheta) : std::max(0.0, cosTheta);
}

Vec3 PointOutside(const SceneExtent& extent, const Vec3& p, const Vec3& wi) {
  return p + wi * (2 * extent.radius + Distance(p, extent.center));
}

}  // namespace dapple
