#include "src/scene/perspective_camera.h"

#include <fmt/format.h>

#include "src/sampling/warps.h"

// Measures. Let M be the linear part of cameraToRender and d a camera-space direction with d.z = 1, so that d.xy runs
// over the plane z = 1 on which the image covers the area A. With w = M d, solid angles in render space are |det M| /
// |w|^3 dA, and cosines at the lens h / |w|, where h is the height of M (0,0,1) over the lens plane. For a rigid M this
// is the familiar cos^3, and We = 1 / (A lensArea cos^4) (Pharr et al. 2023, equation 16.3).
namespace dapple {

PerspectiveCamera::PerspectiveCamera(const Transform& cameraToRender, const Vec2i& resolution,
                                     const ScreenWindow& window, double fovDegrees, const ThinLens& lens,
                                     const FileLocation& location)
    : frame_(cameraToRender, location),
      mapping_(window, resolution),
      tanHalfFov_(std::tan(Radians(fovDegrees) / 2)),
      lens_(lens),
      lensArea_(lens.radius > 0 ? kPiD * Sqr(lens.radius) * frame_.LensArea() : 1) {
  if (!(fovDegrees > 0 && fovDegrees < 180))
    throw Error(location,
                fmt::format("field of view is {} degrees, expected more than 0 and less than 180", fovDegrees));
  if (!(lens.radius >= 0) || !(lens.focalDistance > 0))
    throw Error(location, fmt::format("lens of radius {} focused at {}: expected a radius of 0 or more and a positive "
                                      "distance",
                                      lens.radius, lens.focalDistance));
}

Vec3d PerspectiveCamera::Direction(const Vec2d& lens, const Vec2d& film) const {
  const Vec2d slope = film - lens / lens_.focalDistance;
  return {slope.x, slope.y, 1};
}

CameraRay PerspectiveCamera::GenerateRay(const Vec2& film, const Vec2d& uLens, double uTime) const {
  const Vec2d onPlane = mapping_.ToScreen(film) * tanHalfFov_;
  const Vec2d lens = lens_.radius > 0 ? SampleDiskConcentric(uLens) * lens_.radius : Vec2d(0);
  const Vec3d d = Direction(lens, onPlane);
  const double length = Length(frame_.Vector(d));
  const double pixelAngle = PlaneArea(mapping_.PixelArea()) * frame_.Volume() / (length * length * length);
  CameraRay result;
  result.ray = frame_.MakeRay({lens.x, lens.y, 0}, d, uTime);
  result.footprintSpread = static_cast<float>(std::sqrt(pixelAngle));
  return result;
}

double PerspectiveCamera::Importance(double length) const {
  return Sqr(Sqr(length)) / (PlaneArea(mapping_.PixelArea()) * lensArea_ * frame_.Volume() * frame_.Height());
}

std::optional<WiSample> PerspectiveCamera::Sample_Wi(const Vec3& p, const Vec2d& uLens) const {
  const Vec3d pCamera = frame_.PointToCamera(p);
  if (!(pCamera.z > 0)) return std::nullopt;
  const Vec2d lens = lens_.radius > 0 ? SampleDiskConcentric(uLens) * lens_.radius : Vec2d(0);
  const Vec2d slope = (Vec2d(pCamera.x, pCamera.y) - lens) / pCamera.z;
  const Vec2 film = ToFilm(slope + lens / lens_.focalDistance);
  if (!mapping_.IsNear(film)) return std::nullopt;

  const Vec3d w = frame_.Vector({slope.x, slope.y, 1});
  const double length = Length(w);
  const double cosLens = frame_.Height() / length;
  const double distanceSquared = Sqr(pCamera.z * length);
  WiSample sample;
  sample.film = film;
  sample.wi = ToFloat(w * (-1 / length));
  sample.lens = ToFloat(frame_.Point({lens.x, lens.y, 0}));
  sample.isDelta = lens_.radius == 0;
  const double solidAnglePerArea = cosLens / distanceSquared;
  sample.pdf = sample.isDelta ? 1 : 1 / (lensArea_ * solidAnglePerArea);
  sample.We = static_cast<float>(Importance(length) * (sample.isDelta ? solidAnglePerArea : 1));
  if (!std::isfinite(sample.We) || !std::isfinite(sample.pdf)) return std::nullopt;
  return sample;
}

std::optional<PerspectiveCamera::LensRay> PerspectiveCamera::ToLens(const Ray& ray) const {
  const Vec3d d = frame_.VectorToCamera(ray.d);
  if (!(d.z > 0)) return std::nullopt;
  const Vec2d slope(d.x / d.z, d.y / d.z);
  LensRay result;
  if (lens_.radius > 0) {
    const Vec3d o = frame_.PointToCamera(ray.o);
    result.lens = Vec2d(o.x, o.y) - slope * o.z;
  }
  result.film = slope + result.lens / lens_.focalDistance;
  result.length = Length(frame_.Vector({slope.x, slope.y, 1}));
  return result;
}

float PerspectiveCamera::We(const Ray& ray, Vec2* film) const {
  const std::optional<LensRay> lensRay = ToLens(ray);
  if (!lensRay) return 0;
  *film = ToFilm(lensRay->film);
  return mapping_.IsInside(*film) ? static_cast<float>(Importance(lensRay->length)) : 0;
}

WePdf PerspectiveCamera::Pdf_We(const Ray& ray) const {
  const std::optional<LensRay> lensRay = ToLens(ray);
  if (!lensRay || !mapping_.IsInside(ToFilm(lensRay->film))) return {};
  const double length = lensRay->length;
  return {1 / lensArea_, length * length * length / (PlaneArea(mapping_.Area()) * frame_.Volume())};
}

Vec3 PerspectiveCamera::Position() const { return ToFloat(frame_.Point(Vec3d(0))); }

float PerspectiveCamera::Depth(const Vec3& p) const { return static_cast<float>(frame_.PointToCamera(p).z); }

}  // namespace dapple
