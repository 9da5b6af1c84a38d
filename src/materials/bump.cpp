#include "src/materials/bump.h"

#include <cassert>
#include <utility>

#include "src/materials/image_texture.h"

namespace dapple {
namespace {

/// The frame of a detailed normal and tangent; the smooth one where they are degenerate.
Frame FrameOrSmooth(const SurfaceInteraction& hit, const Vec3& normal, const Vec3& tangent) {
  const float lengthSquared = LengthSquared(normal);
  if (!(lengthSquared > 0) || !std::isfinite(lengthSquared) || !IsFinite(tangent)) return SmoothShadingFrame(hit);
  return Frame::FromZX(FaceForward(normal * (1 / std::sqrt(lengthSquared)), hit.ng), tangent);
}

}  // namespace

BumpMap::BumpMap(FloatTexturePtr displacement) : displacement_(std::move(displacement)) { assert(displacement_); }

Frame BumpMap::ShadingFrame(const SurfaceInteraction& hit) const {
  constexpr float kStep = 0.0005f;
  const TextureContext here(hit);
  const float displacement = displacement_->Evaluate(here);
  const auto tangent = [&](int axis, const Vec3& dp, const Vec3& dn) {
    TextureContext shifted = here;
    shifted.uv[axis] += kStep;
    const float step = shifted.uv[axis] - here.uv[axis];  // what is left of kStep after rounding
    if (!(step > 0)) return dp;
    shifted.p += dp * step;
    shifted.n = Normalize(hit.ns + dn * step);
    const float slope = (displacement_->Evaluate(shifted) - displacement) / step;
    return dp + hit.ns * slope + dn * displacement;
  };
  const Vec3 dpdu = tangent(0, hit.dpdus, hit.dndu), dpdv = tangent(1, hit.dpdvs, hit.dndv);
  // Unit tangents first: their product neither overflows nor vanishes, whatever the scale of the scene.
  return FrameOrSmooth(hit, Cross(Normalize(dpdu), Normalize(dpdv)), dpdu);
}

NormalMap::NormalMap(std::shared_ptr<const Image> image, const FileLocation& location) : image_(std::move(image)) {
  if (image_->Width() == 0 || image_->Height() == 0 || image_->IsGray()) {
    throw Error(location, "the normal map is empty or gray; expected an image with channels R, G and B");
  }
}

Frame NormalMap::ShadingFrame(const SurfaceInteraction& hit) const {
  const Color texel = FilterImage(*image_, hit.uv, WrapMode::kRepeat, ImageFilter::kBilinear,
                                  [this](int x, int y) { return image_->ColorAt(x, y); });
  const Vec3 local(2 * texel.r - 1, 2 * texel.g - 1, 2 * texel.b - 1);
  const Frame smooth = SmoothShadingFrame(hit);
  return FrameOrSmooth(hit, smooth.ToWorld(local), hit.dpdus);
}

}  // namespace dapple
