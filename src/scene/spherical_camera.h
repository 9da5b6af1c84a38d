// A camera that sees all directions from one point, laid out on the film by latitude and longitude or by equal areas.
//
// pbrt-v3's "environment" and pbrt-v4's "spherical" (parameter mapping: "equirectangular" or "equalarea"). The middle
// of a latitude-longitude image looks along -x of camera space, and its top along +y, as in pbrt.
#pragma once

#include "src/scene/camera.h"
#include "src/scene/camera_frame.h"

namespace dapple {

enum class SphericalProjection {
  Equirectangular,  ///< phi = 2 pi x / width, theta = pi y / height; w = (sin theta cos phi, cos theta, sin theta sin
                    ///< phi)
  EqualArea,        ///< EqualAreaSquareToSphere, with y and z swapped
};

class SphericalCamera final : public Camera {
 public:
  /// Throws `Error` at `location` where the transform is singular.
  SphericalCamera(const Transform& cameraToRender, const Vec2i& resolution, SphericalProjection mapping,
                  const FileLocation& location = {});

  CameraRay GenerateRay(const Vec2& film, const Vec2d& uLens, double uTime) const override;
  /// No lens has a cosine here: We is per solid angle, over distance^2 in the sample (a discrete origin).
  std::optional<WiSample> Sample_Wi(const Vec3& p, const Vec2d& uLens) const override;
  int FilmRepeats(const Vec2& film, std::array<Vec2, kMostRepeats>* repeats) const override;
  float We(const Ray& ray, Vec2* film) const override;
  WePdf Pdf_We(const Ray& ray) const override;
  Vec3 Position() const override;
  float Depth(const Vec3& p) const override;

 private:
  Vec3d ToDirection(const Vec2& film) const;
  Vec2 ToFilm(const Vec3d& direction) const;
  /// Solid angle of a pixel's area around the unit camera-space direction, in render space.
  double PixelSolidAngle(const Vec3d& direction) const;

  CameraFrame frame_;
  Vec2d resolution_;
  SphericalProjection mapping_;
};

}  // namespace dapple
