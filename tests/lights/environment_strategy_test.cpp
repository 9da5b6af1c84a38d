#include "lights/environment_strategy.h"

#include <array>
#include <cmath>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "lights/environment_light.h"
#include "lights/equal_area_mapping.h"
#include "src/base/numerics.h"
#include "src/materials/bsdf.h"
#include "src/sampling/warps.h"
#include "tests/lights/light_checks.h"
#include "tests/support/chi_square.h"

namespace dapple {
namespace {

using Mapping = EnvironmentMapping;

constexpr EnvironmentSampling kAllSamplings[] = {EnvironmentSampling::Uniform,     EnvironmentSampling::Cosine,
                                                 EnvironmentSampling::Importance,  EnvironmentSampling::Irradiance,
                                                 EnvironmentSampling::Compensated, EnvironmentSampling::Structured,
                                                 EnvironmentSampling::Product};

const char* NameOf(EnvironmentSampling sampling) {
  static const char* const kNames[] = {"uniform",     "cosine",     "importance", "irradiance",
                                       "compensated", "structured", "product"};
  return kNames[static_cast<int>(sampling)];
}

struct Map {
  std::string name;
  Image image;
  Mapping mapping = Mapping::LatLong;
};

Image Filled(int width, int height, float value) {
  Image image = Image::Rgb(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) image.SetColor(x, y, Color(value));
  return image;
}

// A dim sky that grows brighter upward, and a sun of one texel: 60 % of all light.
Image SunnySky() {
  Image image = Image::Rgb(32, 16);
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 32; ++x) image.SetColor(x, y, Color(0.1f, 0.15f, 0.2f) * (y < 8 ? 1.f : 0.25f));
  image.SetColor(9, 5, Color(90, 80, 70));
  return image;
}

std::vector<Map> Maps() {
  std::vector<Map> maps;
  maps.push_back({"random", RandomEnvironment(16, 8, 1)});
  maps.push_back({"random, equal area", RandomEnvironment(8, 8, 2), Mapping::EqualArea});
  maps.push_back({"sunny sky", SunnySky()});
  return maps;
}

// Hard ones: few pixels, black rows, all light at a pole or in one texel.
std::vector<Map> HardMaps() {
  std::vector<Map> maps = Maps();
  maps.push_back({"1 x 1", Filled(1, 1, 2)});
  maps.push_back({"1 x 1, equal area", Filled(1, 1, 2), Mapping::EqualArea});
  maps.push_back({"2 x 1", RandomEnvironment(2, 1, 3)});
  maps.push_back({"even", Filled(9, 5, 1)});
  Image rows = RandomEnvironment(12, 9, 4);
  for (int y : {0, 3, 4, 8})
    for (int x = 0; x < 12; ++x) rows.SetColor(x, y, Color(0));
  maps.push_back({"black rows", rows});
  for (const Vec2i& texel : {Vec2i(0, 0), Vec2i(5, 7), Vec2i(7, 3)}) {
    Image image = Image::Rgb(8, 8);
    image.SetColor(texel.x, texel.y, Color(1, 2, 3));
    maps.push_back({"one texel", image});
    maps.push_back({"one texel, equal area", image, Mapping::EqualArea});
  }
  return maps;
}

std::unique_ptr<EnvironmentLight> MakeLight(const Map& map, EnvironmentSampling sampling,
                                            const Transform& transform = {}) {
  auto light = std::make_unique<EnvironmentLight>(map.image, transform, Color(1), map.mapping,
                                                  EnvironmentOptions{.sampling = sampling});
  return light;
}

// A surface, seen from `wo`, whose scattering is known.
struct Receiver {
  std::string name;
  Vec3 n, wo;
  std::vector<std::pair<Lobe, Color>> lobes;

  Bsdf MakeBsdf() const {
    SurfaceInteraction hit;
    hit.ng = hit.ns = n;
    hit.dpdu = hit.dpdus = Frame::FromZ(n).s;
    Bsdf bsdf(hit);
    for (const auto& [lobe, scale] : lobes) bsdf.Add(lobe, scale);
    return bsdf;
  }

  LightContext ContextFor(const Light& light, const Bsdf& bsdf, bool bsdfDrawsToo = false) const {
    LightContext at(Vec3(0.5f, 0, 1), n, bsdf.Flags().HasTransmission());
    at.bsdfDrawsToo = bsdfDrawsToo;
    if (auto table = light.PrepareReceiver(bsdf, wo)) at.tables.push_back(std::move(table));
    return at;
  }
};

std::vector<Receiver> Receivers() {
  const Vec3 up(0, 0, 1), aslant = Normalize(Vec3(0.5f, -0.6f, -0.2f));
  const Color eta(0.2f, 0.9f, 1.1f), k(3.9f, 2.45f, 2.14f);
  return {
      {"matte", up, Normalize(Vec3(0.3f, 0.1f, 1)), {{LambertianReflection{Color(0.5f)}, Color(1)}}},
      {"matte, aslant", aslant, aslant, {{LambertianReflection{Color(0.5f)}, Color(1)}}},
      {"rough copper", up, Normalize(Vec3(0.6f, 0.2f, 0.7f)), {{RoughConductor{Ggx(0.2f, 0.2f), eta, k}, Color(1)}}},
      {"paper",
       aslant,
       aslant,
       {{LambertianReflection{Color(0.4f)}, Color(1)}, {LambertianTransmission{Color(0.3f)}, Color(1)}}}};
}

// Calls `check(name, light, receiver, bsdf)` for all strategies, the given maps and all receivers.
template <typename Check>
void ForAll(const std::vector<Map>& maps, Check check) {
  for (const Map& map : maps) {
    for (const EnvironmentSampling sampling : kAllSamplings) {
      const auto light = MakeLight(map, sampling);
      for (const Receiver& receiver : Receivers())
        check(std::string(NameOf(sampling)) + ", " + map.name + ", " + receiver.name, *light, receiver,
              receiver.MakeBsdf());
    }
  }
}

// The sphere as the map's square, cut at the lines through texel centres, between which all densities are smooth. All
// pieces are as large as each other in the unit square of the coordinates.
class MapDomain {
 public:
  explicit MapDomain(const Map& map) : isLatLong_(map.mapping == Mapping::LatLong) {
    const auto borders = [](int texels) {
      std::vector<double> at = {0};
      for (int i = 0; i < texels; ++i) at.push_back((i + 0.5) / texels);
      at.push_back(1);
      return at;
    };
    x_ = borders(map.image.Width());
    y_ = borders(map.image.Height());
    // Of equal measure is (1 - cos theta) / 2.
    if (isLatLong_)
      for (double& y : y_) y = (1 - std::cos(kPiD * y)) / 2;
  }

  std::array<int, 2> Pieces() const { return {static_cast<int>(x_.size()) - 1, static_cast<int>(y_.size()) - 1}; }
  Vec3d Point(const testing::Coordinates<2>& c) const {
    const Vec2d p(Between(x_, c[0]), Between(y_, c[1]));
    return isLatLong_ ? SampleSphere({p.y, p.x}) : EqualAreaSquareToSphere(p);
  }
  testing::Coordinates<2> CoordinatesOf(const Vec3d& w) const {
    const Vec2d p = isLatLong_ ? Vec2d(TurnOf(w.x, w.y), (1 - w.z) / 2) : EqualAreaSphereToSquare(w);
    return {Share(x_, p.x), Share(y_, p.y)};
  }
  /// Solid angle per unit area of the coordinates' square.
  double Stretch(const testing::Coordinates<2>& c) const {
    const auto slope = [](const std::vector<double>& borders, double at) {
      const size_t i = PieceAt(borders, at);
      return (borders[i + 1] - borders[i]) * static_cast<double>(borders.size() - 1);
    };
    return 4 * kPiD * slope(x_, c[0]) * slope(y_, c[1]);
  }

  /// The integral over the sphere of a function that is smooth within the pieces, or has no worse than kinks.
  template <typename F>
  double Integrate(const F& f) const {
    const auto [columns, rows] = Pieces();
    double sum = 0;
    for (int y = 0; y < rows; ++y)
      for (int x = 0; x < columns; ++x) {
        const testing::Box<2> piece = {{static_cast<double>(x) / columns, static_cast<double>(y) / rows},
                                       {static_cast<double>(x + 1) / columns, static_cast<double>(y + 1) / rows}};
        sum += testing::Integrate<2>(
            [&](const testing::Coordinates<2>& c) { return f(ToFloat(Point(c))) * Stretch(c); }, piece, 1e-6, 8);
      }
    return sum;
  }

 private:
  static size_t PieceAt(const std::vector<double>& borders, double at) {
    const size_t pieces = borders.size() - 1;
    return std::min(static_cast<size_t>(at * static_cast<double>(pieces)), pieces - 1);
  }
  static double Between(const std::vector<double>& borders, double at) {
    const size_t i = PieceAt(borders, at);
    return Lerp(at * static_cast<double>(borders.size() - 1) - static_cast<double>(i), borders[i], borders[i + 1]);
  }
  static double Share(const std::vector<double>& borders, double p) {
    size_t i = 0;
    while (i + 2 < borders.size() && borders[i + 1] <= p) ++i;
    const double within = (p - borders[i]) / (borders[i + 1] - borders[i]);
    return std::clamp((static_cast<double>(i) + within) / static_cast<double>(borders.size() - 1), 0.0, 1.0);
  }

  bool isLatLong_;
  std::vector<double> x_, y_;
};

// Of what depends on the map, in the map's pieces; of what does not, around the receiver's normal.
testing::ChiSquare FitOfDirections(const Light& light, const LightContext& at, const MapDomain* domain, uint64_t seed) {
  constexpr int kSamples = 10000;
  const auto draw = [&](double part, const Vec2d& u) -> std::optional<Vec3> {
    const std::optional<LiSample> drawn = light.Sample_Li(at, {part, u});
    return drawn ? std::optional(drawn->wi) : std::nullopt;
  };
  const auto pdf = [&](const Vec3& wi) { return light.Pdf_Li(at, wi, nullptr); };
  if (!domain)
    return testing::ChiSquareOnSphere(
        draw, pdf, {.samples = kSamples, .rows = 12, .columns = 12, .seed = seed, .frame = Frame::FromZ(at.n)});
  return testing::ChiSquareOnCube<2>(
      [&](testing::UniformNumbers& random) -> std::optional<testing::Coordinates<2>> {
        const double part = random.Get1D();
        const std::optional<Vec3> wi = draw(part, random.Get2D());
        return wi ? std::optional(domain->CoordinatesOf(ToDouble(*wi))) : std::nullopt;
      },
      [&](const testing::Coordinates<2>& c) { return pdf(ToFloat(domain->Point(c))) * domain->Stretch(c); },
      domain->Pieces(), kSamples, seed);
}

TEST(EnvironmentStrategy, DirectionsFollowTheirDensityWhichIntegratesToOne) {
  uint64_t seed = 1;
  for (const Map& map : Maps()) {
    const MapDomain domain(map);
    ForAll({map}, [&](const std::string& name, const Light& light, const Receiver& receiver, const Bsdf& bsdf) {
      const bool dependsOnMap = name.find("uniform") != 0 && name.find("cosine") != 0;
      for (const bool bsdfDrawsToo : {false, true}) {
        // Nothing but "compensated" asks for it.
        if (bsdfDrawsToo && name.find("compensated") != 0) continue;
        const LightContext at = receiver.ContextFor(light, bsdf, bsdfDrawsToo);
        const testing::ChiSquare fit = FitOfDirections(light, at, dependsOnMap ? &domain : nullptr, seed++);
        EXPECT_TRUE(fit.Passes()) << name << ": " << fit.message;
        EXPECT_NEAR(fit.total, 1, 2e-4) << name;
      }
    });
  }
}

TEST(EnvironmentStrategy, DensityIsThatOfTheDraw) {
  ForAll(HardMaps(), [&](const std::string& name, const Light& light, const Receiver& receiver, const Bsdf& bsdf) {
    const LightContext at = receiver.ContextFor(light, bsdf);
    RandomNumbers random(2);
    int drawn = 0;
    for (int i = 0; i < 200; ++i) {
      const std::optional<LiSample> sample = light.Sample_Li(at, random.Li());
      if (!sample) continue;  // rounded to where there is no light
      ++drawn;
      ASSERT_TRUE(sample->pdf > 0 && std::isfinite(sample->pdf)) << name;
      ASSERT_NEAR(Length(sample->wi), 1, 1e-6) << name;
      ASSERT_EQ(light.Pdf_Li(at, sample->wi, nullptr), sample->pdf) << name;
      ASSERT_EQ(light.Le(Ray{at.p, sample->wi}), sample->L) << name;
    }
    EXPECT_GE(drawn, 198) << name;
  });
}

TEST(EnvironmentStrategy, RandomNumbersAreFoundAgain) {
  ForAll(HardMaps(), [&](const std::string& name, const Light& light, const Receiver& receiver, const Bsdf& bsdf) {
    const LightContext at = receiver.ContextFor(light, bsdf);
    RandomNumbers random(3);
    int far = 0;
    for (int i = 0; i < 100; ++i) {
      const LiRandom u = random.Li();
      const std::optional<LiSample> sample = light.Sample_Li(at, u);
      if (!sample) continue;
      const LiRandom back = light.Invert_Li(at, sample->wi, nullptr);
      const std::optional<LiSample> again = light.Sample_Li(at, back);
      ASSERT_TRUE(again) << name;
      ASSERT_LT(Distance(again->wi, sample->wi), 1e-3f) << name;
      // The numbers themselves: rounding of the direction is magnified where the density is small.
      const double error =
          std::max(std::abs(back.direction.x - u.direction.x), std::abs(back.direction.y - u.direction.y));
      if (error > 1e-4) ++far;
    }
    EXPECT_LE(far, 3) << name;
  });
}

TEST(EnvironmentStrategy, DensityIsPositiveWhereverLightCounts) {
  ForAll(HardMaps(), [&](const std::string& name, const Light& light, const Receiver& receiver, const Bsdf& bsdf) {
    const LightContext at = receiver.ContextFor(light, bsdf);
    RandomNumbers random(4);
    for (int i = 0; i < 500; ++i) {
      const Vec3 wi = ToFloat(SampleSphere(random.Get2D()));
      const bool counts = at.transmissive || Dot(wi, at.n) > 0;
      if (counts && !light.Le(Ray{at.p, wi}).IsBlack()) {
        ASSERT_GT(light.Pdf_Li(at, wi, nullptr), 0) << name;
      }
    }
  });
}

double Scattered(const Light& light, const Bsdf& bsdf, const Receiver& receiver, const Vec3& wi) {
  return static_cast<double>((bsdf.Eval(receiver.wo, wi, TransportMode::Radiance) * light.Le(Ray{Vec3(0), wi})).g);
}

// One sample of the light, and one of the BSDF where it draws too, by the balance heuristic.
double EstimateScattered(const Light& light, const Receiver& receiver, const Bsdf& bsdf, const LightContext& at,
                         RandomNumbers& random) {
  double sum = 0;
  if (const std::optional<LiSample> sample = light.Sample_Li(at, random.Li())) {
    const float other = at.bsdfDrawsToo ? bsdf.Pdf(receiver.wo, sample->wi, TransportMode::Radiance) : 0;
    sum += Scattered(light, bsdf, receiver, sample->wi) / (sample->pdf + static_cast<double>(other));
  }
  if (!at.bsdfDrawsToo) return sum;
  const double uLobe = random.Get1D();
  if (const auto next = bsdf.Sample(receiver.wo, uLobe, random.Get2D(), TransportMode::Radiance))
    sum += Scattered(light, bsdf, receiver, next->wi) /
           (static_cast<double>(next->pdf) + light.Pdf_Li(at, next->wi, nullptr));
  return sum;
}

// Radiance scattered toward the viewer, and for matte surfaces so the irradiance: by each strategy alone, and by
// multiple importance sampling with the BSDF, which "compensated" needs.
TEST(EnvironmentStrategy, ScatteredRadianceIsUnbiased) {
  for (const Map& map : Maps()) {
    const MapDomain domain(map);
    std::map<std::string, double> exact;
    ForAll({map}, [&](const std::string& name, const Light& light, const Receiver& receiver, const Bsdf& bsdf) {
      if (!exact.contains(receiver.name))
        exact[receiver.name] = domain.Integrate([&](const Vec3& wi) { return Scattered(light, bsdf, receiver, wi); });
      for (const bool bsdfDrawsToo : {false, true}) {
        const LightContext at = receiver.ContextFor(light, bsdf, bsdfDrawsToo);
        RandomNumbers random(5);
        Mean mean;
        for (int i = 0; i < 4000; ++i) mean.Add(EstimateScattered(light, receiver, bsdf, at, random));
        // 5 standard errors, and what the quadrature may be off.
        EXPECT_NEAR(mean.Value(), exact[receiver.name], 5 * mean.StandardError() + 1e-3 * exact[receiver.name])
            << name << (bsdfDrawsToo ? ", MIS" : "");
      }
    });
  }
}

// Irradiance by each strategy against the photons of the same light.
TEST(EnvironmentStrategy, BothSidesGiveTheSameLightOnAPatch) {
  const Receiver matte = Receivers().front();
  const Bsdf bsdf = matte.MakeBsdf();
  const Patch patch{kTestExtent.center, Frame::FromZ(matte.n), 1.5f};
  for (const Map& map : Maps()) {
    for (const EnvironmentSampling sampling : kAllSamplings) {
      const auto light = MakeLight(map, sampling);
      light->Prepare(kTestExtent);
      const Verdict verdict = CheckBothSides({*light, nullptr}, patch, matte.ContextFor(*light, bsdf));
      EXPECT_TRUE(verdict.passes) << NameOf(sampling) << ", " << map.name << ": " << verdict.message;
    }
  }
}

TEST(EnvironmentStrategy, CompensatedLeavesToTheBsdfWhatIsBelowTheMean) {
  const Map map{"sunny sky", SunnySky()};
  const auto light = MakeLight(map, EnvironmentSampling::Compensated),
             plain = MakeLight(map, EnvironmentSampling::Importance);
  const double mean = light->Map().MeanImportance();
  LightContext alone(Vec3(0)), joint(Vec3(0));
  joint.bsdfDrawsToo = true;
  RandomNumbers random(6);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 wi = ToFloat(SampleSphere(random.Get2D()));
    const double importance = static_cast<double>(light->Le(Ray{Vec3(0), wi}).MaxComponent());
    ASSERT_EQ(light->Pdf_Li(alone, wi, nullptr), plain->Pdf_Li(alone, wi, nullptr));
    if (importance < 0.5 * mean) {
      ASSERT_EQ(light->Pdf_Li(joint, wi, nullptr), 0);
    }
  }
  const Vec3 sun = light->Sample_Li(joint, {0.5, {0.5, 0.5}})->wi;
  EXPECT_GT(light->Pdf_Li(joint, sun, nullptr), plain->Pdf_Li(joint, sun, nullptr));
  // An even map has nothing above its mean: it is drawn as it is.
  const auto even = MakeLight({"even", Filled(8, 4, 1)}, EnvironmentSampling::Compensated);
  EXPECT_GT(even->Pdf_Li(joint, Vec3(0, 0, 1), nullptr), 0);
}

// By radiance a share s of all draws would go to the sun of solid angle w; by structure it is s w^(1/4) against
// (1 - s) 0.01^(1/4) for the wide rest, which is one part of even radiance here.
TEST(EnvironmentStrategy, StructuredGivesTheDimAndWideItsShare) {
  Image image = Filled(64, 64, 1);
  image.SetColor(20, 30, Color(3000));
  const auto light = MakeLight({"sun", image, Mapping::EqualArea}, EnvironmentSampling::Structured);
  // The tent of the sun reaches over four cells; what it adds to the sky is 2999 texels' worth of light.
  const double texel = 4 * kPiD / (64 * 64), s = (2999 + 4) / (2999. + 64 * 64), w = 4 * texel;
  const double expected = s * std::pow(w, 0.25) / (s * std::pow(w, 0.25) + (1 - s) * std::pow(0.01, 0.25));
  RandomNumbers random(7);
  constexpr int kDraws = 20000;
  int onSun = 0;
  for (int i = 0; i < kDraws; ++i) onSun += light->Sample_Li(LightContext(Vec3(0)), random.Li())->L.g > 1.0001f ? 1 : 0;
  const double share = static_cast<double>(onSun) / kDraws;
  EXPECT_NEAR(share, expected, 5 * std::sqrt(expected / kDraws));
  EXPECT_LT(expected, 0.95 * s + 0.04);
}

// Mean of squares of the estimate over the square of its mean: 1 would be perfect.
double Waste(const Light& light, const Receiver& receiver, const Bsdf& bsdf) {
  const LightContext at = receiver.ContextFor(light, bsdf);
  RandomNumbers random(8);
  double sum = 0, squares = 0;
  constexpr int kDraws = 4000;
  for (int i = 0; i < kDraws; ++i) {
    const std::optional<LiSample> sample = light.Sample_Li(at, random.Li());
    const double f = sample ? Scattered(light, bsdf, receiver, sample->wi) / sample->pdf : 0;
    sum += f;
    squares += f * f;
  }
  return squares * kDraws / (sum * sum);
}

/// Draws of 2,000 that go below the horizon of an opaque surface, under which the sun stands.
int DrawsBelowTheHorizon(const EnvironmentLight& light) {
  Receiver receiver = Receivers()[0];
  receiver.n = receiver.wo = Normalize(Vec3(0.2f, -1, -0.3f));
  const Bsdf bsdf = receiver.MakeBsdf();
  const LightContext at = receiver.ContextFor(light, bsdf);
  RandomNumbers random(10);
  int below = 0;
  for (int i = 0; i < 2000; ++i) {
    const std::optional<LiSample> sample = light.Sample_Li(at, random.Li());
    below += sample && Dot(sample->wi, receiver.n) < 0 ? 1 : 0;
  }
  return below;
}

// On matte surfaces the estimate hardly varies; of the map's own density, half of the draws are lost.
TEST(EnvironmentStrategy, IrradianceWastesLittleOnMatteSurfaces) {
  Image gray = RandomEnvironment(256, 128, 9);
  for (int y = 0; y < gray.Height(); ++y)
    for (int x = 0; x < gray.Width(); ++x) gray.SetColor(x, y, Color(gray.ColorAt(x, y).Average()));
  const Map map{"random, gray", gray};
  const auto irradiance = MakeLight(map, EnvironmentSampling::Irradiance),
             importance = MakeLight(map, EnvironmentSampling::Importance);
  for (size_t i : {0, 1}) {
    const Receiver receiver = Receivers()[i];
    const Bsdf bsdf = receiver.MakeBsdf();
    const double byIrradiance = Waste(*irradiance, receiver, bsdf), byMap = Waste(*importance, receiver, bsdf);
    EXPECT_LT(byIrradiance - 1, 0.1 * (byMap - 1)) << receiver.name << ": " << byIrradiance << " against " << byMap;
  }
}

TEST(EnvironmentStrategy, IrradianceKnowsTheHorizon) {
  const Map map{"sunny sky", SunnySky()};
  EXPECT_LT(DrawsBelowTheHorizon(*MakeLight(map, EnvironmentSampling::Irradiance)), 200);
  EXPECT_GT(DrawsBelowTheHorizon(*MakeLight(map, EnvironmentSampling::Importance)), 1000);
}

TEST(EnvironmentStrategy, ProductWastesLittleWhereMapOrBsdfAloneWasteMuch) {
  const Map map{"random", RandomEnvironment(32, 16, 9)};
  const auto product = MakeLight(map, EnvironmentSampling::Product),
             importance = MakeLight(map, EnvironmentSampling::Importance);
  for (const Receiver& receiver : Receivers()) {
    const Bsdf bsdf = receiver.MakeBsdf();
    const double byProduct = Waste(*product, receiver, bsdf), byMap = Waste(*importance, receiver, bsdf);
    EXPECT_LT(byProduct - 1, 0.5 * (byMap - 1)) << receiver.name << ": " << byProduct << " against " << byMap;
  }
}

// However low the sun stands, if only it is above the horizon as a whole (its tent reaches 4 degrees, at its corners),
// the tree finds it: no weight grows far beyond its due.
TEST(EnvironmentStrategy, ProductFindsASunAtAnyHeight) {
  Image image = Filled(128, 64, 0.01f);
  image.SetColor(40, 21, Color(3000));
  const auto product = MakeLight({"low sun", image}, EnvironmentSampling::Product);
  const Vec3 sun = product->Sample_Li(LightContext(Vec3(0)), {0.5, {0.5, 0.5}})->wi;
  RandomNumbers random(11);
  double worst = 1;
  for (int i = 0; i < 200; ++i) {
    Receiver receiver = Receivers()[0];
    const double height = 0.07 + 0.2 * random.Get1D(), turn = 2 * kPiD * random.Get1D();
    const Vec3d local(std::sqrt(1 - height * height) * std::cos(turn), std::sqrt(1 - height * height) * std::sin(turn),
                      height);
    receiver.n = receiver.wo = Normalize(Frame::FromZ(sun).ToWorld(ToFloat(local)));
    const Bsdf bsdf = receiver.MakeBsdf();
    const LightContext at = receiver.ContextFor(*product, bsdf);
    // The density at the sun against the ideal one, the product over its integral.
    const double irradiance = 3000 * 2 * kPiD / 128 * (kPiD / 64) * std::sin(kPiD * 21.5 / 64) * height + 0.01 * kPiD;
    worst = std::min(worst, product->Pdf_Li(at, sun, nullptr) / (3000 * height / irradiance));
  }
  EXPECT_GT(worst, 0.25);
}

// Where the sun is below a surface that light does not cross, hardly any draws of the product go there.
TEST(EnvironmentStrategy, ProductKnowsTheHorizon) {
  EXPECT_LT(DrawsBelowTheHorizon(*MakeLight({"sunny sky", SunnySky()}, EnvironmentSampling::Product)), 200);
}

// A vertex of a path takes the memory of one before it; those in use at once, of two lights even, stay apart.
TEST(EnvironmentStrategy, ProductKeepsTheTreesInUseApartAndTakesUpTheOthers) {
  const auto sunny = MakeLight({"sunny sky", SunnySky()}, EnvironmentSampling::Product);
  const auto random = MakeLight({"random", RandomEnvironment(16, 8, 1)}, EnvironmentSampling::Product);
  const Vec3 wi = Normalize(Vec3(0.2f, 0.3f, 1));
  for (const Receiver& receiver : Receivers()) {
    const Bsdf bsdf = receiver.MakeBsdf();
    const auto densities = [&](const LightContext& a, const LightContext& b) {
      return std::pair(sunny->Pdf_Li(a, wi, nullptr), random->Pdf_Li(b, wi, nullptr));
    };
    std::pair<double, double> first;
    std::set<const ReceiverTable*> used;
    for (int i = 0; i < 3; ++i) {
      const LightContext ofSunny = receiver.ContextFor(*sunny, bsdf), ofRandom = receiver.ContextFor(*random, bsdf);
      if (i == 0) first = densities(ofSunny, ofRandom);
      EXPECT_EQ(densities(ofSunny, ofRandom), first) << receiver.name;
      used.insert({ofSunny.TableOf(sunny.get()), ofRandom.TableOf(random.get())});
    }
    EXPECT_EQ(used.size(), 2u) << receiver.name;
  }
}

}  // namespace
}  // namespace dapple
