// Facts of colorimetry: sums and chromaticities that the CIE publishes, and what pbrt makes of spectra.
#include "src/materials/spectrum.h"

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "src/base/numerics.h"
#include "src/materials/named_spectra.h"

namespace dapple {
namespace {

Spectrum Equal(double value) {
  return Spectrum::Sampled([value](double) { return value; });
}

void ExpectChromaticity(const Spectrum& spectrum, double x, double y, double tolerance) {
  const Chromaticity c = ChromaticityOf(ToXyz(spectrum));
  EXPECT_NEAR(c.x, x, tolerance);
  EXPECT_NEAR(c.y, y, tolerance);
}

void ExpectNear(const Color& color, const Color& expected, float tolerance) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(color[i], expected[i], tolerance) << "component " << i;
}

void ExpectNearRelative(const Color& color, const Color& expected, float tolerance) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(color[i] / expected[i], 1, tolerance) << "component " << i;
}

TEST(Cie, FunctionsHaveTheirPublishedIntegrals) {
  Xyz sum;
  for (const Xyz& c : CieColorMatching()) sum = sum + c;
  EXPECT_NEAR(sum.y, kCieYIntegral, 0.001);
  EXPECT_NEAR(sum.x, 106.865, 0.005);
  EXPECT_NEAR(sum.z, 106.892, 0.005);
}

// Each entry of the 5 nm table is near the cubic through its four neighbours: a wrong leading digit stands out.
TEST(Cie, FunctionsAreSmooth) {
  const auto& table = CieColorMatching();
  for (double Xyz::*component : {&Xyz::x, &Xyz::y, &Xyz::z}) {
    for (size_t i = 10; i + 10 < table.size(); i += 5) {
      const auto at = [&](int steps) { return table[static_cast<size_t>(static_cast<int>(i) + 5 * steps)].*component; };
      const double predicted = (-at(-2) + 4 * at(-1) + 4 * at(1) - at(2)) / 6;
      const double around = (std::abs(at(-1)) + std::abs(at(0)) + std::abs(at(1))) / 3;
      EXPECT_NEAR(at(0), predicted, std::min(0.03, 0.13 * around) + 1e-5) << kCieFirst + static_cast<int>(i) << " nm";
    }
  }
}

TEST(Cie, FunctionsPeakWhereTheyShould) {
  const auto& table = CieColorMatching();
  EXPECT_EQ(table[555 - kCieFirst].y, 1);
  for (const Xyz& c : table) EXPECT_LE(c.y, 1 + 1e-4);
  EXPECT_NEAR(table[446 - kCieFirst].z, 1.7826, 0.002);
  EXPECT_NEAR(table[598 - kCieFirst].x, 1.0628, 0.002);
  EXPECT_NEAR(table[504 - kCieFirst].x, 0.0022, 0.0003);
}

TEST(Cie, IlluminantsHaveTheirPublishedChromaticities) {
  ExpectChromaticity(NamedSpectrum("stdillum-A"), 0.44757, 0.40745, 5e-5);
  ExpectChromaticity(NamedSpectrum("stdillum-D50"), 0.34567, 0.35850, 1e-4);
  ExpectChromaticity(NamedSpectrum("stdillum-D65"), 0.31272, 0.32903, 1e-4);
  ExpectChromaticity(NamedSpectrum("illum-acesD60"), 0.32168, 0.33767, 1e-4);
  ExpectChromaticity(Equal(1), 1. / 3, 1. / 3, 1e-4);
  ExpectChromaticity(NamedSpectrum("stdillum-F2"), 0.37208, 0.37529, 2e-4);
  ExpectChromaticity(NamedSpectrum("stdillum-F4"), 0.44018, 0.40329, 2e-4);
  ExpectChromaticity(NamedSpectrum("stdillum-F11"), 0.38052, 0.37713, 2e-4);
}

TEST(Cie, DaylightHasItsPublishedPowers) {
  const Daylight d65 = Daylight::OfTemperature(6503.616);
  EXPECT_NEAR(d65(560), 100, 1e-9);
  EXPECT_NEAR(d65(400), 82.7549, 0.01);
  EXPECT_NEAR(d65(460), 117.812, 0.01);
  EXPECT_NEAR(d65(700), 71.6091, 0.01);
  EXPECT_NEAR(d65(405), (d65(400) + d65(410)) / 2, 1e-9);
  EXPECT_NEAR(IlluminantA(380), 9.795100, 1e-4);
  EXPECT_NEAR(IlluminantA(780), 241.675, 1e-3);
}

TEST(Blackbody, LiesOnThePlanckianLocus) {
  ExpectChromaticity(Spectrum::Blackbody(2856), 0.44757, 0.40745, 1e-4);
  ExpectChromaticity(Spectrum::Blackbody(2000), 0.52669, 0.41331, 2e-4);
  ExpectChromaticity(Spectrum::Blackbody(6500), 0.31352, 0.32363, 2e-4);
  ExpectChromaticity(Spectrum::Blackbody(10000), 0.28063, 0.28828, 2e-4);
}

TEST(Blackbody, IsOneAtItsPeak) {
  const Spectrum sun = Spectrum::Blackbody(5772);
  double peak = 0;
  for (int nm = 360; nm <= 830; ++nm) peak = std::max(peak, sun(nm));
  EXPECT_NEAR(peak, 1, 1e-5);
  EXPECT_NEAR(sun(502.04), 1, 1e-5);  // Wien
  EXPECT_LT(Spectrum::Blackbody(2000)(500), 0.1);
}

TEST(Blackbody, ColorsFollowTheTemperature) {
  for (const double kelvin : {1500., 2856., 4000., 6504., 20000.}) {
    EXPECT_NEAR(ToXyz(Spectrum::Blackbody(kelvin)).y, BlackbodyV3(kelvin).Luminance() * 471 / 470,
                0.02 * ToXyz(Spectrum::Blackbody(kelvin)).y);
  }
  const Color white = BlackbodyV4(6504);
  EXPECT_NEAR(white.Luminance(), 1, 1e-3);
  ExpectNear(white, Color(1), 0.06f);
  const Color red = BlackbodyV4(2000);
  EXPECT_GT(red.r, 3 * red.g);
  EXPECT_GT(red.g, 3 * red.b);
  EXPECT_GT(BlackbodyV4(15000).b, BlackbodyV4(15000).r);
}

TEST(Blackbody, ExtremesAreFiniteAndNotNegative) {
  for (const double kelvin : {-5., 0., 1e-3, 1., 20., 300., 1000., 1e6, 1e12}) {
    for (const Color& color : {BlackbodyV3(kelvin), BlackbodyV4(kelvin)}) {
      EXPECT_TRUE(color.IsFinite()) << kelvin;
      for (int i = 0; i < 3; ++i) EXPECT_GE(color[i], 0) << kelvin;
    }
  }
  EXPECT_TRUE(BlackbodyV4(0).IsBlack());
}

TEST(SpectrumToColor, D65IsWhite) {
  ExpectNear(XyzToRgb(XyzOfChromaticity({0.3127, 0.3290})), Color(1), 1e-5f);
  ExpectNear(EmissionToColorV4(NamedSpectrum("stdillum-D65")), Color(1), 1e-3f);
  EXPECT_NEAR(EmissionToColorV4(NamedSpectrum("stdillum-A")).Luminance(), 1, 1e-3);
}

// The matrix of IEC 61966-2-1.
TEST(SpectrumToColor, RgbMatrixIsThatOfSrgb) {
  ExpectNear(XyzToRgb({1, 0, 0}), {3.2406f, -0.9689f, 0.0557f}, 5e-4f);
  ExpectNear(XyzToRgb({0, 1, 0}), {-1.5372f, 1.8758f, -0.2040f}, 5e-4f);
  ExpectNear(XyzToRgb({0, 0, 1}), {-0.4986f, 0.0415f, 1.0570f}, 5e-4f);
}

TEST(SpectrumToColor, ConstantIsTintedInV3AndGrayInV4) {
  // Equal-energy white in Rec. 709, less pbrt-v3's factor 470 / 471.
  const Color tint = Color(1.2048f, 0.9484f, 0.9087f) * (470.f / 471);
  ExpectNear(SpectrumToColorV3(Equal(1)), tint, 1e-3f);
  ExpectNear(SpectrumToColorV3(Equal(0.25)), tint * 0.25f, 1e-3f);
  ExpectNear(SpectrumToColorV4(Equal(0.25)), Color(0.25f), 1e-6f);
}

TEST(SpectrumToColor, IsLinear) {
  const std::vector<double> wavelengths = {400, 500, 600, 700};
  const std::vector<double> a = {0.1, 0.9, 0.2, 0.5}, b = {1, 0, 2, 1}, sum = {1.1, 0.9, 2.2, 1.5};
  const auto color = [&](const std::vector<double>& values) {
    return SpectrumToColorV3(Spectrum(wavelengths, values, Spectrum::Outside::kConstant));
  };
  ExpectNear(color(a) + color(b), color(sum), 1e-5f);
}

TEST(Spectrum, InterpolatesAndEndsAsAsked) {
  const std::vector<double> pairs = {500, 1, 400, 3, 600, 5};  // in any order
  const Spectrum constant = Spectrum::FromPairs(pairs, Spectrum::Outside::kConstant);
  EXPECT_EQ(constant(400), 3);
  EXPECT_EQ(constant(500), 1);
  EXPECT_EQ(constant(600), 5);
  EXPECT_NEAR(constant(425), 2.5, 1e-12);
  EXPECT_NEAR(constant(575), 4, 1e-12);
  EXPECT_EQ(constant(300), 3);
  EXPECT_EQ(constant(900), 5);
  const Spectrum zero = Spectrum::FromPairs(pairs, Spectrum::Outside::kZero);
  EXPECT_EQ(zero(399), 0);
  EXPECT_EQ(zero(400), 3);
  EXPECT_EQ(zero(600), 5);
  EXPECT_EQ(zero(601), 0);
  const Spectrum single = Spectrum::FromPairs(std::vector<double>{550, 2}, Spectrum::Outside::kConstant);
  EXPECT_EQ(single(360), 2);
  EXPECT_EQ(single(550), 2);
}

TEST(Spectrum, RejectsBadSamples) {
  const auto make = [](const std::vector<double>& pairs) {
    return Spectrum::FromPairs(pairs, Spectrum::Outside::kConstant, FileLocation("a.pbrt"));
  };
  EXPECT_THROW(make({}), Error);
  EXPECT_THROW(make({400}), Error);
  EXPECT_THROW(make({400, 1, 500}), Error);
  EXPECT_THROW(make({400, 1, 400, 2}), Error);
  EXPECT_THROW(make({-400, 1}), Error);
  EXPECT_THROW(make({400, NAN}), Error);
  EXPECT_THROW(make({INFINITY, 1}), Error);
}

TEST(ParseSpectrum, ReadsPairsWithComments) {
  const Spectrum spectrum =
      ParseSpectrum("# a metal\n400 1.5 # blue\r\n\t500.5 +2e0\n#end", "a.spd", Spectrum::Outside::kConstant);
  EXPECT_EQ(spectrum(400), 1.5);
  EXPECT_EQ(spectrum(500.5), 2);
}

TEST(ParseSpectrum, ErrorsSayWhere) {
  const auto errorOf = [](std::string_view text) -> std::string {
    try {
      ParseSpectrum(text, "a.spd", Spectrum::Outside::kConstant);
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_EQ(errorOf("400 1\n500 two\n"), "a.spd:2:5: error: \"two\" in a spectrum; expected a number");
  for (const char* bad : {"", "#", "400", "400 1 500", "400 nan", "400 inf", "nan 1", "400 1e999", "0 1", "-400 1",
                          "400 1 400 2", "400 1,", "400 0x1"})
    EXPECT_TRUE(errorOf(bad).starts_with("a.spd")) << bad << ": " << errorOf(bad);
}

TEST(NamedSpectrum, GlassesHaveTheirCatalogueIndices) {
  const auto expect = [](const char* name, double nd, double abbe) {
    const Spectrum eta = NamedSpectrum(name);
    EXPECT_NEAR(eta(kFraunhoferD), nd, 2e-5) << name;
    EXPECT_NEAR((eta(kFraunhoferD) - 1) / (eta(486.13) - eta(656.27)), abbe, 0.02) << name;
  };
  expect("glass-BK7", 1.5168, 64.17);
  expect("glass-BAF10", 1.67003, 47.11);
  expect("glass-FK51A", 1.48656, 84.47);
  expect("glass-LASF9", 1.85025, 32.17);
  expect("glass-SF5", 1.67271, 32.25);
  expect("glass-SF10", 1.72828, 28.53);
  expect("glass-SF11", 1.78472, 25.68);
  expect("glass-F11", 1.78472, 25.68);
  EXPECT_NEAR(NamedSpectrum("metal-MgO-eta")(kFraunhoferD), 1.7375, 5e-4);
  EXPECT_NEAR(NamedSpectrum("metal-TiO2-eta")(589.3), 2.909, 0.01);
}

// RGB values in wide use, integrated by others (Tungsten's table) from the same measurements; theirs has no factor 470
// / 471.
TEST(NamedSpectrum, MetalsAgreeWithValuesOfOthers) {
  const auto expect = [](const std::string& metal, const Color& eta, const Color& k) {
    const Spectrum n = NamedSpectrum("metal-" + metal + "-eta"), kappa = NamedSpectrum("metal-" + metal + "-k");
    ExpectNearRelative(SpectrumToColorV3(n) * (471.f / 470), eta, 0.002f);
    ExpectNearRelative(SpectrumToColorV3(kappa) * (471.f / 470), k, 0.002f);
  };
  expect("Ag", {0.15526f, 0.11672f, 0.13838f}, {4.82834f, 3.12225f, 2.14695f});
  expect("Al", {1.65746f, 0.88037f, 0.52123f}, {9.22387f, 6.26952f, 4.83700f});
  expect("Au", {0.14312f, 0.37496f, 1.44248f}, {3.98316f, 2.38572f, 1.60322f});
  expect("Cu", {0.20044f, 0.92403f, 1.10221f}, {3.91295f, 2.45285f, 2.14219f});
  expect("CuZn", {0.51977f, 0.48851f, 1.04201f}, {4.33058f, 2.54811f, 1.59189f});
  ExpectNearRelative(SpectrumToColorV3(NamedSpectrum("metal-MgO-eta")), {2.08959f, 1.65072f, 1.59488f}, 0.01f);
  ExpectNearRelative(SpectrumToColorV3(NamedSpectrum("metal-TiO2-eta")), {3.45662f, 2.80171f, 2.90515f}, 0.02f);
  EXPECT_TRUE(SpectrumToColorV4(NamedSpectrum("metal-MgO-k")).IsBlack());
}

TEST(NamedSpectrum, MetalsAgreeWithMeasuredFiles) {
  const char* references = std::getenv("DAPPLE_REFERENCES");
  if (!references) GTEST_SKIP() << "DAPPLE_REFERENCES is not set";
  for (const std::string metal : {"Ag", "Al", "Au", "Cu"}) {
    for (const std::string part : {"eta", "k"}) {
      SCOPED_TRACE(metal + " " + part);
      const std::string path = std::string(references) + "/../data/spds/" + metal + "." + part + ".spd";
      std::ostringstream text;
      text << std::ifstream(path, std::ios::binary).rdbuf();
      const Color file = SpectrumToColorV3(ParseSpectrum(text.str(), path, Spectrum::Outside::kConstant));
      const Color named = SpectrumToColorV3(NamedSpectrum("metal-" + metal + "-" + part));
      ExpectNearRelative(named, file, 0.001f);
    }
  }
}

// The colours for pbrt-v4 stand for its spectral rendering: reflectance of a smooth metal, seen under D65.
TEST(NamedSpectrum, V4MetalColorsReflectLikeTheSpectrum) {
  const auto reflectance = [](double n, double k) { return (Sqr(n - 1) + k * k) / (Sqr(n + 1) + k * k); };
  for (const std::string metal : {"Ag", "Al", "Au", "Cu", "CuZn"}) {
    SCOPED_TRACE(metal);
    const Spectrum n = NamedSpectrum("metal-" + metal + "-eta"), k = NamedSpectrum("metal-" + metal + "-k");
    const Color seen = SpectrumToColorV4(Spectrum::Sampled([&](double nm) { return reflectance(n(nm), k(nm)); }));
    const Color nColor = SpectrumToColorV4(n), kColor = SpectrumToColorV4(k);
    Color fromColors;
    for (int i = 0; i < 3; ++i) fromColors[i] = static_cast<float>(reflectance(nColor[i], kColor[i]));
    ExpectNear(fromColors, seen, 0.05f);
  }
}

TEST(NamedSpectrum, AllNamesWorkAndOthersAreExplained) {
  EXPECT_EQ(SpectrumNames().size(), 14u + 10 + 16);
  for (const std::string& name : SpectrumNames()) {
    EXPECT_TRUE(IsSpectrumName(name));
    const Color color = SpectrumToColorV4(NamedSpectrum(name));
    EXPECT_TRUE(color.IsFinite()) << name;
    for (int i = 0; i < 3; ++i) EXPECT_GE(color[i], 0) << name;
  }
  EXPECT_FALSE(IsSpectrumName("metal-Xx-eta"));
  try {
    NamedSpectrum("metal-Xx-eta", FileLocation("a.pbrt"));
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("metal-Au-eta"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("a.pbrt"), std::string::npos);
  }
}

TEST(ColorSpace, PrimariesHaveTheirKnownRec709Values) {
  const auto convert = [](const Color& rgb, const char* name, RgbUse use = RgbUse::kEmission) {
    return RgbFromColorSpace(rgb, name, use);
  };
  const Color any(0.2f, 0.7f, 0.4f);
  EXPECT_EQ(convert(any, "sRGB"), any);
  ExpectNear(convert({1, 0, 0}, "rec2020"), {1.6605f, -0.1246f, -0.0182f}, 3e-4f);
  ExpectNear(convert({0, 1, 0}, "Rec2020"), {-0.5876f, 1.1329f, -0.1006f}, 3e-4f);
  ExpectNear(convert({1, 0, 0}, "dci-p3"), {1.2249f, -0.0421f, -0.0196f}, 3e-4f);
  ExpectNear(convert(Color(1), "rec2020"), Color(1), 1e-5f);
  ExpectNear(convert(Color(1), "dci-p3"), Color(1), 1e-5f);
}

TEST(ColorSpace, AcesWhiteReflectsAllButShinesWarm) {
  ExpectNear(RgbFromColorSpace(Color(1), "aces2065-1", RgbUse::kReflectance), Color(1), 1e-5f);
  const Color lamp = RgbFromColorSpace(Color(1), "aces2065-1", RgbUse::kEmission);
  ExpectNear(lamp, XyzToRgb(XyzOfChromaticity({0.32168, 0.33767})), 1e-5f);
  EXPECT_GT(lamp.r, lamp.b);
  // The matrix AP0 to Rec. 709 with Bradford adaptation, as ACES publishes it.
  ExpectNear(RgbFromColorSpace({1, 0, 0}, "aces2065-1", RgbUse::kReflectance), {2.5217f, -0.2765f, -0.0154f}, 2e-3f);
}

TEST(ColorSpace, UnknownNameIsAnError) {
  EXPECT_TRUE(IsColorSpaceName("ACES2065-1"));
  EXPECT_FALSE(IsColorSpaceName("cmyk"));
  EXPECT_THROW(RgbFromColorSpace(Color(1), "cmyk", RgbUse::kEmission), Error);
}

}  // namespace
}  // namespace dapple
