// What must be true of every non-specular BSDF, as checks that give a verdict.
//
// `B` is a Bsdf, or has its Sample, Eval, Pdf and ShadingFrame; the geometric normal is z.
#pragma once

#include <cmath>
#include <string>

#include "src/base/numerics.h"
#include "src/materials/bsdf.h"
#include "src/sampling/warps.h"
#include "tests/support/random_numbers.h"
#include "tests/support/verdict.h"

namespace dapple::testing {

/// The weight of a draw is what `Eval` and `Pdf` say of its direction, and its flags which side that is on.
template <typename B>
Verdict CheckSampleAgainstEval(const B& bsdf, TransportMode mode) {
  constexpr float kError = 2e-3f;
  UniformNumbers random(5);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 wo = ToFloat(SampleSphere(random.Get2D()));
    const double uc = random.Get1D();
    const auto s = bsdf.Sample(wo, uc, random.Get2D(), mode);
    if (!s || s->IsSpecular()) continue;
    if (!(std::abs(Length(s->wi) - 1) <= 2e-6f)) return {false, "a direction that is no unit vector"};
    if (!s->weight.IsFinite()) return {false, "a weight that is not finite"};
    if (std::abs(s->wi.z) < 1e-3f || std::abs(Dot(s->wi, bsdf.ShadingFrame().n)) < 1e-3f) continue;
    const float pdf = bsdf.Pdf(wo, s->wi, mode), eval = bsdf.Eval(wo, s->wi, mode).g;
    if (!(std::abs(pdf / s->pdf - 1) <= kError))
      return {false, "density " + std::to_string(s->pdf) + " drawn, " + std::to_string(pdf) + " asked"};
    if (!(std::abs(eval / (s->weight.g * s->pdf) - 1) <= kError))
      return {false, "weight " + std::to_string(s->weight.g) + " drawn, " + std::to_string(eval / pdf) + " asked"};
    // The geometric normal tells reflection from transmission.
    if (s->flags.HasReflection() != (s->wi.z * wo.z > 0)) return {false, "flags of the other side"};
  }
  return {};
}

/// f(wo, wi) n_i^2 = f(wi, wo) n_o^2 (Veach 1997, equation 5.14), with f = Eval / |ns.wi|. `etaBelow`: the index under
/// the surface. Transmission is not asked of where `reflectionOnly`.
template <typename B>
Verdict CheckReciprocity(const B& bsdf, float etaBelow, bool reflectionOnly) {
  UniformNumbers random(7);
  const Vec3 ns = bsdf.ShadingFrame().n;
  const auto n2 = [&](const Vec3& w) { return w.z > 0 ? 1 : Sqr(etaBelow); };
  for (int i = 0; i < 2000; ++i) {
    const Vec3 wo = ToFloat(SampleSphere(random.Get2D())), wi = ToFloat(SampleSphere(random.Get2D()));
    if (reflectionOnly && wo.z * wi.z < 0) continue;
    const float there = bsdf.Eval(wo, wi, TransportMode::Radiance).g / AbsDot(wi, ns) * n2(wi);
    const float back = bsdf.Eval(wi, wo, TransportMode::Radiance).g / AbsDot(wo, ns) * n2(wo);
    if (!(std::abs(there - back) <= 5e-3f * back + 5e-6f))
      return {false, std::to_string(there) + " there, " + std::to_string(back) + " back"};
  }
  return {};
}

}  // namespace dapple::testing
