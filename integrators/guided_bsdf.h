// A surface whose scattered directions are drawn in part where its photons came from, and else by its BSDF: one sample
// of two techniques by multiple importance sampling (Veach 1997, section 9.2.4), so no direction is starved. A BSDF of
// its own where there is no table.
#pragma once

#include "integrators/camera_path.h"
#include "src/base/frame.h"
#include "src/photons/gather_guide.h"

namespace dapple {

class GuidedBsdf {
 public:
  /// `table`: of the side from which the surface is seen; null: none. All must outlive this.
  GuidedBsdf(const SurfaceInteraction& hit, const Bsdf& bsdf, const DirectionTable* table)
      : hit_(hit), bsdf_(bsdf), table_(table), share_(table ? table->Share() : 0) {
    if (share_ > 0) frame_ = GatherGuide::FrameAround(FaceForward(hit.ng, hit.wo));
  }

  /// Per solid angle, of all directions that are not specular.
  float Pdf(const Vec3& wi) const {
    const float byBsdf = bsdf_.Pdf(hit_.wo, wi, TransportMode::Radiance);
    return share_ > 0 ? (1 - share_) * byBsdf + share_ * table_->Pdf(frame_.ToLocal(wi)) : byBsdf;
  }

  /// The way on of a camera path, as `SampleWayOn`.
  std::optional<BsdfSample> Sample(const Scene& scene, double uLobe, const Vec2d& uDirection, PassStats& stats) const {
    if (!(share_ > 0)) return SampleWayOn(scene, hit_, bsdf_, uLobe, uDirection, stats);
    const auto share = static_cast<double>(share_);
    std::optional<BsdfSample> next;
    if (uLobe < share) {
      next.emplace();
      next->wi = Normalize(frame_.ToWorld(table_->Sample(uDirection)));
      next->flags = LobeFlags::kDiffuseReflection;
    } else {
      next = SampleWayOn(scene, hit_, bsdf_, (uLobe - share) / (1 - share), uDirection, stats);
      if (!next) return next;
    }
    if (next->IsSpecular()) {
      next->pdf *= 1 - share_;
      next->weight /= 1 - share_;
      return next;
    }
    next->pdf = Pdf(next->wi);
    // Rounding may carry a direction into a cell that nothing is drawn in.
    if (!(next->pdf > 0)) return std::nullopt;
    next->weight = bsdf_.Eval(hit_.wo, next->wi, TransportMode::Radiance) / next->pdf;
    if (!next->weight.IsFinite()) stats.nonFinite.Add(NonFiniteSource::MaterialAt(scene, hit_));
    if (!next->weight.IsFinite() || next->weight.IsBlack()) return std::nullopt;
    return next;
  }

 private:
  const SurfaceInteraction& hit_;
  const Bsdf& bsdf_;
  const DirectionTable* table_;
  float share_;
  Frame frame_;
};

}  // namespace dapple
