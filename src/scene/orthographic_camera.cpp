#include "src/scene/orthographic_camera.h"

#include <fmt/format.h>

#include "src/sampling/warps.h"

// Measures, as in perspective_camera.cpp: for d.z = 1 and w = M d, solid angle is |det M| / |w|^3 per area of slopes,
// and cos dA dw at the film plane is det^2 / |w|^4 per area of camera-space positions and slopes.
namespace dapple {

OrthographicCamera::OrthographicCamera(const Transform& cameraToRender, const Vec2i& resolution,
                                       const ScreenWindow& window, const ThinLens& lens, const FileLocation& location)
    : frame_(cameraToRender, location), mapping_(window, resolution), lens_(lens) {
  if (!(lens.radius >= 0) || !(lens.focalDistance > 0))
    throw Error(location, fmt::format("lens of radius {} focused at {}: expected a radius of 0 or more and a positive "
                                      "distance",
                                      lens.radius, lens.focalDistance));
}

CameraRay OrthographicCamera::GenerateRay(const Vec2& film, const Vec2d& uLens, double uTime) const {
  const Vec2d screen = mapping_.ToScreen(film);
  const Vec2d lens = HasLens() ? SampleDiskConcentric(uLens) * lens_.radius : Vec2d(0);
  const Vec2d slope = lens / -lens_.focalDistance;
  const Vec2d o = screen + lens;
  CameraRay result;
  result.ray = frame_.MakeRay({o.x, o.y, 0}, {slope.x, slope.y, 1}, uTime);
  const double acrossView = frame_.Volume() / Length(frame_.Vector({0, 0, 1}));
  result.footprintAtLens = static_cast<float>(std::sqrt(mapping_.PixelArea() * acrossView));
  return result;
}

double OrthographicCamera::Importance(double length) const {
  if (!HasLens()) return length / (mapping_.PixelArea() * frame_.Volume());
  return SlopePdf() * Sqr(Sqr(length)) / (mapping_.PixelArea() * Sqr(frame_.Volume()));
}

Vec2 OrthographicCamera::ToFilm(const Vec2d& onPlane, const Vec2d& slope) const {
  return mapping_.ToFilm(HasLens() ? onPlane + slope * lens_.focalDistance : onPlane);
}

std::optional<WiSample> OrthographicCamera::Sample_Wi(const Vec3& p, const Vec2d& uLens) const {
  const Vec3d pCamera = frame_.PointToCamera(p);
  if (!(pCamera.z > 0)) return std::nullopt;
  const Vec2d lens = HasLens() ? SampleDiskConcentric(uLens) * lens_.radius : Vec2d(0);
  const Vec2d slope = lens / -lens_.focalDistance;
  const Vec2d o = Vec2d(pCamera.x, pCamera.y) - slope * pCamera.z;
  WiSample sample;
  sample.film = ToFilm(o, slope);
  if (!mapping_.IsNear(sample.film)) return std::nullopt;

  const Vec3d w = frame_.Vector({slope.x, slope.y, 1});
  const double length = Length(w);
  sample.wi = ToFloat(w * (-1 / length));
  sample.lens = ToFloat(frame_.Point({o.x, o.y, 0}));
  sample.isDelta = !HasLens();
  sample.pdf = HasLens() ? SlopePdf() * length * length * length / frame_.Volume() : 1;
  sample.We = static_cast<float>(Importance(length));
  return sample;
}

std::optional<OrthographicCamera::LensRay> OrthographicCamera::ToLens(const Ray& ray) const {
  const Vec3d d = frame_.VectorToCamera(ray.d);
  if (!(d.z > 0)) return std::nullopt;
  const Vec3d o = frame_.PointToCamera(ray.o);
  const Vec2d slope = HasLens() ? Vec2d(d.x / d.z, d.y / d.z) : Vec2d(0);
  const Vec2 film = ToFilm(Vec2d(o.x, o.y) - slope * o.z, slope);
  if (!mapping_.IsInside(film)) return std::nullopt;
  return LensRay{film, Length(frame_.Vector({slope.x, slope.y, 1}))};
}

float OrthographicCamera::We(const Ray& ray, Vec2* film) const {
  const std::optional<LensRay> lensRay = ToLens(ray);
  if (!lensRay) return 0;
  *film = lensRay->film;
  return static_cast<float>(Importance(lensRay->length));
}

WePdf OrthographicCamera::Pdf_We(const Ray& ray) const {
  const std::optional<LensRay> lensRay = ToLens(ray);
  if (!lensRay) return {};
  const double length = lensRay->length;
  const double direction = HasLens() ? SlopePdf() * length * length * length / frame_.Volume() : 1;
  return {1 / (mapping_.Area() * frame_.LensArea()), direction};
}

Vec3 OrthographicCamera::Position() const { return ToFloat(frame_.Point(Vec3d(0))); }

float OrthographicCamera::Depth(const Vec3& p) const { return static_cast<float>(frame_.PointToCamera(p).z); }

}  // namespace dapple
