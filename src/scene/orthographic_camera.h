// A camera without perspective: parallel rays, or a thin lens at each point of the film (telecentric) that keeps the
// plane at the focal distance sharp.
//
// pbrt's "orthographic": parameters frameaspectratio, screenwindow, lensradius, focaldistance. pbrt moves the origin of
// a lens's ray to the middle of the image, so that its lens makes a perspective; here the view stays orthographic.
#pragma once

#include "src/scene/camera.h"
#include "src/scene/camera_frame.h"
#include "src/scene/perspective_camera.h"

namespace dapple {

class OrthographicCamera final : public Camera {
 public:
  /// `window` is in units of camera space. Throws `Error` at `location` where a number makes no sense.
  OrthographicCamera(const Transform& cameraToRender, const Vec2i& resolution, const ScreenWindow& window,
                     const ThinLens& lens = {}, const FileLocation& location = {});

  CameraRay GenerateRay(const Vec2& film, const Vec2d& uLens, double uTime) const override;
  /// Without a lens the one direction is discrete: We is then per pixel area alone.
  std::optional<WiSample> Sample_Wi(const Vec3& p, const Vec2d& uLens) const override;
  /// Without a lens the ray is taken to run along the view, and We is per area across it.
  float We(const Ray& ray, Vec2* film) const override;
  /// Position: per area of the film plane. Direction: 1 without a lens.
  WePdf Pdf_We(const Ray& ray) const override;
  Vec3 Position() const override;
  float Depth(const Vec3& p) const override;

 private:
  bool HasLens() const { return lens_.radius > 0; }
  /// Density of a slope d.xy (d.z = 1) that a lens sends rays along.
  double SlopePdf() const { return Sqr(lens_.focalDistance) / (kPiD * Sqr(lens_.radius)); }
  /// Importance along M d, of the length given.
  double Importance(double length) const;
  /// The film position of a ray that crosses the film plane at `onPlane` with this slope.
  Vec2 ToFilm(const Vec2d& onPlane, const Vec2d& slope) const;
  struct LensRay {
    Vec2 film;
    double length;
  };
  std::optional<LensRay> ToLens(const Ray& ray) const;

  CameraFrame frame_;
  FilmMapping mapping_;
  ThinLens lens_;
};

}  // namespace dapple
