// What all cameras share: the film's place on the screen, and camera space within render space.
//
// Camera space is pbrt's: x right, y up, z into the scene (left-handed). The transform from it may be any affine one
// that is not singular, so densities carry the factors by which it stretches areas and angles. All in double.
#pragma once

#include "src/base/error.h"
#include "src/base/transform.h"
#include "src/base/vec.h"
#include "src/geometry/ray.h"

namespace dapple {

/// The rectangle of screen space that the image shows.
struct ScreenWindow {
  double xMin = -1, xMax = 1, yMin = -1, yMax = 1;

  /// [-1, 1] along the shorter side, wider along the other by `aspect` = width / height (pbrt's rule).
  static ScreenWindow FromAspect(double aspect);
};

/// Between film positions (pixels, y down) and points of the screen (y up).
class FilmMapping {
 public:
  /// `window` may be turned around (xMin > xMax mirrors, as in pbrt) but not empty.
  FilmMapping(const ScreenWindow& window, const Vec2i& resolution);

  /// Between a film position in pixels and the screen's point; affine, so both work outside the image too.
  Vec2d ToScreen(const Vec2& film) const { return {x0_ + film.x * dx_, y0_ + film.y * dy_}; }
  Vec2 ToFilm(const Vec2d& screen) const {
    return {static_cast<float>((screen.x - x0_) / dx_), static_cast<float>((screen.y - y0_) / dy_)};
  }
  /// Area of one pixel on the screen; of the whole image.
  double PixelArea() const { return std::abs(dx_ * dy_); }
  double Area() const { return PixelArea() * width_ * height_; }
  /// True where a film position lies on the image.
  bool IsInside(const Vec2& film) const { return IsInside(film, 0); }
  /// True where a splat at this position may touch the image, whatever the filter. False for NaN.
  bool IsNear(const Vec2& film) const;

 private:
  bool IsInside(const Vec2& film, float margin) const {
    return film.x >= -margin && film.x <= width_ + margin && film.y >= -margin && film.y <= height_ + margin;
  }

  double x0_, y0_, dx_, dy_;
  float width_, height_;
};

/// Camera space within render space.
class CameraFrame {
 public:
  /// Throws `Error` at `location` where the transform is singular or not affine.
  explicit CameraFrame(const Transform& cameraToRender, const FileLocation& location = {});

  /// From camera space to render space, and back.
  Vec3d Point(const Vec3d& p) const { return cameraToRender_.Point(p); }
  Vec3d Vector(const Vec3d& v) const { return cameraToRender_.Vector(v); }
  Vec3d PointToCamera(const Vec3& p) const { return renderToCamera_.Point(ToDouble(p)); }
  Vec3d VectorToCamera(const Vec3& v) const { return renderToCamera_.Vector(ToDouble(v)); }

  /// Volume stretch |det M|; area stretch of the lens plane |Mx x My|; and their ratio, the height of M (0,0,1) over
  /// the lens plane. All 1 for rigid transforms.
  double Volume() const { return volume_; }
  double LensArea() const { return lensArea_; }
  double Height() const { return volume_ / lensArea_; }

  /// A ray from the camera-space point `o` along the camera-space vector `d`.
  Ray MakeRay(const Vec3d& o, const Vec3d& d, double time) const;

 private:
  Transform cameraToRender_, renderToCamera_;
  double volume_, lensArea_;
};

}  // namespace dapple
