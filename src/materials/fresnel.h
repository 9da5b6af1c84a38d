// Fresnel's equations and Snell's law for smooth interfaces, without cancellation at any angle or index.
#pragma once

#include <optional>

#include "src/base/color.h"
#include "src/base/vec.h"

namespace dapple {

/// The share of unpolarised light that an interface reflects. `cosTheta` in [-1, 1] on the side of incidence, `eta` > 0
/// is the index inside (z < 0) over that outside; a negative cosine comes from inside. In [0, 1]; 1 at total
/// reflection. Exact to float rounding also where eta is near one, at grazing angles and around the critical angle.
float FresnelDielectric(float cosTheta, float eta);

/// The same for a conductor of relative index eta + i k, each component for itself; |cosTheta| is used.
Color FresnelConductor(float cosTheta, const Color& eta, const Color& k);

/// The conductor (eta, k) of which `reflectance` (in [0, 1]) is the reflectance at normal incidence, with eta = 1
/// (pbrt-v4, section 9.4): k = 2 sqrt(r) / sqrt(1 - r), with r limited to 0.9999.
Color ConductorKFromReflectance(const Color& reflectance);

/// Schlick's approximation with `r0` at normal incidence; `cosTheta` in [0, 1].
Color FresnelSchlick(float cosTheta, const Color& r0);

/// Refracts the unit vector `w`, which points away from the surface, about the unit normal `n`: the result points away
/// on the other side. `eta` is the index on the side opposite to `n` over that on n's side. Nothing at total
/// reflection.
struct Refraction {
  Vec3 w;
  float eta = 1;  ///< n_to / n_from: `eta` where Dot(w, n) > 0, else 1 / eta
};
std::optional<Refraction> Refract(const Vec3& w, const Vec3& n, float eta);

/// The reflectance of an interface under diffuse light from outside, the integral of F(cos) 2 cos d cos; by quadrature.
float FresnelDiffuseReflectance(float eta);

}  // namespace dapple
