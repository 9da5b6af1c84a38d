// Faults of what lights are drawn with: the choice of a light, a table, the BSDF that the light meets.
#include <cmath>
#include <limits>

#include "lights/light_picker.h"
#include "lights/point_light.h"
#include "src/base/numerics.h"
#include "src/materials/bsdf.h"
#include "src/sampling/warps.h"
#include "tests/lights/mutants.h"
#include "tests/support/chi_square.h"

namespace dapple {

namespace {

using testing::Coordinates;
using testing::UniformNumbers;

constexpr int kSamples = 20'000;
constexpr double kLevel = 1e-6;  // a fault is far below it

/// Whether all of the values are alike but for rounding.
class Evenness {
 public:
  void Add(double x) { least_ = std::min(least_, x), most_ = std::max(most_, x); }
  bool IsEven() const { return most_ - least_ <= 1e-5 * most_; }

 private:
  double least_ = std::numeric_limits<double>::infinity(), most_ = 0;
};

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
  double power = 0;
  for (const float intensity : {1.f, 2.f, 4.f, 1.f}) {
    lights.push_back(std::make_unique<PointLight>(Vec3(0), Color(intensity)));
    power += static_cast<double>(lights.back()->Power().g);
  }
  const LightPicker picker(lights);
  const FaultyChoice choice(picker, wrong, place);
  const int count = static_cast<int>(lights.size());

  const auto fit = testing::ChiSquareOnInterval(
      [&](double u) { return std::optional(choice.Pick(u).index + 0.5); },
      [&](double x) { return choice.Probability(std::min(static_cast<int>(x), count - 1)); }, 0, count,
      {.samples = kSamples, .rows = count, .columns = 1, .seed = 41});
  Mean flux;
  Evenness evenness;
  RandomNumbers random(42);
  for (int i = 0; i < kSamples; ++i) {
    const PickedLight picked = choice.Pick(random.Get1D());
    const auto ray = lights[static_cast<size_t>(picked.index)]->Sample_Le(random.Le());
    // What claims never to be drawn can count for nothing.
    const double carried = picked.probability > 0 ? static_cast<double>(ray->Flux().g) / picked.probability : 0;
    flux.Add(carried), evenness.Add(carried);
  }
  Rejections names;
  if (!(fit.pValue > kLevel)) names.emplace_back("chi-square of the choice");
  if (std::abs(flux.Value() - power) > 5 * flux.StandardError() + 1e-5 * power) names.emplace_back("energy");
  if (!evenness.IsEven()) names.emplace_back("lookup");
  return names;
}

/// A table whose two coordinates are swapped in what is drawn, or in what is asked.
Rejections RejectionsOfSwappedTable(Place place) {
  constexpr int kSize = 8;
  std::vector<double> weights;
  RandomNumbers random(43);
  for (int i = 0; i < kSize * kSize; ++i) weights.push_back(std::max(0.0, random.Get1D() - 0.25));
  const Distribution2D table(std::span<const double>(weights), kSize, kSize);
  const auto swapped = [](const Vec2d& p) { return Vec2d(p.y, p.x); };
  const auto draw = [&](const Vec2d& u) {
    const Vec2d p = table.Sample(u).p;
    return InSampler(place) ? swapped(p) : p;
  };
  const auto density = [&](const Vec2d& p) { return table.Pdf(InDensity(place) ? swapped(p) : p); };

  const auto fit = testing::ChiSquareOnCube<2>(
      [&](UniformNumbers& numbers) -> std::optional<Coordinates<2>> {
        const Vec2d p = draw(numbers.Get2D());
        return Coordinates<2>{p.x, p.y};
      },
      [&](const Coordinates<2>& x) {
        return density({x[0], x[1]});
      },
      {kSize, kSize}, kSamples, 44);
  Evenness evenness;
  for (int i = 0; i < kSamples; ++i) {
    const Vec2d p = draw(random.Get2D());
    const auto cell = [](double x) { return std::min(static_cast<size_t>(x * kSize), size_t{kSize - 1}); };
    if (density(p) > 0) evenness.Add(weights[cell(p.y) * kSize + cell(p.x)] / density(p));
  }
  Rejections names;
  if (!(fit.pValue > kLevel)) names.emplace_back("chi-square of the table");
  if (!evenness.IsEven()) names.emplace_back("lookup");
  return names;
}

/// Rough glass whose radiance keeps its value where it is refracted: the eta^2 of a narrower cone is missing, in the
/// weight of what is drawn, or in what `Eval` says (here: the density), or in both.
Rejections RejectionsOfMissingEta(Place place) {
  constexpr float kEta = 1.5f;
  SurfaceInteraction hit;
  hit.ng = hit.ns = Vec3(0, 0, 1);
  hit.dpdu = hit.dpdus = Vec3(1, 0, 0);
  Bsdf bsdf(hit);
  bsdf.Add(RoughDielectric{Ggx(0.3f, 0.3f), kEta, Color(1), Color(1)}, Color(1));
  const auto squaredIndex = [](const Vec3& w) { return w.z > 0 ? 1 : Sqr(kEta); };
  const auto missing = [&](const Vec3& wo, const Vec3& wi) { return squaredIndex(wi) / squaredIndex(wo); };
  const auto eval = [&](const Vec3& wo, const Vec3& wi) {
    return bsdf.Eval(wo, wi, TransportMode::Radiance).g * (InDensity(place) ? missing(wo, wi) : 1);
  };

  RandomNumbers random(45);
  bool isReciprocal = true, isWhatIsLookedUp = true;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 wo = ToFloat(SampleSphere(random.Get2D())), wi = ToFloat(SampleSphere(random.Get2D()));
    // f(wo, wi) n_i^2 = f(wi, wo) n_o^2 (Veach 1997, equation 5.14), with f = Eval / |wi.z|.
    const float there = eval(wo, wi) / std::abs(wi.z) * squaredIndex(wi);
    const float back = eval(wi, wo) / std::abs(wo.z) * squaredIndex(wo);
    isReciprocal &= std::abs(there - back) <= 5e-3f * back + 5e-6f;

    const double lobe = random.Get1D();
    const auto drawn = bsdf.Sample(wo, lobe, random.Get2D(), TransportMode::Radiance);
    if (!drawn || std::abs(drawn->wi.z) < 1e-3f) continue;
    const float weight = drawn->weight.g * (InSampler(place) ? missing(wo, drawn->wi) : 1);
    const float asked = eval(wo, drawn->wi) / bsdf.Pdf(wo, drawn->wi, TransportMode::Radiance);
    isWhatIsLookedUp &= std::abs(weight - asked) <= 4e-3f * asked;
  }
  Rejections names;
  if (!isReciprocal) names.emplace_back("reciprocity");
  if (!isWhatIsLookedUp) names.emplace_back("lookup");
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
