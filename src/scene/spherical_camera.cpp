#include "src/scene/spherical_camera.h"

#include "lights/equal_area_mapping.h"

namespace dapple {

namespace {

/// [0, 1]^2, mirrored at the edges as the equal-area square goes on beyond them.
Vec2d WrapEqualAreaSquare(Vec2d p) {
  for (int axis = 0; axis < 2; ++axis) {
    if (p[axis] >= 0 && p[axis] <= 1) continue;
    p[axis] = p[axis] < 0 ? -p[axis] : 2 - p[axis];
    p[1 - axis] = 1 - p[1 - axis];
  }
  return p;
}

}  // namespace

SphericalCamera::SphericalCamera(const Transform& cameraToRender, const Vec2i& resolution, SphericalProjection mapping,
                                 const FileLocation& location)
    : frame_(cameraToRender, location), resolution_(resolution.x, resolution.y), mapping_(mapping) {}

Vec3d SphericalCamera::ToDirection(const Vec2& film) const {
  const Vec2d uv(film.x / resolution_.x, film.y / resolution_.y);
  if (mapping_ == SphericalProjection::EqualArea) {
    const Vec3d w = EqualAreaSquareToSphere(WrapEqualAreaSquare(uv));
    return {w.x, w.z, w.y};
  }
  const double theta = kPiD * uv.y, phi = 2 * kPiD * uv.x;
  return {std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)};
}

Vec2 SphericalCamera::ToFilm(const Vec3d& direction) const {
  Vec2d uv;
  if (mapping_ == SphericalProjection::EqualArea) {
    uv = EqualAreaSphereToSquare({direction.x, direction.z, direction.y});
  } else {
    const double phi = std::atan2(direction.z, direction.x);
    const double theta = std::atan2(std::hypot(direction.x, direction.z), direction.y);
    uv = {(phi < 0 ? phi + 2 * kPiD : phi) / (2 * kPiD), theta / kPiD};
  }
  return {static_cast<float>(uv.x * resolution_.x), static_cast<float>(uv.y * resolution_.y)};
}

double SphericalCamera::PixelSolidAngle(const Vec3d& direction) const {
  const double pixels = resolution_.x * resolution_.y;
  const double length = Length(frame_.Vector(direction));
  const double stretch = frame_.Volume() / (length * length * length);
  if (mapping_ == SphericalProjection::EqualArea) return 4 * kPiD / pixels * stretch;
  return 2 * kPiD * kPiD * std::hypot(direction.x, direction.z) / pixels * stretch;
}

CameraRay SphericalCamera::GenerateRay(const Vec2& film, const Vec2d&, double uTime) const {
  const Vec3d d = ToDirection(film);
  CameraRay result;
  result.ray = frame_.MakeRay(Vec3d(0), d, uTime);
  result.footprintSpread = static_cast<float>(std::sqrt(PixelSolidAngle(d)));
  return result;
}

std::optional<WiSample> SphericalCamera::Sample_Wi(const Vec3& p, const Vec2d&) const {
  const Vec3d toPoint = ToDouble(p) - frame_.Point(Vec3d(0));
  const double distanceSquared = LengthSquared(toPoint);
  const Vec3d direction = Normalize(frame_.PointToCamera(p));
  const double We = 1 / (PixelSolidAngle(direction) * distanceSquared);
  if (!std::isfinite(static_cast<float>(We))) return std::nullopt;  // at the camera, or a pole
  WiSample sample;
  sample.film = ToFilm(direction);
  sample.We = static_cast<float>(We);
  sample.wi = ToFloat(Normalize(-toPoint));
  sample.lens = Position();
  sample.pdf = 1;
  sample.isDelta = true;
  return sample;
}

int SphericalCamera::FilmRepeats(const Vec2& film, std::array<Vec2, kMostRepeats>* repeats) const {
  const auto width = static_cast<float>(resolution_.x), height = static_cast<float>(resolution_.y);
  const float x = film.x, y = film.y;
  if (mapping_ == SphericalProjection::EqualArea) {
    *repeats = {Vec2(-x, height - y),        Vec2(2 * width - x, height - y),
                Vec2(width - x, -y),         Vec2(width - x, 2 * height - y),
                Vec2(x - width, y - height), Vec2(x - width, y + height),
                Vec2(x + width, y - height), Vec2(x + width, y + height)};
    return 8;
  }
  // Round the axis, and over the poles.
  *repeats = {Vec2(x - width, y),      Vec2(x + width, y),
              Vec2(x - width / 2, -y), Vec2(x - width / 2, 2 * height - y),
              Vec2(x + width / 2, -y), Vec2(x + width / 2, 2 * height - y)};
  return 6;
}

float SphericalCamera::We(const Ray& ray, Vec2* film) const {
  const Vec3d direction = Normalize(frame_.VectorToCamera(ray.d));
  *film = ToFilm(direction);
  const auto We = static_cast<float>(1 / PixelSolidAngle(direction));
  return std::isfinite(We) ? We : 0;
}

WePdf SphericalCamera::Pdf_We(const Ray& ray) const {
  const double solidAngle = PixelSolidAngle(Normalize(frame_.VectorToCamera(ray.d)));
  if (solidAngle == 0) return {};
  return {1, 1 / (solidAngle * resolution_.x * resolution_.y)};
}

Vec3 SphericalCamera::Position() const { return ToFloat(frame_.Point(Vec3d(0))); }

float SphericalCamera::Depth(const Vec3& p) const { return static_cast<float>(Length(frame_.PointToCamera(p))); }

}  // namespace dapple
