// A camera with perspective: a pinhole, or a thin lens focused at a distance (Pharr et al. 2023, sections 5.2
// and 16.1).
//
// pbrt's "perspective": parameters fov, frameaspectratio, screenwindow, lensradius, focaldistance.
#pragma once

#include "src/scene/camera.h"
#include "src/scene/camera_frame.h"

namespace dapple {

/// A thin lens in camera space. Radius 0: a pinhole. What lies in the plane z = focalDistance is sharp.
struct ThinLens {
  double radius = 0;
  double focalDistance = 1e6;
};

class PerspectiveCamera final : public Camera {
 public:
  /// `fovDegrees` in (0, 180) is the full angle between the screen's -1 and 1: that of the shorter side for pbrt's own
  /// window. `resolution` is that of the whole image. Throws `Error` at `location` where a number makes no sense.
  PerspectiveCamera(const Transform& cameraToRender, const Vec2i& resolution, const ScreenWindow& window,
                    double fovDegrees, const ThinLens& lens = {}, const FileLocation& location = {});

  CameraRay GenerateRay(const Vec2& film, const Vec2d& uLens, double uTime) const override;
  std::optional<WiSample> Sample_Wi(const Vec3& p, const Vec2d& uLens) const override;
  float We(const Ray& ray, Vec2* film) const override;
  WePdf Pdf_We(const Ray& ray) const override;
  Vec3 Position() const override;
  float Depth(const Vec3& p) const override;

 private:
  /// A ray in camera space: where it passes the lens, and the screen point it shows (its slope, for a pinhole).
  struct LensRay {
    Vec2d lens{0, 0};
    Vec2d film;     // on the plane z = 1, seen from the lens's centre
    double length;  // |M d| in render space of its direction d with d.z = 1
  };
  std::optional<LensRay> ToLens(const Ray& ray) const;
  Vec3d Direction(const Vec2d& lens, const Vec2d& film) const;
  double Importance(double length) const;
  Vec2 ToFilm(const Vec2d& film) const { return mapping_.ToFilm(film / tanHalfFov_); }
  double PlaneArea(double screenArea) const { return screenArea * tanHalfFov_ * tanHalfFov_; }

  CameraFrame frame_;
  FilmMapping mapping_;
  double tanHalfFov_;
  ThinLens lens_;
  double lensArea_;  // in render space; 1 for a pinhole
};

}  // namespace dapple
