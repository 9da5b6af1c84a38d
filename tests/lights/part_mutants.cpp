// Faults of what lights are drawn with: the choice of a light, a table, the BSDF that the light meets.
#include "lights/light_picker.h"
#include "lights/point_light.h"
#include "src/base/numerics.h"
#include "src/materials/bsdf.h"
#include "tests/lights/choice_checks.h"
#include "tests/lights/mutants.h"
#include "tests/materials/bsdf_checks.h"
#include "tests/support/table_checks.h"

namespace dapple {

namespace {

void Note(const Verdict& verdict, const char* name, Rejections* names) {
  if (!verdict.passes) names->emplace_back(name);
}

/// What chooses the light of a photon, with other weights than the lights' powers in the faulty place.
class FaultyChoice {
 public:
  FaultyChoice(const LightPicker& picker, const std::vector<double>& wrong, Place place)
      : picker_(picker), wrong_(std::span<const double>(wrong)), place_(place) {}

  PickedLight Pick(double u) const {
    PickedLight picked = picker_.PickByPower(u);
    if (InSampler(place_)) picked.index = wrong_.SampleDiscrete(u).index;
    picked.probability = Probability(picked.index);
    return picked;
  }
  double Probability(int light) const {
    return InDensity(place_) ? wrong_.Probability(light) : picker_.ProbabilityByPower(light);
  }

 private:
  const LightPicker& picker_;
  Distribution1D wrong_;
  Place place_;
};

Rejections RejectionsOfChoice(const std::vector<double>& wrong, Place place) {
  std::vector<std::unique_ptr<Light>> lights;
  for (const float intensity : {1.f, 2.f, 4.f, 1.f})
    lights.push_back(std::make_unique<PointLight>(Vec3(0), Color(intensity)));
  const LightPicker picker(lights);
  const FaultyChoice choice(picker, wrong, place);
  const auto pick = [&](double u) { return choice.Pick(u); };
  Rejections names;
  Note(CheckPicks(
           pick, [&](int light) { return choice.Probability(light); }, static_cast<int>(lights.size())),
       "chi-square of the choice", &names);
  Note(CheckPickedEnergy(pick, lights), "energy", &names);
  Note(CheckPickedEvenness(pick, lights), "lookup", &names);
  return names;
}

/// A table whose two coordinates are swapped in what is drawn, or in what is asked.
class SwappedTable {
 public:
  SwappedTable(const Distribution2D& table, Place place) : table_(table), place_(place) {}

  int Width() const { return table_.Width(); }
  int Height() const { return table_.Height(); }
  ContinuousSample2D Sample(const Vec2d& u) const {
    ContinuousSample2D sample = table_.Sample(u);
    if (InSampler(place_)) std::swap(sample.p.x, sample.p.y);
    return sample;
  }
  double Pdf(const Vec2d& p) const { return table_.Pdf(InDensity(place_) ? Vec2d(p.y, p.x) : p); }

 private:
  const Distribution2D& table_;
  Place place_;
};

Rejections RejectionsOfSwappedTable(Place place) {
  constexpr int kSize = 8;
  std::vector<float> weights;
  RandomNumbers random(43);
  for (int i = 0; i < kSize * kSize; ++i) weights.push_back(static_cast<float>(std::max(0.0, random.Get1D() - 0.25)));
  const Distribution2D table(std::span<const float>(weights), kSize, kSize);
  const SwappedTable swapped(table, place);
  Rejections names;
  Note(testing::CheckTableDraws(swapped), "chi-square of the table", &names);
  Note(testing::CheckTableDensity(swapped, weights), "lookup", &names);
  return names;
}

/// Rough glass whose radiance keeps its value where it is refracted: the eta^2 of a narrower cone is missing, in the
/// weight of what is drawn, or in what `Eval` says (here: the density), or in both.
class GlassWithoutEta {
 public:
  static constexpr float kEta = 1.5f;

  explicit GlassWithoutEta(Place place) : bsdf_(Hit()), place_(place) {
    bsdf_.Add(RoughDielectric{Ggx(0.3f, 0.3f), kEta, Color(1), Color(1)}, Color(1));
  }

  const Frame& ShadingFrame() const { return bsdf_.ShadingFrame(); }
  std::optional<BsdfSample> Sample(const Vec3& wo, double uc, const Vec2d& u, TransportMode mode) const {
    std::optional<BsdfSample> sample = bsdf_.Sample(wo, uc, u, mode);
    if (sample && InSampler(place_)) sample->weight *= Missing(wo, sample->wi);
    return sample;
  }
  Color Eval(const Vec3& wo, const Vec3& wi, TransportMode mode) const {
    return bsdf_.Eval(wo, wi, mode) * (InDensity(place_) ? Missing(wo, wi) : 1);
  }
  float Pdf(const Vec3& wo, const Vec3& wi, TransportMode mode) const { return bsdf_.Pdf(wo, wi, mode); }

 private:
  static SurfaceInteraction Hit() {
    SurfaceInteraction hit;
    hit.ng = hit.ns = Vec3(0, 0, 1);
    hit.dpdu = hit.dpdus = Vec3(1, 0, 0);
    return hit;
  }
  static float SquaredIndex(const Vec3& w) { return w.z > 0 ? 1 : Sqr(kEta); }
  static float Missing(const Vec3& wo, const Vec3& wi) { return SquaredIndex(wi) / SquaredIndex(wo); }

  Bsdf bsdf_;
  Place place_;
};

Rejections RejectionsOfMissingEta(Place place) {
  const GlassWithoutEta glass(place);
  Rejections names;
  Note(testing::CheckReciprocity(glass, GlassWithoutEta::kEta, false), "reciprocity", &names);
  Note(testing::CheckSampleAgainstEval(glass, TransportMode::Radiance), "lookup", &names);
  return names;
}

}  // namespace

std::vector<Fault> FaultsOfParts() {
  constexpr const char *kChoice = "chi-square of the choice", *kTable = "chi-square of the table", *kLookup = "lookup";
  const auto chosenBy = [](const std::vector<double>& weights) {
    return [weights](Place place) { return RejectionsOfChoice(weights, place); };
  };
  return {
      {"lights chosen evenly", chosenBy({1, 1, 1, 1}), {kChoice, kChoice, kLookup}},
      {"one light never chosen", chosenBy({1, 2, 4, 0}), {kChoice, kChoice, "energy"}},
      {"table's u and v swapped", RejectionsOfSwappedTable, {kTable, kTable, kLookup}},
      {"missing eta^2 of refraction", RejectionsOfMissingEta, {kLookup, "reciprocity", "reciprocity"}},
  };
}

}  // namespace dapple
