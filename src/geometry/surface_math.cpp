#include "src/geometry/surface_math.h"

namespace dapple {

HullBall EnclosingHullBall(const Vec3d& center, double radius) {
  const Vec3 rounded = ToFloat(center);
  return {rounded, RoundUp(radius + Distance(center, ToDouble(rounded)))};
}

std::vector<Vec2d> TangentPolygon(double begin, double end) {
  constexpr int kCornersOfTurn = 48;  // 1 / cos(pi / 48) = 1.0021
  const double turn = 2 * kPiD;
  const int corners = std::max(1, static_cast<int>(std::ceil((end - begin) / turn * kCornersOfTurn - 1e-9)));
  const double step = (end - begin) / corners;
  std::vector<Vec2d> polygon;
  const auto add = [&](double phi, double r) { polygon.emplace_back(r * std::cos(phi), r * std::sin(phi)); };
  const bool isClosed = end - begin >= turn;
  if (!isClosed) add(begin, 1);
  for (int i = 0; i < corners; ++i) add(begin + (i + 0.5) * step, 1 / std::cos(step / 2));
  if (!isClosed) add(end, 1);
  return polygon;
}

}  // namespace dapple
