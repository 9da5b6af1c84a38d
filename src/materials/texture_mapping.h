// From a surface point to the coordinates (s, t) of a texture (pbrt-v3, section 10.2; pbrt-v4, section 10.2).
#pragma once

#include <memory>

#include "src/base/transform.h"
#include "src/materials/texture.h"

namespace dapple {

class TextureMapping {
 public:
  virtual ~TextureMapping() = default;
  virtual Vec2 Map(const TextureContext& at) const = 0;
};

using TextureMappingPtr = std::shared_ptr<const TextureMapping>;

/// (su u + du, sv v + dv): pbrt's "uv", with its parameters "uscale", "vscale", "udelta", "vdelta".
class UvMapping final : public TextureMapping {
 public:
  explicit UvMapping(const Vec2& scale = Vec2(1), const Vec2& delta = Vec2(0)) : scale_(scale), delta_(delta) {}
  Vec2 Map(const TextureContext& at) const override { return scale_ * at.uv + delta_; }

 private:
  Vec2 scale_, delta_;
};

/// (v1 . p + udelta, v2 . p + vdelta) for p in texture space: pbrt's "planar".
class PlanarMapping final : public TextureMapping {
 public:
  /// `textureFromRender`: from render space to the space of `v1` and `v2`. In pbrt-v3 that is world space, in pbrt-v4
  /// the space in which the texture was declared.
  PlanarMapping(const Transform& textureFromRender, const Vec3d& v1, const Vec3d& v2, const Vec2d& delta);
  Vec2 Map(const TextureContext& at) const override;

 private:
  // Rows of the affine map from render space to (s, t).
  Vec3d s_, t_;
  Vec2d offset_;
};

/// (theta / pi, phi / 2 pi) of the direction from the origin of texture space: pbrt's "spherical". (0, 0) at the origin
/// itself.
class SphericalMapping final : public TextureMapping {
 public:
  explicit SphericalMapping(const Transform& textureFromRender) : textureFromRender_(textureFromRender) {}
  Vec2 Map(const TextureContext& at) const override;

 private:
  Transform textureFromRender_;
};

/// ((pi + phi) / 2 pi, z) in texture space: pbrt's "cylindrical".
class CylindricalMapping final : public TextureMapping {
 public:
  /// z of the point itself (pbrt-v4), or of the direction to it from the origin (pbrt-v3).
  enum class Height { kPoint, kDirection };

  CylindricalMapping(const Transform& textureFromRender, Height height)
      : textureFromRender_(textureFromRender), height_(height) {}
  Vec2 Map(const TextureContext& at) const override;

 private:
  Transform textureFromRender_;
  Height height_;
};

}  // namespace dapple
