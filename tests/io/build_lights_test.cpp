// Light statements of both versions: what they shine, in numbers.
#include <fmt/format.h>

#include "src/base/numerics.h"
#include "src/image/image_io.h"
#include "tests/io/build_test_support.h"

namespace dapple {
namespace {

/// A scene with a square at z = 0 (2 x 2, facing the camera) and what `lights` says.
Built Lit(const std::string& lights, int version, const std::filesystem::path& folder = "",
          const BuildOptions& options = {}) {
  return BuildText("LookAt 0 0 -5  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 30\nWorldBegin\n\n" + lights +
                       "\n" + Square(version) + (version == 3 ? "WorldEnd\n" : ""),
                   version, options, folder);
}

/// What arrives at the world's origin from the only light.
LiSample Arriving(const Built& built, const Vec2d& u = {0.5, 0.5}) {
  EXPECT_EQ(built->Lights().size(), 1u);
  const Vec3 origin = ToFloat(built->RenderToWorld().Inverse().Point(Vec3d(0)));
  const std::optional<LiSample> sample = built->Lights()[0]->Sample_Li(LightContext(origin), {0.5, u});
  if (!sample) throw Error("no light arrives");
  return *sample;
}

/// The irradiance that the light brings to the plane z = 0 at the origin, from the side z < 0.
Color Irradiance(const Built& built) {
  const Vec3 origin = ToFloat(built->RenderToWorld().Inverse().Point(Vec3d(0)));
  constexpr int kSide = 64;
  Color sum;
  for (int i = 0; i < kSide * kSide; ++i) {
    // The part does not follow the grid: some lights draw by all three numbers.
    const LiRandom u{std::fmod(i * 0.6180339887498949, 1), {(i % kSide + 0.5) / kSide, (i / kSide + 0.5) / kSide}};
    const std::optional<LiSample> sample = built->Lights()[0]->Sample_Li(LightContext(origin), u);
    if (sample && sample->wi.z < 0) sum += sample->L * static_cast<float>(-sample->wi.z / sample->pdf);
  }
  return sum / (kSide * kSide);
}

TEST(BuildLights, PointLights) {
  const Built plain = Lit(R"(LightSource "point" "point from" [0 0 -2] "rgb I" [4 8 12] "rgb scale" [1 2 3])", 3);
  ExpectColor(Arriving(plain).L, Color(4, 16, 36) / 4);
  EXPECT_TRUE(Arriving(plain).isDelta);
  // pbrt-v3 adds "from" behind the transform; pbrt-v4 transforms it.
  const std::string moved = R"(AttributeBegin Scale 2 2 2 LightSource "point" "POINT from" [0 0 -1] AttributeEnd)";
  const auto spelled = [&](const char* point) { return std::string(moved).replace(moved.find("POINT"), 5, point); };
  ExpectColor(Arriving(Lit(spelled("point"), 3)).L, Color(1));
  ExpectColor(Arriving(Lit(spelled("point3"), 4)).L, Color(0.25f));
}

TEST(BuildLights, PowerOfAPointLightIsItsFlux) {
  const Built built = Lit(R"(LightSource "point" "point3 from" [0 0 -1] "float power" 100 "float scale" 2)", 4);
  ExpectColor(built->Lights()[0]->Power(), Color(200));
}

TEST(BuildLights, SpectraOfVersion4AreOfLuminanceOne) {
  for (const std::string I :
       {"\"blackbody I\" 3000", "\"spectrum I\" \"stdillum-D50\"", "\"spectrum I\" [400 3 700 9]"}) {
    const Built built = Lit("LightSource \"point\" \"point3 from\" [0 0 -1] \"float scale\" 5 " + I, 4);
    EXPECT_NEAR(Arriving(built).L.Luminance(), 5, 0.25) << I;  // exact but for what the gamut cuts off
  }
  const Built warm = Lit(R"(LightSource "point" "point3 from" [0 0 -1] "blackbody I" 3000)", 4);
  EXPECT_GT(Arriving(warm).L.r, 1.5f * Arriving(warm).L.b);
}

TEST(BuildLights, ColorSpacesOfVersion4) {
  const auto shines = [](const std::string& space, const std::string& rgb) {
    return Arriving(Lit("ColorSpace \"" + space + "\" LightSource \"point\" \"point3 from\" [0 0 -1] \"rgb I\" [" +
                            rgb + "]",
                        4))
        .L;
  };
  ExpectColor(shines("rec2020", "2 2 2"), Color(2), 1e-3);  // both whites are D65
  const Color green = shines("rec2020", "0 1 0");           // greener than any sRGB green
  EXPECT_EQ(green.r, 0);
  EXPECT_GT(green.g, 1);
  EXPECT_EQ(shines("srgb", "0 1 0"), Color(0, 1, 0));
}

TEST(BuildLights, SpotLightsPointTheirWay) {
  const std::string spot = R"(LightSource "spot" "POINT from" [0 0 -2] "POINT to" [0 0 5] "rgb I" [4 4 4]
      "float coneangle" [30] "float conedeltaangle" [10])";
  const auto spelled = [&](std::string point) {
    std::string text = spot;
    for (size_t at; (at = text.find("POINT")) != std::string::npos;) text.replace(at, 5, point);
    return text;
  };
  for (int version : {3, 4}) {
    const Built built = Lit(spelled(version == 3 ? "point" : "point3"), version);
    ExpectColor(Arriving(built).L, Color(1));
    // Half-way through the rim, in cosines: t^4 and t^2 (3 - 2t) at one half.
    const double cosine = (std::cos(Radians(20)) + std::cos(Radians(30))) / 2;
    const double r = 2 * std::sqrt(1 - cosine * cosine) / cosine;
    const Vec3 p = ToFloat(built->RenderToWorld().Inverse().Point({r, 0, 0}));
    const std::optional<LiSample> sample = built->Lights()[0]->Sample_Li(LightContext(p), {});
    ASSERT_TRUE(sample);
    const double distanceSquared = 4 + r * r;
    ExpectColor(sample->L, Color(static_cast<float>(4 / distanceSquared * (version == 3 ? 1. / 16 : 0.5))), 1e-3);
  }
  const Built power = Lit(R"(LightSource "spot" "float power" 30)", 4);
  ExpectColor(power->Lights()[0]->Power(), Color(30), 1e-3);
}

TEST(BuildLights, DistantLightsTravelFromFromToTo) {
  const Built v3 = Lit(R"(LightSource "distant" "point from" [1 0 -1] "point to" [0 0 0] "rgb L" [2 3 4])", 3);
  EXPECT_LT(Distance(Arriving(v3).wi, Normalize(Vec3(1, 0, -1))), 1e-6);
  ExpectColor(Arriving(v3).L, Color(2, 3, 4));
  const Built rotated = Lit("AttributeBegin Rotate 90 0 1 0 LightSource \"distant\" AttributeEnd", 4);
  EXPECT_LT(Distance(Arriving(rotated).wi, Vec3(-1, 0, 0)), 1e-6);
  ExpectColor(Arriving(Lit(R"(LightSource "distant" "float illuminance" 50 "float scale" 2)", 4)).L, Color(100));
}

/// Four pixels: red upper left, green upper right, blue lower left, white lower right.
void WriteFourColors(const std::filesystem::path& path) {
  Image image = Image::Rgb(2, 2);
  image.SetColor(0, 0, Color(1, 0, 0));
  image.SetColor(1, 0, Color(0, 1, 0));
  image.SetColor(0, 1, Color(0, 0, 1));
  image.SetColor(1, 1, Color(1, 1, 1));
  WriteExr(path.string(), image);
}

/// The intensity of the only light, which is at the world's (0, 0, -2), toward the world's `w`.
Color IntensityToward(const Built& built, const Vec3d& w) {
  const Vec3 p = ToFloat(built->RenderToWorld().Inverse().Point(Vec3d(0, 0, -2) + w));
  const std::optional<LiSample> sample = built->Lights()[0]->Sample_Li(LightContext(p), {});
  return sample ? sample->L * static_cast<float>(LengthSquared(w)) : Color();
}

// pbrt's light space is that of its camera: x to the right, y up, z ahead. Version 3 throws the image upside down.
TEST(BuildLights, ProjectionsHaveTheirImageUpright) {
  const TestFolder folder;
  WriteFourColors(folder.Path() / "four.exr");
  const auto lit = [&](const std::string& parameters, int version) {
    return Lit("AttributeBegin Translate 0 0 -2 LightSource \"projection\" " + parameters + " AttributeEnd", version,
               folder.Path());
  };
  const Built v4 = lit(R"("string filename" "four.exr" "float scale" 2)", 4);
  // At 90 degrees the edges of the image are at 45 degrees; outside of the middles of the pixels it is of one colour.
  ExpectColor(IntensityToward(v4, {-0.9, 0.9, 1}), Color(2, 0, 0));
  ExpectColor(IntensityToward(v4, {0.9, 0.9, 1}), Color(0, 2, 0));
  ExpectColor(IntensityToward(v4, {-0.9, -0.9, 1}), Color(0, 0, 2));
  ExpectColor(IntensityToward(v4, {0.9, -0.9, 1}), Color(2, 2, 2));
  ExpectColor(IntensityToward(v4, {1.01, 0, 1}), Color(0));
  const Built v3 = lit(R"("string mapname" "four.exr" "rgb I" [1 2 3] "rgb scale" [2 2 2] "float fov" 90)", 3);
  ExpectColor(IntensityToward(v3, {-0.9, -0.9, 1}), Color(2, 0, 0));
  ExpectColor(IntensityToward(v3, {0.9, -0.9, 1}), Color(0, 4, 0));
  ExpectColor(IntensityToward(v3, {-0.9, 0.9, 1}), Color(0, 0, 6));
  ExpectColor(IntensityToward(v3, {0.9, 0.9, 1}), Color(2, 4, 6));
  // Without an image: a white square, of 45 degrees.
  const Built plain = lit(R"("rgb I" [1 2 3])", 3);
  ExpectColor(IntensityToward(plain, {0.41, -0.41, 1}), Color(1, 2, 3));
  ExpectColor(IntensityToward(plain, {0.42, 0, 1}), Color(0));
  const Built power = lit(R"("string filename" "four.exr" "float power" 50 "float scale" 2)", 4);
  EXPECT_NEAR(power->Lights()[0]->Power().Luminance(), 100, 1e-3);
}

// y is up in both versions; the equal-area image has it in its middle, the latitude-longitude one in its first row.
TEST(BuildLights, GoniometricDiagramsAreUpright) {
  const TestFolder folder;
  Image square = Image::Rgb(16, 16), latLong = Image::Rgb(16, 8);
  for (const int i : {7, 8})
    for (const int j : {7, 8}) square.SetColor(i, j, Color(3, 3, 6));  // up
  square.SetColor(15, 8, Color(9));                                    // +x (half a pixel away)
  square.SetColor(8, 15, Color(12));                                   // +z
  for (int x = 0; x < 16; ++x) latLong.SetColor(x, 0, Color(1, 2, 3));
  for (const int y : {3, 4}) latLong.SetColor(4, y, Color(4, 5, 6)), latLong.SetColor(0, y, Color(7, 8, 9));
  WriteExr((folder.Path() / "square.exr").string(), square);
  WriteExr((folder.Path() / "lat.exr").string(), latLong);
  const auto lit = [&](const std::string& parameters, int version) {
    return Lit("AttributeBegin Translate 0 0 -2 LightSource \"goniometric\" " + parameters + " AttributeEnd", version,
               folder.Path());
  };
  const Built v4 = lit(R"("string filename" "square.exr" "float scale" 2 "rgb I" [1 2 3])", 4);
  ExpectColor(IntensityToward(v4, {0, 1, 0}), Color(8, 16, 24));  // the mean of the colours, 4, times I times scale
  ExpectColor(IntensityToward(v4, {0, -1, 0}), Color(0));
  EXPECT_GT(IntensityToward(v4, {1, 0, 0}).r, 4.f);
  EXPECT_GT(IntensityToward(v4, {0, 0, 1}).r, IntensityToward(v4, {1, 0, 0}).r);
  EXPECT_EQ(IntensityToward(v4, {-1, 0, 0}).r, 0.f);
  EXPECT_EQ(IntensityToward(v4, {0, 0, -1}).r, 0.f);
  const Built v3 = lit(R"("string mapname" "lat.exr" "rgb scale" [2 2 2])", 3);
  ExpectColor(IntensityToward(v3, {0, 1, 0}), Color(2, 4, 6));
  ExpectColor(IntensityToward(v3, {0, -1, 0}), Color(0));
  // Column 4 begins at +z, column 0 at +x; rows 3 and 4 meet at the horizon.
  const double turn = kPiD / 16;
  ExpectColor(IntensityToward(v3, {-std::sin(turn), 0, std::cos(turn)}), Color(8, 10, 12));
  ExpectColor(IntensityToward(v3, {std::cos(turn), 0, std::sin(turn)}), Color(14, 16, 18));
  ExpectColor(IntensityToward(v3, {0, 0, -1}), Color(0));
  const Built plain = lit("\"float power\" 60", 4);
  ExpectColor(plain->Lights()[0]->Power(), Color(60), 1e-3);
  const Built power = lit(R"("string filename" "square.exr" "float power" 60 "float scale" 2)", 4);
  EXPECT_NEAR(power->Lights()[0]->Power().Luminance(), 120, 1e-3);
}

TEST(BuildLights, UniformEnvironments) {
  const Built v3 = Lit(R"(LightSource "infinite" "rgb L" [1 2 3] "rgb scale" [2 2 2])", 3);
  ExpectColor(Irradiance(v3), Color(2, 4, 6) * kPi, 0.01);
  const Built v4 = Lit(R"(LightSource "infinite" "float illuminance" 7)", 4);
  ExpectColor(Irradiance(v4), Color(7), 0.01);
}

TEST(BuildLights, SamplingOfInfiniteLights) {
  for (const std::string sampling : {"uniform", "cosine", "importance", "compensated", "structured", "product"}) {
    const Built built = Lit("LightSource \"infinite\" \"rgb L\" [1 2 3] \"string sampling\" \"" + sampling + "\"", 3);
    ExpectColor(Irradiance(built), Color(1, 2, 3) * kPi, 0.01);
  }
  EXPECT_THROW(Lit(R"(LightSource "infinite" "string sampling" "importanze")", 3), Error);
  // Which density `Sample_Li` has: by the cosine above, by radiance (here even over the sphere) elsewhere.
  const auto pdfStraightUp = [](const std::string& sampling) {
    const Built built = Lit("LightSource \"infinite\" \"string sampling\" \"" + sampling + "\"", 4);
    return built->Lights()[0]->Pdf_Li(LightContext(Vec3(0), Vec3(0, 0, 1), false), Vec3(0, 0, 1), nullptr);
  };
  EXPECT_NEAR(pdfStraightUp("cosine"), 1 / kPiD, 1e-6);
  EXPECT_NEAR(pdfStraightUp("structured"), 1 / (4 * kPiD), 1e-6);
}

// The identity of a render does not hold the sampling then: the light has to be the same, to the bit.
TEST(BuildLights, SamplingIsOfNoAccountWhereNoDirectionIsDrawn) {
  const TestFolder folder;
  Image map = Image::Rgb(8, 4);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 8; ++x) map.SetColor(x, y, Color(static_cast<float>(x * y + 1)));
  WriteExr((folder.Path() / "map.exr").string(), map);
  BuildOptions options;
  options.drawsTowardLights = false;
  for (const std::string kind : {"\"rgb L\" [1 2 3] ", "\"string mapname\" \"map.exr\" "}) {
    const std::string light = "LightSource \"infinite\" " + kind;
    const Built plain = Lit(light, 3, folder.Path(), options);
    for (const std::string sampling : {"cosine", "importance", "irradiance"}) {
      const Built named = Lit(light + "\"string sampling\" \"" + sampling + "\"", 3, folder.Path(), options);
      EXPECT_EQ(named->Lights()[0]->Power(), plain->Lights()[0]->Power());
      for (const double u : {0.1, 0.4, 0.9}) {
        const LeRandom random{u, {u, 1 - u}, {u / 2, u}};
        const auto one = plain->Lights()[0]->Sample_Le(random), other = named->Lights()[0]->Sample_Le(random);
        ASSERT_TRUE(one && other) << light << sampling;
        EXPECT_EQ(other->ray.o, one->ray.o) << light << sampling;
        EXPECT_EQ(other->ray.d, one->ray.d) << light << sampling;
        EXPECT_EQ(other->Le, one->Le) << light << sampling;
        EXPECT_EQ(other->pdfPos, one->pdfPos) << light << sampling;
        EXPECT_EQ(other->pdfDir, one->pdfDir) << light << sampling;
      }
    }
  }
}

TEST(BuildLights, SamplesOfInfiniteLights) {
  EXPECT_EQ(Lit(R"(LightSource "infinite" "integer samples" 16)", 3)->Lights()[0]->SampleCount(), 16);
  EXPECT_EQ(Lit(R"(LightSource "infinite" "integer nsamples" 4)", 3)->Lights()[0]->SampleCount(), 4);
  EXPECT_EQ(Lit(R"(LightSource "infinite")", 4)->Lights()[0]->SampleCount(), 1);
  EXPECT_THROW(Lit(R"(LightSource "infinite" "integer samples" 0)", 3), Error);
  EXPECT_EQ(Lit(R"(LightSource "infinite" "integer samples" 65536)", 3)->Lights()[0]->SampleCount(), 65536);
  EXPECT_THROW(Lit(R"(LightSource "infinite" "integer samples" 65537)", 3), Error);
}

// Of a sky and dimmer ground: one sample of the light leaves all of the ground to the BSDF, sixteen leave a little.
TEST(BuildLights, CompensationGoesByTheSamplesThatAreTaken) {
  const TestFolder folder;
  Image map = Image::Rgb(8, 4);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 8; ++x) map.SetColor(x, y, Color(y < 2 ? 1.f : 0.5f));
  WriteExr((folder.Path() / "map.exr").string(), map);
  const auto pdfDown = [&](const std::string& ofLight, std::optional<int> asked) {
    const std::string light = R"(LightSource "infinite" "string mapname" "map.exr" "string sampling" "compensated" )";
    BuildOptions options;
    options.lightSamples = asked;
    const Built built = Lit(light + ofLight, 3, folder.Path(), options);
    LightContext at(Vec3(0));
    at.bsdfDrawsToo = true;
    return built->Lights()[0]->Pdf_Li(at, Normalize(Vec3(0.5f, 0.2f, -1)), nullptr);
  };
  const std::string sixteen = R"("integer samples" 16)";
  EXPECT_EQ(pdfDown("", {}), 0);
  EXPECT_GT(pdfDown(sixteen, {}), 0);
  EXPECT_EQ(pdfDown("", 16), pdfDown(sixteen, {}));
  EXPECT_EQ(pdfDown(R"("integer samples" 2)", 16), pdfDown(sixteen, {}));
  EXPECT_EQ(pdfDown(sixteen, 1), 0);
}

// The light's samples are so many as its count times the probability that it is picked: the dimmer ground has
// (0.5 - t) / (1 - t) of the sky's density, where t is 2 / (n P + 1) times the mean radiance.
TEST(BuildLights, CompensationGoesByTheChoiceAmongLights) {
  const TestFolder folder;
  Image map = Image::Rgb(8, 16);
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 8; ++x) map.SetColor(x, y, Color(y < 8 ? 1.f : 0.5f));
  WriteExr((folder.Path() / "map.exr").string(), map);
  for (const float intensity : {0.f, 0.2f, 2.f, 8.f}) {
    const std::string lamp = intensity > 0 ? fmt::format(
                                                 "LightSource \"point\" \"rgb I\" [{0} {0} {0}] "
                                                 "\"point from\" [0 0 1.5] ",
                                                 intensity)
                                           : "";
    const Built built = Lit(R"(LightSource "infinite" "string mapname" "map.exr" "string sampling" "compensated"
                               "integer samples" 16 )" +
                                lamp,
                            3, folder.Path());
    LightContext at(built->Extent().center);
    const double picked = built->Picker().ProbabilityFor(at, 0);
    at.bsdfDrawsToo = true;
    const auto pdf = [&](const Vec3& wi) { return built->Lights()[0]->Pdf_Li(at, Normalize(wi), nullptr); };
    const double threshold = 2 / (16 * picked + 1) * 0.75;
    const double ratio = std::max(0.0, 0.5 - threshold) / (1 - threshold);
    EXPECT_NEAR(pdf(Vec3(0.5f, 0.2f, -1)) / pdf(Vec3(0.5f, 0.2f, 1)), ratio, 1e-4) << picked;
    EXPECT_TRUE(intensity == 0 ? picked == 1 : picked < 0.95) << intensity;
  }
}

TEST(BuildLights, EnvironmentMapsOfBothVersions) {
  const TestFolder folder;
  Image latLong = Image::Rgb(32, 16), square = Image::Rgb(16, 16);
  for (Image* image : {&latLong, &square})
    for (int y = 0; y < image->Height(); ++y)
      for (int x = 0; x < image->Width(); ++x)
        for (int c = 0; c < 3; ++c) image->At(x, y, c) = static_cast<float>(c + 1);
  WriteExr((folder.Path() / "lat.exr").string(), latLong);
  WriteExr((folder.Path() / "square.exr").string(), square);
  const Built v3 = Lit(R"(LightSource "infinite" "string mapname" "lat.exr" "rgb scale" [2 2 2])", 3, folder.Path());
  ExpectColor(Irradiance(v3), Color(2, 4, 6) * kPi, 0.01);
  const Built v4 = Lit(R"(LightSource "infinite" "string filename" "square.exr" "float scale" 2)", 4, folder.Path());
  ExpectColor(Irradiance(v4), Color(2, 4, 6) * kPi, 0.01);
  EXPECT_TRUE(v3.warnings.empty() && v4.warnings.empty());
  // pbrt-v4's reckoning of a map's illuminance: half of what it is.
  const Built lit =
      Lit(R"(LightSource "infinite" "string filename" "square.exr" "float illuminance" 10)", 4, folder.Path());
  EXPECT_NEAR(Irradiance(lit).Luminance(), 20, 0.5);

  const auto error = [&](const std::string& text) { return MessageOf([&] { Lit(text, 4, folder.Path()); }); };
  EXPECT_EQ(error(R"(LightSource "infinite" "string filename" "lat.exr")").substr(0, 95),
            "a.pbrt:5:24: error: environment map \"lat.exr\" is of 32 x 16 pixels, expected a square one: pbrt");
  EXPECT_EQ(error(R"(LightSource "infinite" "string filename" "square.exr" "rgb L" [1 1 1])").substr(0, 18),
            "a.pbrt:5:24: error");
}

TEST(BuildLights, EmissionOfAMapIsByImportanceOrUniform) {
  const TestFolder folder;
  Image image = Image::Rgb(16, 8);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 16; ++x) image.SetColor(x, y, Color(x == 3 && y == 5 ? 100 : 1));
  WriteExr((folder.Path() / "sky.exr").string(), image);
  const auto lit = [&](const std::string& more) {
    return Lit("LightSource \"infinite\" \"string mapname\" \"sky.exr\" " + more, 3, folder.Path());
  };
  const Built plain = lit(""), importance = lit(R"("string emission" "importance")");
  const Built uniform = lit(R"("string emission" "uniform")");
  EXPECT_EQ(uniform->Lights()[0]->Power(), plain->Lights()[0]->Power());
  EXPECT_TRUE(uniform.warnings.empty());
  for (const Vec3& d : {Vec3(0, 0, 1), Vec3(0.6f, 0, -0.8f)}) {
    const Ray ray{Vec3(0), d};
    EXPECT_NEAR(uniform->Lights()[0]->Pdf_Le(ray, {}).direction, 1 / (4 * kPiD), 1e-15);
    EXPECT_EQ(importance->Lights()[0]->Pdf_Le(ray, {}).direction, plain->Lights()[0]->Pdf_Le(ray, {}).direction);
    EXPECT_NE(plain->Lights()[0]->Pdf_Le(ray, {}).direction, uniform->Lights()[0]->Pdf_Le(ray, {}).direction);
  }
  for (const std::string map : {"\"string mapname\" \"sky.exr\"", "\"rgb L\" [1 1 1]"}) {
    const std::string message = MessageOf(
        [&] { Lit("LightSource \"infinite\" " + map + " \"string emission\" \"unifrom\"", 3, folder.Path()); });
    EXPECT_EQ(message.substr(0, 9), "a.pbrt:5:") << message;
    EXPECT_NE(message.find("unknown emission \"unifrom\""), std::string::npos) << message;
    EXPECT_NE(message.find("uniform"), std::string::npos) << message;
  }
}

TEST(BuildLights, BadPixelsOfAMapAreMendedWithAWarning) {
  const TestFolder folder;
  Image image = Image::Rgb(8, 4);
  image.At(2, 1, 0) = -1;
  image.At(3, 1, 0) = 2;
  WriteExr((folder.Path() / "bad.exr").string(), image);
  const Built built = Lit(R"(LightSource "infinite" "string mapname" "bad.exr")", 3, folder.Path());
  ASSERT_EQ(built.warnings.size(), 1u);
  EXPECT_EQ(built.warnings[0].substr(0, 21), "a.pbrt:5:24: warning:");
}

TEST(BuildLights, AnInfinitePixelIsAsBrightAsTheBrightestOther) {
  const TestFolder folder;
  Image image = Image::Rgb(16, 8);
  image.SetColor(9, 5, Color(500));
  image.SetColor(3, 2, Color(500));
  WriteExr((folder.Path() / "good.exr").string(), image);
  image.SetColor(3, 2, Color(INFINITY));
  WriteExr((folder.Path() / "overflown.exr").string(), image);
  const auto lit = [&](const std::string& file) {
    return Lit("LightSource \"infinite\" \"string mapname\" \"" + file + "\"", 3, folder.Path());
  };
  const Built good = lit("good.exr"), overflown = lit("overflown.exr");
  EXPECT_EQ(good.warnings.size(), 0u);
  ASSERT_EQ(overflown.warnings.size(), 1u);
  EXPECT_EQ(overflown.warnings[0].substr(0, 21), "a.pbrt:5:24: warning:");
  EXPECT_EQ(overflown->Lights()[0]->Power(), good->Lights()[0]->Power());
}

// The same texture: in pbrt-v3 a hole is where it is 0, in pbrt-v4 a half is there half of the time.
TEST(BuildLights, AlphaOfAnAreaLightIsThatOfTheVersion) {
  const std::string world = R"(Texture "half" "float" "checkerboard" "float uscale" [2] "float vscale" [2]
      "float tex1" [0.5] "float tex2" [0]
      AttributeBegin AreaLightSource "diffuse" "rgb L" [4 4 4] Shape "sphere" "texture alpha" "half" AttributeEnd)";
  for (const int version : {3, 4}) {
    const double whole = 4 * kPiD * 4 * kPiD;
    ExpectColor(Lit(world, version)->Lights()[0]->Power(),
                Color(static_cast<float>(whole * (version == 3 ? 0.5 : 0.25))), 0.01);
  }
}

TEST(BuildLights, AreaLightsGlowOnTheirOutside) {
  const Built v3 =
      Lit(R"(AttributeBegin AreaLightSource "area" "rgb L" [1 2 3] "rgb scale" [2 2 2] "integer nsamples" [4]
      Shape "sphere" "float radius" [0.5] AttributeEnd)",
          3);
  const double flux = kPiD * 4 * kPiD * 0.25;
  ExpectColor(v3->Lights()[0]->Power(), Color(2, 4, 6) * static_cast<float>(flux), 1e-3);
  const auto seen = [](const std::string& rest) {
    const Built built = Lit("AttributeBegin Translate 0 0 -1 AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] " + rest +
                                " Shape \"disk\" AttributeEnd",
                            4);
    const std::optional<SurfaceInteraction> hit = LookAtXY(*built.scene);
    return built->Lights()[static_cast<size_t>(built->AreaLightAt(*hit))]->L(*hit, hit->wo);
  };
  ExpectColor(seen(""), Color(0));  // the disk faces away from the camera
  ExpectColor(seen("\"bool twosided\" true"), Color(1));
  ExpectColor(seen("ReverseOrientation"), Color(1));
}

TEST(BuildLights, PowerOfAnAreaLightIsThatOfEachPrimitive) {
  const auto power = [](const std::string& rest) {
    return Lit("AttributeBegin AreaLightSource \"diffuse\" \"float power\" 60 " + rest + " AttributeEnd", 4)
        ->Lights()[0]
        ->Power();
  };
  ExpectColor(power("Shape \"sphere\" \"float radius\" 0.3"), Color(60), 1e-3);
  ExpectColor(power("\"bool twosided\" true Shape \"disk\""), Color(60), 1e-3);
  // As pbrt-v4 has it: 60 for each of the square's two triangles.
  ExpectColor(power(Square(4)), Color(120), 1e-3);
}

TEST(BuildLights, AreaLightsMayShowAnImage) {
  const TestFolder folder;
  Image image = Image::Rgb(2, 1);
  image.At(1, 0, 1) = 4;
  WriteExr((folder.Path() / "tv.exr").string(), image);
  const Built built = BuildText(
      "LookAt 0 0 -5  0 0 0  0 1 0\nCamera \"perspective\"\nWorldBegin\n" +
          std::string("AreaLightSource \"diffuse\" \"string filename\" \"tv.exr\" \"float scale\" 2\n") + Square(4),
      4, {}, folder.Path());
  const auto seen = [&](double x) {
    const std::optional<SurfaceInteraction> hit = LookAtXY(*built.scene, x);
    return built->Lights()[0]->L(*hit, hit->ng);
  };
  ExpectColor(seen(-0.9), Color(0));
  ExpectColor(seen(0.9), Color(0, 8, 0));
}

TEST(BuildLights, LightsInInstancesWarn) {
  EXPECT_EQ(
      BuildWorld("ObjectBegin \"a\" AreaLightSource \"diffuse\" Shape \"sphere\" ObjectEnd\nObjectInstance \"a\"", 4)
          .warnings.size(),
      1u);
  const Built dark = BuildText("WorldBegin\nShape \"sphere\"", 4);
  EXPECT_EQ(dark.warnings.size(), 1u);
}

TEST(BuildLights, ErrorsHaveAPlace) {
  EXPECT_EQ(WorldError(R"(LightSource "pont")", 4),
            "a.pbrt:5:1: error: unknown light \"pont\", expected one of point, spot, distant, infinite, "
            "projection, goniometric; did you mean \"point\"?");
  EXPECT_EQ(WorldError(R"(LightSource "point" "rgb I" [1 -1 1])", 4),
            "a.pbrt:5:21: error: parameter \"I\" has a negative value, expected 0 or more");
  EXPECT_EQ(WorldError(R"(LightSource "distant" "point3 from" [0 0 1])", 4).substr(0, 17), "a.pbrt:5:1: error");
  EXPECT_EQ(WorldError(R"(LightSource "infinite" "string filename" "no.exr")", 4).substr(0, 18), "a.pbrt:5:24: error");
  EXPECT_EQ(WorldError(R"(LightSource "projection")", 4).substr(0, 17), "a.pbrt:5:1: error");
  EXPECT_EQ(WorldError(R"(LightSource "projection" "float fov" 180)", 3),
            "a.pbrt:5:26: error: field of view of a projection is 180 degrees, expected at least 0.0001 and less than "
            "180");
  EXPECT_EQ(WorldError(R"(AreaLightSource "defuse" Shape "sphere")", 4).substr(0, 17), "a.pbrt:5:1: error");
  EXPECT_EQ(WorldError(R"(LightSource "point" "blackbody I" [3000 4000])", 4).substr(0, 18), "a.pbrt:5:21: error");
}

TEST(BuildLights, BlackbodiesAreWarmerThanNothing) {
  EXPECT_EQ(WorldError(R"(LightSource "point" "blackbody I" [-3 1])", 3),
            "a.pbrt:5:21: error: the temperature of parameter \"I\" is -3, expected more than 0");
  EXPECT_EQ(WorldError(R"(LightSource "point" "blackbody I" [3000 -1])", 3),
            "a.pbrt:5:21: error: the scale of parameter \"I\" is -1, expected 0 or more");
  EXPECT_EQ(WorldError(R"(LightSource "point" "blackbody I" 0)", 4),
            "a.pbrt:5:21: error: the temperature of parameter \"I\" is 0, expected more than 0");
}

}  // namespace
}  // namespace dapple
