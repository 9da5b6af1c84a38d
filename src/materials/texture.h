// Textures: functions over a surface, of a float or a colour.
#pragma once

#include <memory>

#include "src/base/color.h"
#include "src/geometry/interaction.h"

namespace dapple {

/// What a texture may ask of a surface point; render space.
struct TextureContext {
  Vec3 p{0, 0, 0};
  Vec3 n{0, 0, 1};
  Vec2 uv{0, 0};

  TextureContext() = default;
  explicit TextureContext(const Vec2& uv_) : uv(uv_) {}
  explicit TextureContext(const SurfaceInteraction& hit) : p(hit.p), n(hit.ns), uv(hit.uv) {}
};

template <typename T>
class Texture {
 public:
  virtual ~Texture() = default;
  virtual T Evaluate(const TextureContext& at) const = 0;
  /// True where `Evaluate` gives the same everywhere; facts and fast paths follow from it.
  virtual bool IsConstant() const { return false; }
};

using FloatTexture = Texture<float>;
using ColorTexture = Texture<Color>;
using FloatTexturePtr = std::shared_ptr<const FloatTexture>;
using ColorTexturePtr = std::shared_ptr<const ColorTexture>;

template <typename T>
class ConstantTexture final : public Texture<T> {
 public:
  explicit ConstantTexture(const T& value) : value_(value) {}
  T Evaluate(const TextureContext&) const override { return value_; }
  bool IsConstant() const override { return true; }

 private:
  T value_;
};

}  // namespace dapple
