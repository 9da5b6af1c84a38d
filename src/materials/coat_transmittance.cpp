#include "src/materials/coat_transmittance.h"

#include "src/materials/fresnel.h"
#include "src/materials/ggx.h"

namespace dapple {

namespace {

/// The i-th of n points of the unit square (R2 sequence: Roberts 2018).
Vec2d Point(int i) {
  const auto fraction = [](double x) { return x - std::floor(x); };
  return {fraction(0.5 + 0.7548776662466927 * i), fraction(0.5 + 0.5698402909980532 * i)};
}

Vec3 FromCosine(float cosTheta) { return {std::sqrt((1 - cosTheta) * (1 + cosTheta)), 0, cosTheta}; }

/// The shares that a rough interface transmits and reflects of light along `wo`, by visible normals: their mean of
/// (1 - F) G / G1 and of F G / G1.
struct Shares {
  double transmitted = 0, reflected = 0;
};

Shares InterfaceShares(const Ggx& ggx, float eta, const Vec3& wo, int points, int first) {
  Shares sum;
  for (int i = 0; i < points; ++i) {
    const Vec3 wm = ggx.SampleVisible(wo, Point(first + i));
    const Vec3 up = FaceForward(wm, Vec3(0, 0, 1));
    const float fresnel = FresnelDielectric(Dot(wo, up), eta);
    const float g1 = ggx.G1(wo);
    const Vec3 reflected = wm * (2 * Dot(wo, wm)) - wo;
    if (SameHemisphere(reflected, wo)) sum.reflected += static_cast<double>(fresnel * ggx.G(wo, reflected) / g1);
    const auto refracted = Refract(wo, up, eta);
    if (refracted && refracted->w.z * wo.z < 0) {
      sum.transmitted += static_cast<double>((1 - fresnel) * ggx.G(wo, refracted->w) / g1);
    }
  }
  return {sum.transmitted / points, sum.reflected / points};
}

}  // namespace

CoatTransmittance::CoatTransmittance(float eta, float minAlpha, float maxAlpha)
    : minAlpha_(minAlpha), maxAlpha_(maxAlpha) {
  constexpr int kAlphas = 16;
  const int rows = maxAlpha > minAlpha ? kAlphas : 1;
  for (int i = 0; i < rows; ++i) {
    const float t = rows == 1 ? 0 : static_cast<float>(i) / static_cast<float>(rows - 1);
    rows_.push_back(MakeRow(eta, Lerp(t, minAlpha, maxAlpha)));
  }
}

CoatTransmittance::Row CoatTransmittance::MakeRow(float eta, float alpha) {
  constexpr int kPoints = 256, kAngles = 64;
  const Ggx ggx(alpha, alpha);
  Row row = {};
  for (int i = 0; i < kCosines; ++i) {
    const float cosTheta = Sqr((static_cast<float>(i) + (i == 0 ? 0.01f : 0)) / (kCosines - 1));
    row.entering[i] = static_cast<float>(InterfaceShares(ggx, eta, FromCosine(cosTheta), kPoints, 1).transmitted);
  }
  // Diffuse light: cos^2 is uniform.
  double entering = 0, returned = 0;
  for (int i = 0; i < kAngles; ++i) {
    const Vec3 wo = FromCosine(std::sqrt((static_cast<float>(i) + 0.5f) / kAngles));
    entering += InterfaceShares(ggx, eta, wo, kPoints, 1 + i * kPoints).transmitted / kAngles;
    returned += InterfaceShares(ggx, eta, -wo, kPoints, 1 + i * kPoints).reflected / kAngles;
  }
  row.diffuseEntering = static_cast<float>(entering);
  row.diffuseReturned = static_cast<float>(returned);
  return row;
}

CoatTransmittance::Position CoatTransmittance::Locate(float alpha) const {
  if (rows_.size() == 1) return {0, 0};
  const int last = static_cast<int>(rows_.size()) - 2;
  const float x = std::clamp((alpha - minAlpha_) / (maxAlpha_ - minAlpha_), 0.f, 1.f) * static_cast<float>(last + 1);
  const int row = std::min(static_cast<int>(x), last);
  return {row, x - static_cast<float>(row)};
}

float CoatTransmittance::Entering(float cosTheta, float alpha) const {
  const float x = std::sqrt(std::clamp(cosTheta, 0.f, 1.f)) * (kCosines - 1);
  const int node = std::min(static_cast<int>(x), kCosines - 2);
  const float t = x - static_cast<float>(node);
  const auto at = [&](int row) { return Lerp(t, rows_[row].entering[node], rows_[row].entering[node + 1]); };
  const Position position = Locate(alpha);
  return position.t > 0 ? Lerp(position.t, at(position.row), at(position.row + 1)) : at(position.row);
}

float CoatTransmittance::DiffuseEntering(float alpha) const {
  const auto [row, t] = Locate(alpha);
  return t > 0 ? Lerp(t, rows_[row].diffuseEntering, rows_[row + 1].diffuseEntering) : rows_[row].diffuseEntering;
}

float CoatTransmittance::DiffuseReturned(float alpha) const {
  const auto [row, t] = Locate(alpha);
  return t > 0 ? Lerp(t, rows_[row].diffuseReturned, rows_[row + 1].diffuseReturned) : rows_[row].diffuseReturned;
}

}  // namespace dapple
