#include "src/materials/bsdf.h"

#include <array>
#include <new>

#include "src/base/numerics.h"

namespace dapple {

Bsdf::Bsdf(const SurfaceInteraction& hit) : Bsdf(hit, Frame::FromZX(hit.ns, hit.dpdus)) {}

Bsdf::Bsdf(const SurfaceInteraction& hit, const Frame& shading)
    : shading_(shading), ng_(hit.ng), ngLocal_(shading.ToLocal(hit.ng)), isFlat_(hit.ng == shading.n) {}

void Bsdf::Add(const Lobe& lobe, const Color& scale) {
  const Color albedo = std::visit([](const auto& l) { return l.Albedo(Vec3(0, 0, 1)); }, lobe) * scale;
  if (albedo.IsBlack()) return;
  // Lambertian reflections are summed: mixed matte surfaces stay on the fast path.
  const auto* added = std::get_if<LambertianReflection>(&lobe);
  auto* present = count_ > 0 ? std::get_if<LambertianReflection>(&lobes_[0].lobe) : nullptr;
  if (added && present) {
    present->albedo += added->albedo * scale;
  } else {
    assert(count_ < kMaxLobes);
    if (added) {
      new (&lobes_[count_++]) WeightedLobe{LambertianReflection{albedo}, Color(1)};
    } else {
      new (&lobes_[count_++]) WeightedLobe{lobe, scale};
    }
  }
  flags_ |= std::visit([](const auto& l) { return l.Flags(); }, lobe);
  const auto* only = count_ == 1 ? std::get_if<LambertianReflection>(&lobes_[0].lobe) : nullptr;
  isLambertian_ = only != nullptr;
  if (isLambertian_) lambertian_ = only->albedo * kInvPi;
}

void Bsdf::Add(const Bsdf& other, const Color& scale) {
  for (int i = 0; i < other.count_; ++i) Add(other.lobes_[i].lobe, other.lobes_[i].scale * scale);
}

float Bsdf::MinRoughness() const {
  float roughness = 1;
  for (int i = 0; i < count_; ++i) {
    std::visit(
        [&](const auto& l) {
          if (l.Flags().HasNonSpecular()) roughness = std::min(roughness, l.Roughness());
        },
        lobes_[i].lobe);
  }
  return roughness;
}

Bsdf::Sided Bsdf::ToSided(const Vec3& w) const {
  Vec3 local = shading_.ToLocal(w);
  if (isFlat_) return {local, local.z, false};
  const float cosGeometric = Dot(w, ng_);
  const bool isMirrored = (cosGeometric > 0) != (local.z > 0);
  if (isMirrored) local.z = -local.z;
  return {local, cosGeometric, isMirrored};
}

Bsdf::Preimages Bsdf::PreimagesOf(const Vec3& local) const {
  if (isFlat_) return {true, false};
  const float along = local.x * ngLocal_.x + local.y * ngLocal_.y, up = local.z * ngLocal_.z;
  return local.z > 0 ? Preimages{along + up > 0, along - up > 0} : Preimages{along + up < 0, along - up < 0};
}

float Bsdf::CosineFactor(const Sided& wo, const Sided& wi, TransportMode mode) const {
  if (mode == TransportMode::Radiance || isFlat_) return AbsCosTheta(wi.local);
  return AbsCosTheta(wo.local) * std::abs(wi.cosGeometric / wo.cosGeometric);
}

Color Bsdf::ValueOfLobes(const Vec3& wo, const Vec3& wi, TransportMode mode) const {
  Color sum;
  for (int i = 0; i < count_; ++i) {
    sum += std::visit([&](const auto& l) { return l.Value(wo, wi, mode); }, lobes_[i].lobe) * lobes_[i].scale;
  }
  return sum;
}

bool Bsdf::LobeProbabilities(const Vec3& wo, float* probabilities) const {
  float sum = 0;
  for (int i = 0; i < count_; ++i) {
    const Color albedo = std::visit([&](const auto& l) { return l.Albedo(wo); }, lobes_[i].lobe);
    probabilities[i] = (albedo * lobes_[i].scale).MaxComponent();
    sum += probabilities[i];
  }
  if (!(sum > 0)) return false;
  for (int i = 0; i < count_; ++i) probabilities[i] /= sum;
  return true;
}

float Bsdf::PdfOfLobes(const Vec3& wo, const Vec3& wi) const {
  const auto pdfOf = [&](int i) { return std::visit([&](const auto& l) { return l.Pdf(wo, wi); }, lobes_[i].lobe); };
  if (count_ == 1) return pdfOf(0);
  std::array<float, kMaxLobes> probabilities = {};
  if (!LobeProbabilities(wo, probabilities.data())) return 0;
  float sum = 0;
  for (int i = 0; i < count_; ++i) {
    if (probabilities[i] > 0) sum += probabilities[i] * pdfOf(i);
  }
  return sum;
}

Color Bsdf::EvalLobes(const Vec3& wo, const Vec3& wi, TransportMode mode) const {
  if (!flags_.HasNonSpecular()) return Color();
  const Sided o = ToSided(wo), i = ToSided(wi);
  if (!o.IsValid() || !i.IsValid()) return Color();
  return ValueOfLobes(o.local, i.local, mode) * CosineFactor(o, i, mode);
}

float Bsdf::Pdf(const Vec3& wo, const Vec3& wi, TransportMode) const {
  if (!flags_.HasNonSpecular()) return 0;
  const Sided o = ToSided(wo), i = ToSided(wi);
  if (!o.IsValid() || !i.IsValid()) return 0;
  const float pdf = PdfOfLobes(o.local, i.local);
  return PreimagesOf(i.local).Count() == 2 ? pdf / 2 : pdf;
}

std::optional<BsdfSample> Bsdf::Sample(const Vec3& wo, double uc, const Vec2d& u, TransportMode mode) const {
  if (count_ == 0) return std::nullopt;
  const Sided o = ToSided(wo);
  if (!o.IsValid()) return std::nullopt;

  // Bits of uc: first which of two preimages, then the lobe, then the lobe's own branch.
  double uMirror = 0;
  if (!isFlat_) {
    uMirror = uc;
    uc = uc < 0.5 ? 2 * uc : 2 * uc - 1;
  }
  int chosen = 0;
  float probability = 1;
  if (count_ > 1) {
    std::array<float, kMaxLobes> probabilities = {};
    if (!LobeProbabilities(o.local, probabilities.data())) return std::nullopt;
    double below = 0;
    while (chosen + 1 < count_ && uc >= below + static_cast<double>(probabilities[chosen])) {
      below += static_cast<double>(probabilities[chosen++]);
    }
    // Rounding may leave a sliver of uc to a last lobe that has no share.
    while (chosen > 0 && !(probabilities[chosen] > 0)) below -= static_cast<double>(probabilities[--chosen]);
    probability = probabilities[chosen];
    uc = std::clamp((uc - below) / static_cast<double>(probability), 0.0, 0x1.fffffffffffffp-1);
  }
  const WeightedLobe& lobe = lobes_[chosen];
  std::optional<LobeSample> drawn =
      std::visit([&](const auto& l) { return l.Sample(o.local, uc, u, mode); }, lobe.lobe);
  if (!drawn || drawn->wi.z == 0) return std::nullopt;
  if (drawn->flags.IsSpecular()) {
    drawn->pdf *= probability;
    return FinishSpecular(o, wo, *drawn, lobe.scale, uMirror, mode);
  }
  return FinishNonSpecular(o, *drawn, uMirror, mode);
}

std::optional<SpecularPair> Bsdf::BothWays(const Vec3& wo) const {
  if (count_ != 1 || !IsPurelySpecular()) return std::nullopt;
  // A lobe's first number chooses its branch.
  std::optional<BsdfSample> reflected = Sample(wo, 0, Vec2d(0), TransportMode::Radiance);
  if (!reflected || !reflected->flags.HasReflection() || !(reflected->pdf < 1)) return std::nullopt;
  std::optional<BsdfSample> transmitted = Sample(wo, 0x1.fffffffffffffp-1, Vec2d(0), TransportMode::Radiance);
  if (!transmitted || transmitted->flags.HasReflection()) return std::nullopt;
  reflected->weight *= reflected->pdf;
  transmitted->weight *= transmitted->pdf;
  return SpecularPair{*reflected, *transmitted};
}

std::optional<Bsdf::Sided> Bsdf::DrawPreimage(const Vec3& local, bool allowMirrored, double u, int* count) const {
  Preimages preimages = PreimagesOf(local);
  preimages.mirrored = preimages.mirrored && allowMirrored;
  *count = preimages.Count();
  if (*count == 0) return std::nullopt;
  const bool isMirrored = preimages.mirrored && (!preimages.direct || u < 0.5);
  if (isFlat_) return Sided{local, local.z, false};
  const float z = isMirrored ? -local.z : local.z;
  return Sided{local, Dot(Vec3(local.x, local.y, z), ngLocal_), isMirrored};
}

std::optional<BsdfSample> Bsdf::FinishNonSpecular(const Sided& wo, const LobeSample& drawn, double uMirror,
                                                  TransportMode mode) const {
  int count;
  const std::optional<Sided> wi = DrawPreimage(drawn.wi, true, uMirror, &count);
  if (!wi) return std::nullopt;
  const float pdf = (count_ == 1 ? drawn.pdf : PdfOfLobes(wo.local, wi->local)) / static_cast<float>(count);
  if (!(pdf > 0)) return std::nullopt;
  const Color value = ValueOfLobes(wo.local, wi->local, mode) * CosineFactor(wo, *wi, mode);
  const Color weight = value / pdf;
  if (weight.IsBlack() || !weight.IsFinite()) return std::nullopt;
  const Vec3 local(wi->local.x, wi->local.y, wi->isMirrored ? -wi->local.z : wi->local.z);
  return BsdfSample{Normalize(shading_.ToWorld(local)), weight, pdf, drawn.eta, drawn.flags};
}

std::optional<BsdfSample> Bsdf::FinishSpecular(const Sided& wo, const Vec3& woWorld, const LobeSample& drawn,
                                               const Color& scale, double uMirror, TransportMode mode) const {
  Color weight = drawn.value * scale / drawn.pdf;
  if (weight.IsBlack()) return std::nullopt;
  // What goes straight on knows no normal.
  if (drawn.wi == -wo.local) return BsdfSample{-woWorld, weight, drawn.pdf, drawn.eta, drawn.flags};

  // Seen from the eye, a mirrored wo is allowed and wi is not mirrored; from the light it is the other way round, so
  // that both walks agree and the eye's walk never gains energy.
  const bool fromLight = mode == TransportMode::Importance;
  if (fromLight && wo.isMirrored) return std::nullopt;
  int count;
  const std::optional<Sided> wi = DrawPreimage(drawn.wi, fromLight, uMirror, &count);
  if (!wi) return std::nullopt;
  if (fromLight && !isFlat_) weight *= static_cast<float>(count) * CosineFactor(wo, *wi, mode) / AbsCosTheta(wi->local);
  if (!weight.IsFinite()) return std::nullopt;
  const Vec3 local(wi->local.x, wi->local.y, wi->isMirrored ? -wi->local.z : wi->local.z);
  return BsdfSample{Normalize(shading_.ToWorld(local)), weight, drawn.pdf, drawn.eta, drawn.flags};
}

Color Bsdf::Albedo(const Vec3& wo) const {
  const Sided o = ToSided(wo);
  if (!o.IsValid()) return Color();
  Color sum;
  for (int i = 0; i < count_; ++i) {
    sum += std::visit([&](const auto& l) { return l.Albedo(o.local); }, lobes_[i].lobe) * lobes_[i].scale;
  }
  return sum;
}

}  // namespace dapple
