// Textures made of other textures or of arithmetic: scale, mix, checkerboard, bilerp, dots (pbrt-v3, chapter 10).
//
// The `Make...` functions give a constant where the result is one, so that facts and fast paths see it; use them rather
// than the classes. T is float or `Color`.
#pragma once

#include <cassert>
#include <cmath>
#include <memory>
#include <utility>

#include "src/base/numerics.h"
#include "src/base/transform.h"
#include "src/materials/texture.h"
#include "src/materials/texture_mapping.h"

namespace dapple {

template <typename T>
using TexturePtr = std::shared_ptr<const Texture<T>>;

template <typename T>
TexturePtr<T> MakeConstant(const T& value) {
  return std::make_shared<ConstantTexture<T>>(value);
}

/// `texture`, or the constant that it is.
template <typename T>
TexturePtr<T> FoldConstant(TexturePtr<T> texture) {
  return texture->IsConstant() ? MakeConstant(texture->Evaluate(TextureContext())) : texture;
}

// Products and mixtures find out once, when they are made, whether they are constant: asked of the parts at each call,
// it would take twice the time with each level of nesting.

/// a(p) * b(p); S is T or float.
template <typename T, typename S>
class ScaleTexture final : public Texture<T> {
 public:
  ScaleTexture(TexturePtr<T> a, TexturePtr<S> b)
      : a_(std::move(a)),
        b_(std::move(b)),
        isConstant_((a_->IsConstant() && b_->IsConstant()) || IsZero(*a_) || IsZero(*b_)) {}
  T Evaluate(const TextureContext& at) const override { return a_->Evaluate(at) * b_->Evaluate(at); }
  /// Also where one factor is zero everywhere.
  bool IsConstant() const override { return isConstant_; }

 private:
  template <typename U>
  static bool IsZero(const Texture<U>& texture) {
    return texture.IsConstant() && texture.Evaluate(TextureContext()) == U(0);
  }

  TexturePtr<T> a_;
  TexturePtr<S> b_;
  bool isConstant_;
};

/// (1 - amount) a + amount b; `amount` is not clamped.
template <typename T>
class MixTexture final : public Texture<T> {
 public:
  MixTexture(TexturePtr<T> a, TexturePtr<T> b, FloatTexturePtr amount)
      : a_(std::move(a)), b_(std::move(b)), amount_(std::move(amount)), isConstant_(IsSameEverywhere()) {}
  T Evaluate(const TextureContext& at) const override {
    const float amount = amount_->Evaluate(at);
    if (amount == 0) return a_->Evaluate(at);
    if (amount == 1) return b_->Evaluate(at);
    return a_->Evaluate(at) * (1 - amount) + b_->Evaluate(at) * amount;
  }
  bool IsConstant() const override { return isConstant_; }

 private:
  bool IsSameEverywhere() const {
    if (!amount_->IsConstant()) return false;
    const float amount = amount_->Evaluate(TextureContext());
    return (amount == 1 || a_->IsConstant()) && (amount == 0 || b_->IsConstant());
  }

  TexturePtr<T> a_, b_;
  FloatTexturePtr amount_;
  bool isConstant_;
};

/// True in the cells of the unit grid whose integer coordinates have an even sum; false for NaN and infinity.
inline bool IsEvenCell(float cellSum) { return cellSum - 2 * std::floor(cellSum * 0.5f) == 0; }

/// `even` in the cells of the (s, t) grid whose floor(s) + floor(t) is even, `odd` in the others. Point sampled.
template <typename T>
class CheckerboardTexture final : public Texture<T> {
 public:
  CheckerboardTexture(TextureMappingPtr mapping, TexturePtr<T> even, TexturePtr<T> odd)
      : mapping_(std::move(mapping)), even_(std::move(even)), odd_(std::move(odd)) {
    assert(mapping_ && even_ && odd_);
  }
  T Evaluate(const TextureContext& at) const override {
    const Vec2 st = mapping_->Map(at);
    return (IsEvenCell(std::floor(st.x) + std::floor(st.y)) ? even_ : odd_)->Evaluate(at);
  }

 private:
  TextureMappingPtr mapping_;
  TexturePtr<T> even_, odd_;
};

/// The same in the unit cubes of texture space.
template <typename T>
class Checkerboard3Texture final : public Texture<T> {
 public:
  Checkerboard3Texture(const Transform& textureFromRender, TexturePtr<T> even, TexturePtr<T> odd)
      : textureFromRender_(textureFromRender), even_(std::move(even)), odd_(std::move(odd)) {
    assert(even_ && odd_);
  }
  T Evaluate(const TextureContext& at) const override {
    const Vec3 p = ToFloat(textureFromRender_.Point(ToDouble(at.p)));
    return (IsEvenCell(std::floor(p.x) + std::floor(p.y) + std::floor(p.z)) ? even_ : odd_)->Evaluate(at);
  }

 private:
  Transform textureFromRender_;
  TexturePtr<T> even_, odd_;
};

/// The bilinear function with the value vST at (s, t) = (S, T), continued beyond the unit square.
template <typename T>
class BilerpTexture final : public Texture<T> {
 public:
  BilerpTexture(TextureMappingPtr mapping, const T& v00, const T& v01, const T& v10, const T& v11)
      : mapping_(std::move(mapping)), v00_(v00), v01_(v01), v10_(v10), v11_(v11) {
    assert(mapping_);
  }
  T Evaluate(const TextureContext& at) const override {
    const Vec2 st = mapping_->Map(at);
    return Lerp(st.x, Lerp(st.y, v00_, v01_), Lerp(st.y, v10_, v11_));
  }
  bool IsConstant() const override { return v00_ == v01_ && v00_ == v10_ && v00_ == v11_; }

 private:
  TextureMappingPtr mapping_;
  T v00_, v01_, v10_, v11_;
};

/// Perlin's gradient noise (Perlin 2002, with the gradients of pbrt): 0 at the integer points, within [-1, 1]. 0 where
/// |p| is so large that its cells cannot be told apart.
float Noise(const Vec3& p);

/// True in a disk of radius 0.35 somewhere in the cell of (s, t), in some 40 % of the cells: pbrt's "dots".
bool IsInsideDot(const Vec2& st);

template <typename T>
class DotsTexture final : public Texture<T> {
 public:
  DotsTexture(TextureMappingPtr mapping, TexturePtr<T> inside, TexturePtr<T> outside)
      : mapping_(std::move(mapping)), inside_(std::move(inside)), outside_(std::move(outside)) {
    assert(mapping_ && inside_ && outside_);
  }
  T Evaluate(const TextureContext& at) const override {
    return (IsInsideDot(mapping_->Map(at)) ? inside_ : outside_)->Evaluate(at);
  }

 private:
  TextureMappingPtr mapping_;
  TexturePtr<T> inside_, outside_;
};

// Products and mixtures, folded. No pointer may be null.

inline FloatTexturePtr MakeScale(FloatTexturePtr a, FloatTexturePtr b) {
  return FoldConstant<float>(std::make_shared<ScaleTexture<float, float>>(std::move(a), std::move(b)));
}
inline ColorTexturePtr MakeScale(ColorTexturePtr a, ColorTexturePtr b) {
  return FoldConstant<Color>(std::make_shared<ScaleTexture<Color, Color>>(std::move(a), std::move(b)));
}
inline ColorTexturePtr MakeScale(ColorTexturePtr a, FloatTexturePtr b) {
  return FoldConstant<Color>(std::make_shared<ScaleTexture<Color, float>>(std::move(a), std::move(b)));
}

template <typename T>
TexturePtr<T> MakeMix(TexturePtr<T> a, TexturePtr<T> b, FloatTexturePtr amount) {
  return FoldConstant<T>(std::make_shared<MixTexture<T>>(std::move(a), std::move(b), std::move(amount)));
}

template <typename T>
TexturePtr<T> MakeBilerp(TextureMappingPtr mapping, const T& v00, const T& v01, const T& v10, const T& v11) {
  return FoldConstant<T>(std::make_shared<BilerpTexture<T>>(std::move(mapping), v00, v01, v10, v11));
}

}  // namespace dapple
