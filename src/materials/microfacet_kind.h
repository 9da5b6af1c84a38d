// Which microfacet distribution a material asked for, and how to get from its name to the type.
#pragma once

#include "src/materials/beckmann.h"
#include "src/materials/cosine_power.h"
#include "src/materials/ggx.h"

namespace dapple {

enum class MicrofacetKind { Ggx, Beckmann, Blinn, AshikhminShirley };

/// Calls `f` with the distribution of that kind that is as rough as `ggx`: of the same alphas, or of the exponents that
/// belong to them. Blinn's, which knows one roughness, takes the alphas' geometric mean.
template <typename F>
void WithMicrofacets(MicrofacetKind kind, const Ggx& ggx, F&& f) {
  const auto exponent = [](float alpha) { return CosinePower::ExponentOfAlpha(alpha); };
  switch (kind) {
    case MicrofacetKind::Ggx:
      return f(ggx);
    case MicrofacetKind::Beckmann:
      return f(Beckmann(ggx.AlphaX(), ggx.AlphaY()));
    case MicrofacetKind::Blinn: {
      const float both = exponent(std::sqrt(ggx.AlphaX() * ggx.AlphaY()));
      return f(CosinePower(both, both));
    }
    case MicrofacetKind::AshikhminShirley:
      return f(CosinePower(exponent(ggx.AlphaX()), exponent(ggx.AlphaY())));
  }
}

}  // namespace dapple
