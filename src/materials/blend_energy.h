// What keeps a gloss blended over a base (`FresnelBlend`) from reflecting more than arrives, where it is very rough.
//
// The blend masks its facets by max(cos, cos) alone. At grazing angles the base reflects nothing, and the gloss
// half of all its facets' area, the integral of D(m) over the hemisphere, times Fresnel. Of GGX that half is one at
// alpha 1, and more above: the model, made for cosine powers, whose D is never flatter than a constant, ends there. The
// largest reflectance is then that at grazing angles, and all of the blend is divided by it.
#pragma once

#include "src/base/color.h"
#include "src/materials/microfacet_kind.h"

namespace dapple {

class BlendEnergy {
 public:
  /// Of a `FresnelBlend` with the microfacets of that kind and roughness. Costs nothing up to alpha 1, else some twenty
  /// microseconds.
  BlendEnergy(MicrofacetKind kind, const Ggx& roughness);

  /// The largest share of light from any direction that a blend with this gloss reflects, whatever its base, where that
  /// is more than one; else anything up to one. Rather too large: by a thousandth, of Beckmann's facets by a hundredth
  /// (alphas up to 5). `specular` is Rs, in [0, 1].
  Color LargestReflectance(const Color& specular) const { return Color(schlick_) + specular * (white_ - schlick_); }
  /// The factor of the whole blend with which it reflects no more than arrives: one where it does not anyway.
  Color Scale(const Color& specular) const {
    return Map(LargestReflectance(specular), [](float most) { return most > 1 ? 1 / most : 1; });
  }

 private:
  float white_ = 0;    ///< for Rs = 1
  float schlick_ = 0;  ///< for Rs = 0: of the share that Schlick's Fresnel term has then
};

}  // namespace dapple
