#include "src/materials/diffuse_lobes.h"

namespace dapple {

Color OrenNayarReflection::Albedo(const Vec3& wo) const {
  const float c = AbsCosTheta(wo), s = SinTheta(wo), theta = std::atan2(s, c);
  // Of max(0, cos dphi) sin(alpha) tan(beta) cos(thetaI) / pi, in two pieces: thetaI below and above thetaO.
  const float below = s * (theta - s * c) / 2;
  const float above = s * c * (1 + s + s * s) / (3 * (1 + s));
  return albedo * (a + b * 2 * kInvPi * (below + above));
}

}  // namespace dapple
