// Material statements of both versions: defaults and meanings, seen from the BSDFs they give.
#include <fmt/format.h>

#include "src/base/numerics.h"
#include "src/image/image_io.h"
#include "src/materials/fresnel.h"
#include "src/materials/named_spectra.h"
#include "tests/io/build_test_support.h"

namespace dapple {
namespace {

/// The BSDF of a square that faces the camera, straight on.
Bsdf BsdfOf(const std::string& material, int version) {
  return BsdfAtXY(*CleanWorld(material + "\n" + Square(version), version), 0.1, 0.2);
}

const Vec3 kTowardCamera(0, 0, -1);

/// f at normal incidence, straight back.
Color Back(const Bsdf& bsdf) { return bsdf.Eval(kTowardCamera, kTowardCamera, TransportMode::Radiance); }

/// What a smooth surface reflects straight back.
Color MirroredBack(const Bsdf& bsdf) {
  for (double uc : {0.01, 0.5, 0.99}) {
    const std::optional<BsdfSample> sample = bsdf.Sample(kTowardCamera, uc, {0.5, 0.5}, TransportMode::Radiance);
    if (sample && sample->IsSpecular() && sample->wi.z < 0) return sample->weight * sample->pdf;
  }
  return Color(-1);
}

MaterialFacts FactsOf(const std::string& material, int version) {
  const auto scene = CleanWorld(material + "\n" + Square(version), version);
  return scene->MaterialAt(*LookAtXY(*scene, 0.1, 0.2))->Facts();
}

TEST(BuildMaterials, DiffuseDefaultsToOneHalf) {
  for (const std::string material : {"", "Material \"diffuse\""})
    ExpectColor(Back(BsdfOf(material, 4)), Color(0.5f * kInvPi));
  ExpectColor(Back(BsdfOf("Material \"matte\"", 3)), Color(0.5f * kInvPi));
  ExpectColor(Back(BsdfOf("Material \"matte\" \"rgb Kd\" [.1 .2 .3]", 3)), Color(.1f, .2f, .3f) * kInvPi);
  ExpectColor(Back(BsdfOf("Material \"diffuse\" \"rgb reflectance\" [.1 .2 .3]", 4)), Color(.1f, .2f, .3f) * kInvPi);
  // A constant spectrum is gray in v4; in v3 it is seen under equal energy.
  ExpectColor(Back(BsdfOf("Material \"diffuse\" \"spectrum reflectance\" [300 .4 900 .4]", 4)), Color(.4f * kInvPi),
              1e-3);
  EXPECT_GT(Back(BsdfOf("Material \"matte\" \"spectrum Kd\" [300 .4 900 .4]", 3)).r, 0.45f * kInvPi);
}

TEST(BuildMaterials, SigmaMakesOrenNayar) {
  // Oren and Nayar's A at normal incidence, with the two versions' names.
  const double sigma2 = Sqr(Radians(20)), A = 1 - sigma2 / (2 * (sigma2 + 0.33));
  ExpectColor(Back(BsdfOf("Material \"matte\" \"float sigma\" [20]", 3)), Color(static_cast<float>(0.5 * A) * kInvPi),
              1e-3);
  ExpectColor(Back(BsdfOf("Material \"diffuse\" \"float sigma\" 20", 4)), Color(static_cast<float>(0.5 * A) * kInvPi),
              1e-3);
}

TEST(BuildMaterials, MirrorsAndMetals) {
  ExpectColor(MirroredBack(BsdfOf("Material \"mirror\"", 3)), Color(0.9f));
  const MaterialFacts conductor = FactsOf("Material \"conductor\"", 4);
  EXPECT_TRUE(conductor.hasSpecular && !conductor.hasNonSpecular);
  const Color copper = MirroredBack(BsdfOf("Material \"conductor\"", 4));
  EXPECT_GT(copper.r, 0.9f);
  EXPECT_LT(copper.b, 0.6f);
  ExpectColor(MirroredBack(BsdfOf("Material \"conductor\" \"rgb reflectance\" [.9 .8 .7]", 4)), Color(.9f, .8f, .7f),
              1e-3);
  // ((eta - 1)^2 + k^2) / ((eta + 1)^2 + k^2)
  ExpectColor(MirroredBack(BsdfOf("Material \"conductor\" \"rgb eta\" [2 2 2] \"rgb k\" [1 2 3]", 4)),
              Color(2 / 10.f, 5 / 13.f, 10 / 18.f), 1e-3);
  EXPECT_TRUE(FactsOf("Material \"metal\"", 3).hasNonSpecular) << "pbrt-v3's metal is a little rough";
}

TEST(BuildMaterials, NamedMetalsAndSpdFilesAgree) {
  const TestFolder folder;
  folder.Write("eta.spd", "# a constant\n300 2\n900 2\n");
  folder.Write("k.spd", "300 1\n900 1\n");
  const auto scene = CleanWorld(
      "Material \"conductor\" \"spectrum eta\" \"eta.spd\" \"spectrum k\" \"k.spd\"\n" + Square(4), 4, folder.Path());
  ExpectColor(MirroredBack(BsdfAtXY(*scene, 0.1, 0.2)), Color(0.2f), 1e-3);
  const Color named =
      MirroredBack(BsdfOf("Material \"conductor\" \"spectrum eta\" \"metal-Cu-eta\" \"spectrum k\" \"metal-Cu-k\"", 4));
  ExpectColor(named, MirroredBack(BsdfOf("Material \"conductor\"", 4)));
}

TEST(BuildMaterials, RoughnessIsRemappedAsEachVersionDoes) {
  EXPECT_NEAR(FactsOf("Material \"conductor\" \"float roughness\" .09", 4).minRoughness, 0.3, 1e-5);
  EXPECT_NEAR(FactsOf("Material \"conductor\" \"float roughness\" .09 \"bool remaproughness\" false", 4).minRoughness,
              0.09, 1e-5);
  EXPECT_NEAR(FactsOf("Material \"conductor\" \"float uroughness\" .25 \"float roughness\" .09", 4).minRoughness, 0.3,
              1e-5);
  // pbrt-v3: 1.62142 + 0.819955 x + 0.1734 x^2 + 0.0171201 x^3 + 0.000640711 x^4 of x = ln 0.1, plastic's default.
  const double x = std::log(0.1);
  const double alpha = 1.62142 + 0.819955 * x + 0.1734 * x * x + 0.0171201 * x * x * x + 0.000640711 * x * x * x * x;
  EXPECT_NEAR(FactsOf("Material \"plastic\"", 3).minRoughness, alpha, 1e-4);
  EXPECT_NEAR(FactsOf("Material \"plastic\" \"bool remaproughness\" \"false\"", 3).minRoughness, 0.1, 1e-6);
}

TEST(BuildMaterials, PlasticDefaultsAreAQuarterEach) {
  const Bsdf plain = BsdfOf("Material \"plastic\"", 3), noGloss = BsdfOf("Material \"plastic\" \"rgb Ks\" [0 0 0]", 3);
  ExpectColor(Back(noGloss), Color(0.25f * kInvPi));
  const Bsdf gloss = BsdfOf("Material \"plastic\" \"rgb Kd\" [0 0 0]", 3),
             full = BsdfOf("Material \"plastic\" \"rgb Kd\" [0 0 0] \"rgb Ks\" [1 1 1]", 3);
  ExpectColor(Back(gloss), Back(full) * 0.25f);
  ExpectColor(Back(plain), Back(noGloss) + Back(gloss));
}

TEST(BuildMaterials, GlassOfBothVersions) {
  const double R = Sqr(0.5 / 2.5);
  for (const auto& [material, version] :
       {std::pair{"Material \"glass\"", 3}, std::pair{"Material \"dielectric\"", 4}}) {
    const MaterialFacts facts = FactsOf(material, version);
    EXPECT_TRUE(facts.hasSpecular && facts.hasTransmission && !facts.hasNonSpecular) << material;
    ExpectColor(MirroredBack(BsdfOf(material, version)), Color(static_cast<float>(R)), 1e-3);
  }
  ExpectColor(MirroredBack(BsdfOf("Material \"glass\" \"float index\" [2]", 3)), Color(1 / 9.f), 1e-3);
  ExpectColor(MirroredBack(BsdfOf("Material \"glass\" \"float eta\" [2] \"rgb Kr\" [.5 1 0]", 3)), Color(.5f, 1, 0) / 9,
              1e-3);
  EXPECT_FALSE(FactsOf("Material \"dielectric\" \"float roughness\" .2", 4).hasSpecular);
  // pbrt-v3's glass asks for uroughness and vroughness.
  EXPECT_FALSE(FactsOf("Material \"glass\" \"float uroughness\" [.2] \"float vroughness\" [.2]", 3).hasSpecular);
  // Of a spectrum, the index at the helium d line.
  const double eta = NamedSpectrum("glass-SF11")(kFraunhoferD);
  ExpectColor(MirroredBack(BsdfOf("Material \"dielectric\" \"spectrum eta\" \"glass-SF11\"", 4)),
              Color(static_cast<float>(Sqr((eta - 1) / (eta + 1)))), 1e-3);
  // A thin sheet reflects 2 R / (1 + R) in all.
  ExpectColor(MirroredBack(BsdfOf("Material \"thindielectric\"", 4)), Color(static_cast<float>(2 * R / (1 + R))), 1e-3);
}

TEST(BuildMaterials, TransmissionDefaults) {
  const Bsdf sheet = BsdfOf("Material \"diffusetransmission\"", 4);
  ExpectColor(Back(sheet), Color(0.25f * kInvPi));
  ExpectColor(sheet.Eval(kTowardCamera, -kTowardCamera, TransportMode::Radiance), Color(0.25f * kInvPi));
  const Bsdf scaled = BsdfOf("Material \"diffusetransmission\" \"rgb reflectance\" [.2 .4 .1] \"float scale\" 2", 4);
  ExpectColor(Back(scaled), Color(.4f, .8f, .2f) * kInvPi);
  EXPECT_TRUE(FactsOf("Material \"translucent\"", 3).hasTransmission);
}

TEST(BuildMaterials, CoatsAreSmoothByDefault) {
  const MaterialFacts coated = FactsOf("Material \"coateddiffuse\"", 4);
  EXPECT_TRUE(coated.hasSpecular && coated.hasNonSpecular);
  ExpectColor(MirroredBack(BsdfOf("Material \"coateddiffuse\"", 4)), Color(0.04f), 1e-3);
  EXPECT_TRUE(FactsOf("Material \"coatedconductor\"", 4).hasSpecular);
  EXPECT_FALSE(FactsOf("Material \"coateddiffuse\" \"float roughness\" .1 \"float thickness\" .01", 4).hasSpecular);
}

TEST(BuildMaterials, SubstrateAndUber) {
  EXPECT_NEAR(FactsOf("Material \"substrate\" \"bool remaproughness\" \"false\"", 3).minRoughness, 0.1, 1e-6);
  ExpectColor(Back(BsdfOf("Material \"uber\" \"rgb Ks\" [0 0 0]", 3)), Color(0.25f * kInvPi));
  const MaterialFacts uber = FactsOf("Material \"uber\" \"rgb Kr\" [.5 .5 .5] \"rgb opacity\" [.5 .5 .5]", 3);
  EXPECT_TRUE(uber.hasSpecular && uber.hasTransmission);
}

TEST(BuildMaterials, SubstratesThatWouldGainEnergyAreScaledWithAWarningOfTheirPlace) {
  const std::string rough = R"(Material "substrate" "float uroughness" [1] "float vroughness" [1] "rgb Ks" )";
  const Built scaled = BuildWorld(rough + "[1 1 1]\n" + Square(3), 3);
  ASSERT_EQ(scaled.warnings.size(), 1u);
  EXPECT_EQ(scaled.warnings[0].substr(0, 20), "a.pbrt:5:1: warning:");
  EXPECT_NE(scaled.warnings[0].find("1.43 times"), std::string::npos) << scaled.warnings[0];
  BsdfOf(rough + "[.6 .6 .6]", 3);  // reflects no more than arrives: without a word
}

TEST(BuildMaterials, MixesOfBothVersions) {
  const std::string v3 = R"(MakeNamedMaterial "a" "string type" "matte" "rgb Kd" [0 0 0]
      MakeNamedMaterial "b" "string type" "matte" "rgb Kd" [1 1 1]
      Material "mix" "string namedmaterial1" "a" "string namedmaterial2" "b" "rgb amount" [.25 .25 .25])";
  ExpectColor(Back(BsdfOf(v3, 3)), Color(0.75f * kInvPi));  // 0.25 of the first
  const std::string v4 = R"(MakeNamedMaterial "a" "string type" "diffuse" "rgb reflectance" [0 0 0]
      MakeNamedMaterial "b" "string type" "diffuse" "rgb reflectance" [1 1 1]
      Material "mix" "string materials" ["a" "b"] "float amount" .25)";
  ExpectColor(Back(BsdfOf(v4, 4)), Color(0.25f * kInvPi));  // 0.25 of the second
}

TEST(BuildMaterials, TexturesDriveParameters) {
  const std::string textures = R"(Texture "c" "spectrum" "checkerboard" "float uscale" [2] "float vscale" [2]
        "rgb tex1" [.8 .4 .2] "rgb tex2" [.1 .1 .1]
      Texture "f" "float" "constant" "float value" [.3]
  )";
  const auto scene = CleanWorld(textures + "Material \"diffuse\" \"texture reflectance\" \"c\"\n" + Square(4), 4);
  ExpectColor(Back(BsdfAtXY(*scene, -0.5, -0.5)), Color(.8f, .4f, .2f) * kInvPi);
  ExpectColor(Back(BsdfAtXY(*scene, 0.5, -0.5)), Color(.1f) * kInvPi);
  EXPECT_NEAR(FactsOf(textures + "Material \"conductor\" \"texture roughness\" \"f\" \"bool remaproughness\" false", 4)
                  .minRoughness,
              0.3, 1e-5);
  EXPECT_EQ(
      MessageOf([&] { BuildWorld(textures + "Material \"diffuse\" \"texture reflectance\" \"f\"\n" + Square(4), 4); }),
      "a.pbrt:8:22: error: texture \"f\" of parameter \"reflectance\" is a float texture, expected a spectrum one");
  EXPECT_EQ(MessageOf([&] {
              BuildWorld(textures + "Material \"diffuse\" \"texture reflectance\" \"d\"\n" + Square(4), 4);
            }).substr(0, 66),
            "a.pbrt:8:22: error: no spectrum texture is named \"d\" here; did you");
}

TEST(BuildMaterials, BumpAndNormalMapsTurnTheFrame) {
  // A displacement that rises along u: dz/dx = slope.
  const std::string ramp = R"(Texture "ramp" "float" "bilerp" "float v00" 0 "float v01" 0 "float v10" .5 "float v11" .5
      Material "diffuse" "texture displacement" "ramp"
  )";
  const auto bumped = CleanWorld(ramp + Square(4), 4);
  const Vec3 n = BsdfAtXY(*bumped, 0.1, 0.2).ShadingFrame().n;
  EXPECT_NEAR(std::abs(n.x / n.z), 0.25, 1e-3);

  const TestFolder folder;
  Image map = Image::Rgb(1, 1);
  for (int c = 0; c < 3; ++c) map.At(0, 0, c) = c == 0 ? 0.5f + 0.3f : (c == 1 ? 0.5f : 0.5f + 0.4f);
  WriteExr((folder.Path() / "n.exr").string(), map);
  const auto mapped = CleanWorld("Material \"diffuse\" \"string normalmap\" \"n.exr\"\n" + Square(4), 4, folder.Path());
  const Vec3 m = BsdfAtXY(*mapped, 0.1, 0.2).ShadingFrame().n;
  EXPECT_NEAR(std::abs(m.x), 0.6, 1e-3);
}

TEST(BuildMaterials, StandInsComeWithAWarningOfTheirPlace) {
  for (const std::string type : {"hair", "measured", "subsurface", "fourier", "disney", "kdsubsurface"}) {
    const Built built = BuildWorld("Material \"" + type + "\"\n" + Square(4), 4);
    ASSERT_EQ(built.warnings.size(), 1u) << type;
    EXPECT_EQ(built.warnings[0].substr(0, 20), "a.pbrt:5:1: warning:");
    EXPECT_NE(built->MaterialAt(*LookAtXY(*built.scene, 0.1, 0.2)), nullptr);
  }
  const Built skin = BuildWorld("Material \"subsurface\" \"rgb reflectance\" [.7 .5 .4]\n" + Square(4), 4);
  ExpectColor(Back(BsdfAtXY(*skin.scene, 0.1, 0.2)), Color(.7f, .5f, .4f) * kInvPi);
}

TEST(BuildMaterials, UnusedMaterialsAreNotBuilt) {
  // Its texture's file does not exist, and nobody asks for it.
  CleanWorld(R"(Texture "t" "spectrum" "imagemap" "string filename" "nowhere.png"
      MakeNamedMaterial "a" "string type" "diffuse" "texture reflectance" "t"
      Shape "sphere")",
             4);
}

TEST(BuildMaterials, DistributionChoosesTheMicrofacets) {
  const float s = std::sin(0.8f), c = std::cos(0.8f);
  const Vec3 aside(s, 0, -c), above(0, s, -c);  // as the camera sees the square
  const auto value = [&](const std::string& parameters, const Vec3& wi) {
    const Bsdf bsdf =
        BsdfOf("Material \"conductor\" \"rgb reflectance\" [.9 .9 .9] \"bool remaproughness\" false " + parameters, 4);
    return bsdf.Eval(kTowardCamera, wi, TransportMode::Radiance).g / c;
  };
  const auto expected = [&](const auto& microfacets, const Vec3& wi) {
    const RoughConductor lobe{microfacets, Color(1), ConductorKFromReflectance(Color(0.9f))};
    return lobe.Value({0, 0, 1}, wi, TransportMode::Radiance).g;
  };
  const auto named = [](const std::string& name) { return "\"string distribution\" \"" + name + "\""; };
  const std::string rough = "\"float roughness\" .3 ";
  const Vec3 wi(s, 0, c);
  EXPECT_NEAR(value(rough, aside) / expected(Ggx(0.3f, 0.3f), wi), 1, 1e-4);
  EXPECT_NEAR(value(rough + named("ggx"), aside) / expected(Ggx(0.3f, 0.3f), wi), 1, 1e-4);
  EXPECT_NEAR(value(rough + named("beckmann"), aside) / expected(Beckmann(0.3f, 0.3f), wi), 1, 1e-4);
  const float exponent = 2 / 0.09f - 2;
  EXPECT_NEAR(value(rough + named("blinn"), aside) / expected(CosinePower(exponent, exponent), wi), 1, 1e-4);
  const std::string brushed = "\"float uroughness\" .5 \"float vroughness\" .2 " + named("ashikhminshirley");
  const CosinePower anisotropic(6, 48);
  EXPECT_NEAR(value(brushed, aside) * value(brushed, above) /
                  (expected(anisotropic, wi) * expected(anisotropic, Vec3(0, s, c))),
              1, 1e-4);
  EXPECT_GT(std::abs(std::log(value(brushed, aside) / value(brushed, above))), 1);
}

TEST(BuildMaterials, DistributionIsKnownToAllRoughMaterials) {
  const Vec3 wi = Normalize(Vec3(0.6f, 0.2f, -0.7f));
  const std::string one = R"("float roughness" .3)", two = R"("float uroughness" .3 "float vroughness" .3)";
  const std::pair<std::string, int> materials[] = {{R"("metal" )" + one, 3},       {R"("plastic" )" + one, 3},
                                                   {R"("substrate" )" + two, 3},   {R"("uber" )" + one, 3},
                                                   {R"("translucent" )" + one, 3}, {R"("glass" )" + two, 3},
                                                   {R"("dielectric" )" + one, 4},  {R"("conductor" )" + one, 4}};
  for (const auto& [material, version] : materials) {
    const auto value = [&, &text = material, format = version](const std::string& name) {
      const Bsdf bsdf = BsdfOf("Material " + text + R"( "string distribution" ")" + name + '"', format);
      return bsdf.Eval(kTowardCamera, wi, TransportMode::Radiance).g;
    };
    EXPECT_NE(value("ggx"), value("beckmann")) << material;
    EXPECT_NE(value("blinn"), value("beckmann")) << material;
    EXPECT_EQ(value("blinn"), value("ashikhminshirley")) << material << ": isotropic, they are one";
  }
  const Built coat = BuildWorld("Material \"coateddiffuse\" \"string distribution\" \"blinn\"\n" + Square(4), 4);
  ASSERT_EQ(coat.warnings.size(), 1u);
  EXPECT_NE(coat.warnings[0].find("distribution"), std::string::npos);
}

TEST(BuildMaterials, ErrorsHaveAPlace) {
  const auto error = [](const std::string& text) { return WorldError(text + "\n" + Square(4), 4); };
  EXPECT_EQ(error(R"(Material "difuse")").substr(0, 46), "a.pbrt:5:1: error: unknown material \"difuse\", ");
  EXPECT_NE(error(R"(Material "difuse")").find("did you mean \"diffuse\"?"), std::string::npos);
  EXPECT_EQ(error(R"(Material "mix" "string materials" ["x" "y"])"), "a.pbrt:5:16: error: no material is named \"x\"");
  EXPECT_EQ(error(R"(Material "mix" "string materials" ["x"])").substr(0, 18), "a.pbrt:5:16: error");
  EXPECT_EQ(error(R"(MakeNamedMaterial "m" "string type" "mix" "string materials" ["m" "m"]
NamedMaterial "m")"),
            "a.pbrt:5:43: error: material \"m\" is a mix of itself");
  EXPECT_EQ(error(R"(Material "diffuse" "spectrum reflectance" "metal-Xx-eta")").substr(0, 18), "a.pbrt:5:20: error");
  EXPECT_EQ(error(R"(Material "diffuse" "rgb reflectance" [1 1 1 0 0 0])"),
            "a.pbrt:5:20: error: parameter \"reflectance\" has 2 values, expected one");
  EXPECT_EQ(error(R"(Material "diffuse" "string reflectance" "red")").substr(0, 18), "a.pbrt:5:20: error");
  EXPECT_EQ(error(R"(Material "conductor" "rgb eta" [1 1 1] "rgb reflectance" [1 1 1])").substr(0, 18),
            "a.pbrt:5:40: error");
  EXPECT_EQ(error(R"(Material "conductor" "string distribution" "bekmann")"),
            "a.pbrt:5:22: error: unknown microfacet distribution \"bekmann\", expected one of ggx, beckmann, blinn, "
            "ashikhminshirley; did you mean \"beckmann\"?");
}

TEST(BuildMaterials, MixesNameEachOtherSoDeepAndSoOften) {
  // The error of "mN", each of N mixes of the one before, which counts for nothing, and of `other`.
  const auto error = [](int last, const std::string& other) {
    std::string text = "MakeNamedMaterial \"m0\" \"string type\" \"diffuse\"\n";
    for (int i = 1; i <= last; ++i) {
      const std::string below = "\"m" + std::to_string(i - 1) + "\"";
      text += "MakeNamedMaterial \"m" + std::to_string(i) + "\" \"string type\" \"mix\" \"float amount\" 1 " +
              "\"string materials\" [" + below + " " + (other.empty() ? below : other) + "]\n";
    }
    return WorldError(text + "NamedMaterial \"m" + std::to_string(last) + "\"\n" + Square(4), 4);
  };
  EXPECT_EQ(error(63, "\"m0\""), "no error");
  EXPECT_EQ(error(64, "\"m0\""), "a.pbrt:6:61: error: mixes name each other more than 64 deep");
  EXPECT_EQ(error(9, ""), "no error") << "2^10 - 1 materials";
  EXPECT_EQ(error(10, ""),
            "a.pbrt:15:62: error: a mix of more than 1024 materials, each counted as often as it is named");
}

TEST(BuildMaterials, ValuesWithoutMeaningAreErrors) {
  const std::pair<const char*, int> materials[] = {{R"("dielectric" "float eta" -1.5)", 4},
                                                   {R"("dielectric" "float eta" 0)", 4},
                                                   {R"("dielectric" "spectrum eta" [300 -1 900 -1])", 4},
                                                   {R"("thindielectric" "float eta" 0)", 4},
                                                   {R"("dielectric" "float roughness" -.1)", 4},
                                                   {R"("dielectric" "float vroughness" -.1)", 4},
                                                   {R"("conductor" "rgb eta" [1 -1 1])", 4},
                                                   {R"("conductor" "rgb k" [1 1 -1])", 4},
                                                   {R"("conductor" "spectrum k" [300 1 900 -1])", 4},
                                                   {R"("conductor" "float uroughness" -1)", 4},
                                                   {R"("coateddiffuse" "float eta" -1.5)", 4},
                                                   {R"("coateddiffuse" "float roughness" -1)", 4},
                                                   {R"("coateddiffuse" "float thickness" -1)", 4},
                                                   {R"("coateddiffuse" "float g" 1.5)", 4},
                                                   {R"("coateddiffuse" "float g" -1.5)", 4},
                                                   {R"("coateddiffuse" "integer maxdepth" -1)", 4},
                                                   {R"("coateddiffuse" "integer nsamples" 0)", 4},
                                                   {R"("coatedconductor" "float interface.eta" 0)", 4},
                                                   {R"("coatedconductor" "float interface.roughness" -1)", 4},
                                                   {R"("coatedconductor" "float conductor.roughness" -1)", 4},
                                                   {R"("coatedconductor" "rgb conductor.k" [-1 1 1])", 4},
                                                   {R"("diffusetransmission" "float scale" -1)", 4},
                                                   {R"("glass" "float index" -1.5)", 3},
                                                   {R"("glass" "float eta" 0)", 3},
                                                   {R"("glass" "float uroughness" -1)", 3},
                                                   {R"("metal" "rgb eta" [-1 1 1])", 3},
                                                   {R"("metal" "rgb k" [-1 1 1])", 3},
                                                   {R"("metal" "float roughness" -1)", 3},
                                                   {R"("plastic" "float roughness" -1)", 3},
                                                   {R"("translucent" "float roughness" -1)", 3},
                                                   {R"("substrate" "float vroughness" -1)", 3},
                                                   {R"("uber" "float index" -1)", 3},
                                                   {R"("uber" "float roughness" -1)", 3},
                                                   {R"("matte" "blackbody Kd" [-3 1])", 3},
                                                   {R"("matte" "blackbody Kd" [3000 -1])", 3},
                                                   {R"("diffuse" "blackbody reflectance" 0)", 4}};
  for (const auto& [material, version] : materials) {
    const std::string text = std::string("Material ") + material;
    const std::size_t column = text.find("\" \"") + 3;
    EXPECT_EQ(WorldError(text + "\n" + Square(version), version).rfind(fmt::format("a.pbrt:5:{}: error: ", column), 0),
              0u)
        << text << ": " << WorldError(text + "\n" + Square(version), version);
  }
  EXPECT_EQ(WorldError("Material \"dielectric\" \"float roughness\" -2\n" + Square(4), 4),
            "a.pbrt:5:23: error: parameter \"roughness\" is -2, expected 0 or more");
  EXPECT_EQ(WorldError("Material \"coateddiffuse\" \"float g\" -2\n" + Square(4), 4),
            "a.pbrt:5:26: error: parameter \"g\" is -2, expected -1 to 1");
  EXPECT_EQ(WorldError("Material \"dielectric\" \"float eta\" 0\n" + Square(4), 4),
            "a.pbrt:5:23: error: the value of parameter \"eta\" is 0, expected more than 0");
}

TEST(BuildMaterials, ClampedSharesAreTold) {
  const auto warnings = [](const std::string& material, int version) {
    const Built built = BuildWorld("Material " + material + "\n" + Square(version), version);
    std::string lines;
    for (const std::string& line : built.warnings) lines += line + "\n";
    return lines;
  };
  EXPECT_EQ(warnings(R"("diffuse" "rgb reflectance" [1.5 .5 -.25])", 4),
            "a.pbrt:5:20: warning: parameter \"reflectance\" is 1.5 0.5 -0.25, expected 0 to 1; it is clamped to 1 0.5 "
            "0\n");
  EXPECT_EQ(
      warnings(R"("diffuse" "spectrum reflectance" [300 1.5 900 1.5])", 4),
      "a.pbrt:5:20: warning: parameter \"reflectance\" has the value 1.5, expected 0 to 1; where the colour that it "
      "makes is beyond that, it is clamped\n");
  const std::pair<const char*, int> clamped[] = {
      {R"("matte" "rgb Kd" [2 1 1])", 3},       {R"("mirror" "rgb Kr" [2 1 1])", 3},
      {R"("glass" "rgb Kt" [1 1 -1])", 3},      {R"("plastic" "rgb Ks" [2 0 0] "rgb Kd" [0 0 0])", 3},
      {R"("uber" "rgb opacity" [2 1 1])", 3},   {R"("translucent" "rgb reflect" [2 1 1])", 3},
      {R"("substrate" "rgb Kd" [2 0 0])", 3},   {R"("conductor" "rgb reflectance" [2 1 1])", 4},
      {R"("diffuse" "float reflectance" 2)", 4}};
  for (const auto& [material, version] : clamped)
    EXPECT_NE(warnings(material, version).find("expected 0 to 1; it is clamped to "), std::string::npos) << material;
  // What is multiplied first, a colour beyond the gamut's border, and what a texture gives.
  EXPECT_EQ(warnings(R"("diffusetransmission" "rgb reflectance" [2 2 2] "float scale" .5)", 4), "");
  EXPECT_NE(warnings(R"("diffusetransmission" "rgb reflectance" [1 1 1] "float scale" 2)", 4), "");
  EXPECT_EQ(warnings("\"diffuse\"\nColorSpace \"rec2020\"\nMaterial \"diffuse\" \"rgb reflectance\" [0 1 0]", 4), "");
  EXPECT_EQ(warnings("\"diffuse\"\nTexture \"t\" \"spectrum\" \"constant\" \"rgb value\" [2 2 2]\n"
                     "Material \"diffuse\" \"texture reflectance\" \"t\"",
                     4),
            "");
}

}  // namespace
}  // namespace dapple
