#include "src/materials/fresnel.h"

#include "src/base/numerics.h"

namespace dapple {

namespace {

/// (eta cos thetaT)^2 by Snell's law; not above zero: total reflection. No 1 - sin^2, so exact for eta near one.
float RefractedCosSquared(float cosTheta, float eta) { return std::fma(cosTheta, cosTheta, (eta - 1) * (eta + 1)); }

float ConductorReflectance(float c, float eta, float k) {
  // (a + i b)^2 = (eta + i k)^2 - sin^2. The smaller of a, b follows from a b = eta k: a difference of squares would
  // cancel.
  const float s2 = (1 - c) * (1 + c);
  const float t = (eta - k) * (eta + k) - s2, etaK = eta * k;
  const float magnitude = std::sqrt(t * t + 4 * etaK * etaK);
  const float larger = std::sqrt((magnitude + std::abs(t)) / 2);
  if (!(larger > 0)) return 1;  // what is refracted runs along the surface
  const float smaller = etaK / larger;
  const float a = t > 0 ? larger : smaller, b = t > 0 ? smaller : larger;
  const float senkrecht = (Sqr(c - a) + b * b) / (Sqr(c + a) + b * b);
  const float ratio = (Sqr(c * a - s2) + Sqr(c * b)) / (Sqr(c * a + s2) + Sqr(c * b));
  return std::min(1.f, senkrecht * (1 + ratio) / 2);
}

}  // namespace

float FresnelDielectric(float cosTheta, float eta) {
  if (cosTheta < 0) {
    cosTheta = -cosTheta;
    eta = 1 / eta;
  }
  const float c = std::min(cosTheta, 1.f);
  const float e = (eta - 1) * (eta + 1);
  if (e == 0) return 0;
  const float g2 = RefractedCosSquared(c, eta);
  if (!(g2 > 0)) return 1;
  const float g = std::sqrt(g2);  // eta cos thetaT
  // The amplitudes (c - g) / (c + g) and (eta^2 c - g) / (eta^2 c + g), with numerators multiplied out: both hold e.
  const float eta2 = eta * eta;
  const float senkrecht = -e / Sqr(c + g);
  const float parallel = e * (std::fma(eta2 + 1, c * c, -1.f)) / Sqr(eta2 * c + g);
  return std::min(1.f, (Sqr(senkrecht) + Sqr(parallel)) / 2);
}

Color FresnelConductor(float cosTheta, const Color& eta, const Color& k) {
  const float c = std::min(std::abs(cosTheta), 1.f);
  return {ConductorReflectance(c, eta.r, k.r), ConductorReflectance(c, eta.g, k.g),
          ConductorReflectance(c, eta.b, k.b)};
}

Color ConductorKFromReflectance(const Color& reflectance) {
  return Map(Clamp(reflectance, 0, 0.9999f), [](float r) { return 2 * std::sqrt(r) / std::sqrt(1 - r); });
}

Color FresnelSchlick(float cosTheta, const Color& r0) {
  const float m = std::clamp(1 - cosTheta, 0.f, 1.f);
  return r0 + (Color(1) - r0) * (Sqr(Sqr(m)) * m);
}

std::optional<Refraction> Refract(const Vec3& w, const Vec3& n, float eta) {
  const float cosTheta = Dot(w, n);
  if (cosTheta < 0) eta = 1 / eta;
  const float g2 = RefractedCosSquared(cosTheta, eta);
  if (!(g2 > 0)) return std::nullopt;
  const float etaCosT = std::copysign(std::sqrt(g2), cosTheta);
  return Refraction{Normalize((n * (cosTheta - etaCosT) - w) * (1 / eta)), eta};
}

float FresnelDiffuseReflectance(float eta) {
  // Midpoints in x, cos = x^2: 2 cos d cos = 4 x^3 dx, which smooths the square root at grazing angles.
  constexpr int kSteps = 1024;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double x = (i + 0.5) / kSteps;
    sum += static_cast<double>(FresnelDielectric(static_cast<float>(x * x), eta)) * 4 * x * x * x;
  }
  return std::min(1.f, static_cast<float>(sum / kSteps));
}

}  // namespace dapple
