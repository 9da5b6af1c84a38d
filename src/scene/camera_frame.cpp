#include "src/scene/camera_frame.h"

#include <cassert>

#include "src/scene/camera.h"

namespace dapple {

ScreenWindow ScreenWindow::FromAspect(double aspect) {
  if (aspect > 1) return {-aspect, aspect, -1, 1};
  return {-1, 1, -1 / aspect, 1 / aspect};
}

FilmMapping::FilmMapping(const ScreenWindow& window, const Vec2i& resolution)
    : x0_(window.xMin),
      y0_(window.yMax),
      dx_((window.xMax - window.xMin) / resolution.x),
      dy_((window.yMin - window.yMax) / resolution.y),
      width_(static_cast<float>(resolution.x)),
      height_(static_cast<float>(resolution.y)) {
  assert(dx_ != 0 && dy_ != 0 && std::isfinite(dx_) && std::isfinite(dy_));
}

bool FilmMapping::IsNear(const Vec2& film) const { return IsInside(film, kFilmMargin); }

CameraFrame::CameraFrame(const Transform& cameraToRender, const FileLocation& location)
    : cameraToRender_(cameraToRender), renderToCamera_(cameraToRender.Inverse()) {
  const bool isAffine = cameraToRender.At(3, 0) == 0 && cameraToRender.At(3, 1) == 0 && cameraToRender.At(3, 2) == 0;
  if (!isAffine || cameraToRender.IsSingular())
    throw Error(location,
                "the camera's transform is singular: expected one that can be inverted (in LookAt, the eye and "
                "the point looked at differ, and \"up\" is not along the view)");
  const Vec3d x = Vector({1, 0, 0}), y = Vector({0, 1, 0}), z = Vector({0, 0, 1});
  const Vec3d xy = Cross(x, y);
  volume_ = std::abs(Dot(xy, z));
  lensArea_ = Length(xy);
}

Ray CameraFrame::MakeRay(const Vec3d& o, const Vec3d& d, double time) const {
  Ray ray{ToFloat(Point(o)), ToFloat(Normalize(Vector(d))), kInfinity, {}};
  ray.state.time = static_cast<float>(time);
  return ray;
}

}  // namespace dapple
