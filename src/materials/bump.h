// Surface detail finer than the geometry: bump maps (a displacement) and normal maps turn the shading frame.
//
// A material that has a `SurfaceDetail` asks it for the frame at each hit, in place of the one of `ns` and `dpdus`.
#pragma once

#include <memory>

#include "src/base/error.h"
#include "src/base/frame.h"
#include "src/geometry/interaction.h"
#include "src/image/image.h"
#include "src/materials/texture.h"

namespace dapple {

/// The shading frame without any detail: n = `hit.ns`, s as near to `hit.dpdus` as can be.
inline Frame SmoothShadingFrame(const SurfaceInteraction& hit) { return Frame::FromZX(hit.ns, hit.dpdus); }

class SurfaceDetail {
 public:
  virtual ~SurfaceDetail() = default;
  /// The frame that BSDFs work in at `hit`, in render space: orthonormal and finite, n in the hemisphere of `hit.ng`,
  /// s along the first tangent of the detailed surface. Where the detail is degenerate: `SmoothShadingFrame`.
  virtual Frame ShadingFrame(const SurfaceInteraction& hit) const = 0;
};

using SurfaceDetailPtr = std::shared_ptr<const SurfaceDetail>;

/// The normal of the surface moved along its shading normal by `displacement`, in scene units (Blinn 1978; pbrt-v3,
/// section 9.3). Derivatives are differences over 0.0005 in u and v, pbrt's step where it knows no pixel footprint.
class BumpMap final : public SurfaceDetail {
 public:
  explicit BumpMap(FloatTexturePtr displacement);
  Frame ShadingFrame(const SurfaceInteraction& hit) const override;

 private:
  FloatTexturePtr displacement_;
};

/// Normals from an image: 2 (R, G, B) - 1 in the frame of `dpdus` and `ns`, bilinear, repeated (pbrt-v4,
/// section 10.5.3). The image must have been read with `ColorEncoding::Linear()`; its first row is at v = 1.
class NormalMap final : public SurfaceDetail {
 public:
  /// Throws `Error` at `location` where the image is empty or gray.
  explicit NormalMap(std::shared_ptr<const Image> image, const FileLocation& location = {});
  Frame ShadingFrame(const SurfaceInteraction& hit) const override;

 private:
  std::shared_ptr<const Image> image_;
};

}  // namespace dapple
