// Film, filter, sampler and integrator of both versions, as render settings.
#include "tests/io/build_test_support.h"

namespace dapple {
namespace {

RenderSettings SettingsOf(const std::string& options, int version, const BuildOptions& overrides = {}) {
  const Built built =
      BuildText(options + "\nWorldBegin\nLightSource \"point\" Shape \"sphere\"\n" + (version == 3 ? "WorldEnd" : ""),
                version, overrides);
  for (const std::string& line : built.warnings) ADD_FAILURE() << line;
  return built->Settings();
}

std::vector<std::string> WarningsOf(const std::string& options, int version) {
  return BuildText(
             options + "\nWorldBegin\nLightSource \"point\" Shape \"sphere\"\n" + (version == 3 ? "WorldEnd" : ""),
             version)
      .warnings;
}

std::string ErrorOf(const std::string& options, int version) {
  return MessageOf([&] { SettingsOf(options, version); });
}

TEST(BuildFilm, DefaultsWhereTheFileSaysNothing) {
  for (int version : {3, 4}) {
    const RenderSettings settings = SettingsOf("", version);
    EXPECT_EQ(settings.resolution, Vec2i(1280, 720));
    EXPECT_EQ(settings.crop, (PixelBounds{{0, 0}, {1280, 720}}));
    EXPECT_EQ(settings.exposure, 1);
    EXPECT_EQ(settings.filter, version == 3 ? Filter::Box() : Filter::GaussianSigma());
    EXPECT_TRUE(settings.integrator.empty());
    EXPECT_FALSE(settings.samplesPerPixel || settings.maxDepth || settings.iterations || settings.seed);
  }
}

TEST(BuildFilm, SizeNameAndScale) {
  const RenderSettings v3 = SettingsOf(
      R"(Film "image" "integer xresolution" [30] "integer yresolution" [20] "string filename" "x.exr" "float scale" [2])",
      3);
  EXPECT_EQ(v3.resolution, Vec2i(30, 20));
  EXPECT_EQ(v3.outputFile, "x.exr");
  EXPECT_EQ(v3.exposure, 2);
  const RenderSettings v4 = SettingsOf(R"(Film "rgb" "float iso" 400
      Camera "perspective" "float shutteropen" 0.5 "float shutterclose" 0.75)",
                                       4);
  EXPECT_FLOAT_EQ(v4.exposure, 1);  // a quarter of the time, four times the speed
}

TEST(BuildFilm, CropWindowsAreSharesOfTheImageRoundedUp) {
  const std::string film = R"(Film "rgb" "integer xresolution" 100 "integer yresolution" 50 )";
  EXPECT_EQ(SettingsOf(film + R"("float cropwindow" [0.251 0.5 0 0.1])", 4).crop, (PixelBounds{{26, 0}, {50, 5}}));
  EXPECT_EQ(SettingsOf(film + R"("integer pixelbounds" [10 20 30 40])", 4).crop, (PixelBounds{{10, 30}, {20, 40}}));
  for (int i = 0; i < 100; ++i) {
    const std::string bounds = std::to_string(i) + " " + std::to_string(i + 1);
    EXPECT_EQ(SettingsOf(film + "\"integer pixelbounds\" [" + bounds + " 0 1]", 4).crop,
              (PixelBounds{{i, 0}, {i + 1, 1}}));
    const std::string shares = std::to_string(i / 100.) + " " + std::to_string((i + 1) / 100.);
    EXPECT_EQ(SettingsOf(film + "\"float cropwindow\" [" + shares + " 0 1]", 4).crop,
              (PixelBounds{{i, 0}, {i + 1, 50}}));
  }
  BuildOptions half;
  half.cropWindow = {0, 0.5, 0.5, 1};
  EXPECT_EQ(SettingsOf(film + R"("float cropwindow" [0.25 0.5 0 0.1])", 4, half).crop,
            (PixelBounds{{0, 25}, {50, 50}}));
  // Another resolution keeps the part of the picture.
  BuildOptions small;
  small.resolution = Vec2i(50, 25);
  const RenderSettings settings = SettingsOf(film + R"("integer pixelbounds" [10 20 30 40])", 4, small);
  EXPECT_EQ(settings.resolution, Vec2i(50, 25));
  EXPECT_EQ(settings.crop, (PixelBounds{{5, 15}, {10, 20}}));
}

TEST(BuildFilm, FiltersOfBothVersions) {
  EXPECT_EQ(SettingsOf(R"(PixelFilter "gaussian")", 3).filter, Filter::Gaussian(Vec2d(2), 2));
  EXPECT_EQ(SettingsOf(R"(PixelFilter "gaussian" "float sigma" 0.7)", 4).filter,
            Filter::GaussianSigma(Vec2d(1.5), 0.7));
  EXPECT_EQ(SettingsOf(R"(PixelFilter "box" "float xwidth" [1] "float ywidth" [0.75])", 3).filter,
            Filter::Box({1, 0.75}));
  EXPECT_EQ(SettingsOf(R"(PixelFilter "box" "float xradius" 1)", 4).filter, Filter::Box({1, 0.5}));
  for (int version : {3, 4}) {
    EXPECT_EQ(SettingsOf(R"(PixelFilter "mitchell")", version).filter, Filter::Mitchell());
    EXPECT_EQ(SettingsOf(R"(PixelFilter "sinc")", version).filter, Filter::Sinc());
    EXPECT_EQ(SettingsOf(R"(PixelFilter "triangle")", version).filter, Filter::Triangle());
  }
}

TEST(BuildFilm, SamplersCountSamples) {
  EXPECT_EQ(SettingsOf(R"(Sampler "halton")", 3).samplesPerPixel, 16);
  EXPECT_EQ(SettingsOf(R"(Sampler "zsobol" "integer pixelsamples" 5 "integer seed" 3)", 4).samplesPerPixel, 5);
  EXPECT_EQ(SettingsOf(R"(Sampler "zsobol" "integer seed" 3)", 4).seed, 3);
  EXPECT_EQ(SettingsOf(R"(Sampler "stratified" "integer xsamples" 3 "integer ysamples" 2 "bool jitter" true)", 4)
                .samplesPerPixel,
            6);
}

TEST(BuildFilm, IntegratorsKeepTheirNameAndNumbers) {
  const RenderSettings path = SettingsOf(R"(Integrator "volpath")", 4);
  EXPECT_EQ(path.integrator, "path");
  EXPECT_EQ(path.maxDepth, 5);
  EXPECT_EQ(SettingsOf(R"(Integrator "mlt" "integer chains" 7)", 3).integrator, "mlt");
  const RenderSettings v3 = SettingsOf(R"(Integrator "sppm" "integer numiterations" [12]
      "integer photonsperiteration" [5000] "float radius" [0.25] "integer maxdepth" [9])",
                                       3);
  EXPECT_EQ(v3.integrator, "sppm");
  EXPECT_EQ(v3.iterations, 12);
  EXPECT_EQ(v3.photonsPerIteration, 5000);
  EXPECT_EQ(v3.radius, 0.25);
  EXPECT_EQ(v3.maxDepth, 9);
  EXPECT_EQ(SettingsOf(R"(Integrator "path" "integer maxdepth" 1024)", 4).maxDepth, 1024);
  EXPECT_EQ(SettingsOf(R"(Integrator "sppm")", 3).iterations, 64);
  EXPECT_FALSE(SettingsOf(R"(Integrator "sppm")", 3).radius);
  // In pbrt-v4 the sampler says how many.
  EXPECT_EQ(SettingsOf("Sampler \"zsobol\" \"integer pixelsamples\" 8\nIntegrator \"sppm\"", 4).iterations, 8);
}

TEST(BuildFilm, IntegratorsHaveTheirPlace) {
  const RenderSettings settings = SettingsOf("Film \"rgb\"\n Integrator \"bdpt\"", 4);
  EXPECT_EQ(settings.integratorLocation.line, 2);
  EXPECT_EQ(settings.integratorLocation.column, 2);
  EXPECT_FALSE(SettingsOf("", 4).integratorLocation.file);
}

TEST(BuildFilm, OptionsSetTheSeedAndMisspelledOnesWarn) {
  EXPECT_EQ(SettingsOf("Option \"integer seed\" 7 Option \"bool disablewavelengthjitter\" true", 4).seed, 7);
  EXPECT_EQ(WarningsOf("Option \"integer sed\" 7", 4),
            (std::vector<std::string>{"a.pbrt:1:8: warning: unknown parameter \"sed\"; did you mean \"seed\"?"}));
  EXPECT_EQ(
      WarningsOf("Option \"bool disablepixeljitter\" true", 4),
      (std::vector<std::string>{"a.pbrt:1:8: warning: parameter \"disablepixeljitter\" is not supported and ignored"}));
}

TEST(BuildFilm, WarnsOfWhatItLacks) {
  EXPECT_EQ(WarningsOf(R"(Sampler "zsobl" "integer pixelsamples" 3)", 4),
            (std::vector<std::string>{"a.pbrt:1:1: warning: unknown sampler \"zsobl\"; did you mean \"zsobol\"?"}));
  EXPECT_EQ(WarningsOf(R"(Film "spectral")", 4),
            (std::vector<std::string>{"a.pbrt:1:1: warning: film \"spectral\" is not supported; \"rgb\" is used"}));
  EXPECT_EQ(WarningsOf(R"(Film "image" "float maxsampleluminance" [4])", 3),
            (std::vector<std::string>{
                "a.pbrt:1:14: warning: parameter \"maxsampleluminance\" is not supported and ignored"}));
  EXPECT_EQ(WarningsOf(R"(Film "rgb" "string sensor" "canon_eos_1d")", 4).size(), 1u);
  EXPECT_EQ(WarningsOf(R"(Film "rgb" "integer xresolutoin" 4)", 4),
            (std::vector<std::string>{
                "a.pbrt:1:12: warning: unknown parameter \"xresolutoin\"; did you mean \"xresolution\"?"}));
}

TEST(BuildFilm, ErrorsHaveAPlace) {
  EXPECT_EQ(ErrorOf(R"(Film "rgb" "integer xresolution" 0)", 4),
            "a.pbrt:1:12: error: parameter \"xresolution\" is 0, expected at least 1");
  EXPECT_EQ(ErrorOf(R"(Film "rgbb")", 4),
            "a.pbrt:1:1: error: unknown film \"rgbb\", expected one of image, rgb, gbuffer, spectral; did you mean "
            "\"rgb\"?");
  EXPECT_EQ(ErrorOf(R"(Film "rgb" "float cropwindow" [0.5 0.5 0 1])", 4).substr(0, 18), "a.pbrt:1:12: error");
  EXPECT_EQ(ErrorOf(R"(Film "rgb" "float cropwindow" [0.5 0.5])", 4).substr(0, 18), "a.pbrt:1:12: error");
  EXPECT_EQ(ErrorOf(R"(PixelFilter "bocks")", 4).substr(0, 17), "a.pbrt:1:1: error");
  EXPECT_EQ(ErrorOf(R"(PixelFilter "box" "float xradius" -1)", 4).substr(0, 17), "a.pbrt:1:1: error");
  EXPECT_EQ(ErrorOf(R"(Integrator "sppm" "float radius" 0)", 4).substr(0, 18), "a.pbrt:1:19: error");
  EXPECT_EQ(ErrorOf(R"(Sampler "zsobol" "integer pixelsamples" 0)", 4).substr(0, 18), "a.pbrt:1:18: error");
  EXPECT_EQ(ErrorOf(R"(Film "rgb" "float iso" -100)", 4),
            "a.pbrt:1:12: error: parameter \"iso\" is -100, expected more than 0");
  EXPECT_EQ(ErrorOf(R"(Film "image" "float scale" 0)", 3).substr(0, 18), "a.pbrt:1:14: error");
  EXPECT_EQ(ErrorOf(R"(Sampler "stratified" "integer xsamples" 65536 "integer ysamples" 65536)", 4),
            "a.pbrt:1:22: error: \"xsamples\" times \"ysamples\" is 4294967296, expected at most 2147483647");
}

TEST(BuildFilm, IntegratorsWithPhotonsHaveTheirNumbers) {
  const std::string numbers = R"( "integer photonsperiteration" [5000] "float radius" [0.25])";
  for (const std::string name : {"hybrid", "photon_mapping"}) {
    const RenderSettings settings = SettingsOf("Integrator \"" + name + "\"" + numbers, 4);
    EXPECT_EQ(settings.photonsPerIteration, 5000) << name;
    EXPECT_EQ(settings.radius, 0.25) << name;
    EXPECT_FALSE(settings.iterations) << name;
  }
  EXPECT_EQ(SettingsOf("Integrator \"light_tracing\"" + numbers, 4).photonsPerIteration, 5000);
  EXPECT_FALSE(SettingsOf("Integrator \"path\"" + numbers, 4).photonsPerIteration);
}

}  // namespace
}  // namespace dapple
