// Scenes whose radiance is known in closed form, for every integrator that can see them.
//
// A statistical check compares the mean of the picture with the exact value by its standard error over independent
// groups of passes (16 groups; |t| < 5 rejects a right renderer less than once in 5,000 runs, and seeds are fixed).
#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/grouped_render.h"
#include "tests/support/scene_from_text.h"

namespace dapple {
namespace {

using namespace testing_support;

/// The mean of all pixels and channels, and its standard error over the groups.
struct Estimate {
  double mean = 0, error = 0;
};

Estimate MeanRadiance(const std::string& text, const std::string& integrator, int passes,
                      const IntegratorOptions& options = {}, int pbrtVersion = 3) {
  const auto scene = SceneFromText(text, pbrtVersion);
  constexpr int kGroups = 16;
  const GroupedImages images = RenderGroups(*scene, integrator, options, passes, kGroups);
  std::vector<double> means;
  for (const Image& image : images.groups) {
    double sum = 0;
    for (int y = 0; y < image.Height(); ++y)
      for (int x = 0; x < image.Width(); ++x) sum += image.ColorAt(x, y).Average();
    means.push_back(sum / (image.Width() * image.Height()));
  }
  Estimate estimate;
  for (double mean : means) estimate.mean += mean / kGroups;
  for (double mean : means) estimate.error += (mean - estimate.mean) * (mean - estimate.mean) / (kGroups - 1) / kGroups;
  estimate.error = std::sqrt(estimate.error);
  return estimate;
}

void ExpectRadiance(const Estimate& estimate, double exact, double bias = 0) {
  EXPECT_NEAR(estimate.mean, exact, 5 * estimate.error + (bias + 2e-6) * exact) << "standard error " << estimate.error;
  EXPECT_LT(estimate.error, 0.01 * exact) << "too noisy to say anything";
}

std::string Header(const std::string& lookAt, double fov) {
  return fmt::format(
      "LookAt {} Camera \"perspective\" \"float fov\" [{}] "
      "Film \"image\" \"integer xresolution\" [16] \"integer yresolution\" [16] WorldBegin ",
      lookAt, fov);
}

// A closed diffuse sphere that glows inside: every bounce sends back the share rho of what arrives everywhere, so the
// radiance is Le / (1 - rho), the same at each point and in each direction.
std::string IntegratingSphere(double rho) {
  return Header("0 0 0.2  0.3 0.4 -1  0 1 0", 40) +
         fmt::format(
             "ReverseOrientation Material \"matte\" \"rgb Kd\" [{0} {0} {0}] "
             "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] Shape \"sphere\" \"float radius\" [1] WorldEnd",
             rho);
}

TEST(IntegratingSphere, Path) { ExpectRadiance(MeanRadiance(IntegratingSphere(0.5), "path", 128), 2); }
TEST(IntegratingSphere, LightTracing) {
  IntegratorOptions options;
  options.photonsPerPass = 2000;
  ExpectRadiance(MeanRadiance(IntegratingSphere(0.5), "light_tracing", 128, options), 2);
}
TEST(IntegratingSphere, Photons) {
  IntegratorOptions options;
  options.photonsPerPass = 4000;
  options.radius = 0.05;
  // On a curved surface a disk of radius r holds 1 + O(r^2) of its flat area.
  for (const char* integrator : {"photon_mapping", "sppm", "hybrid"})
    ExpectRadiance(MeanRadiance(IntegratingSphere(0.5), integrator, 128, options), 2, 0.05 * 0.05);
}

// A picture of all directions goes on beyond its borders: light that lands near one of them lands near another too. In
// so small a picture a third of all pixels lie there.
TEST(IntegratingSphere, LightTracingToTheBordersOfAPictureOfAllDirections) {
  IntegratorOptions options;
  options.photonsPerPass = 2000;
  for (const char* mapping : {"equirectangular", "equalarea"}) {
    const int height = mapping == std::string("equalarea") ? 12 : 6;
    const std::string text = fmt::format(
        "LookAt 0 0 0.2  0.3 0.4 -1  0 1 0 Camera \"spherical\" \"string mapping\" \"{}\" "
        "Film \"rgb\" \"integer xresolution\" 12 \"integer yresolution\" {} "
        "PixelFilter \"gaussian\" \"float xradius\" 1.5 \"float yradius\" 1.5 WorldBegin ReverseOrientation "
        "Material \"diffuse\" \"rgb reflectance\" [.5 .5 .5] AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] "
        "Shape \"sphere\" \"float radius\" 1",
        mapping, height);
    ExpectRadiance(MeanRadiance(text, "light_tracing", 128, options, 4), 2);
  }
}

// A lamp behind the camera, seen in a pane of glass before the dark: four per cent of its radiance (index 1.5, head
// on), which each camera path brings back, for it follows what is reflected and what passes.
TEST(PaneOfGlass, ReflectsTheSameInEachSample) {
  const std::string text =
      Header("0 0 0  0 0 1  0 1 0", 1) +
      "AttributeBegin Material \"matte\" \"rgb Kd\" [0 0 0] Translate 0 0 -1 "
      "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] Shape \"disk\" \"float radius\" [1] AttributeEnd "
      "Material \"glass\" Translate 0 0 1 Shape \"disk\" \"float radius\" [1] WorldEnd";
  for (const char* integrator : {"photon_mapping", "sppm", "hybrid"}) {
    const Estimate estimate = MeanRadiance(text, integrator, 32);
    EXPECT_NEAR(estimate.mean, 0.04, 1e-6) << integrator;
    EXPECT_LT(estimate.error, 1e-7) << integrator;
  }
}

// N panes one behind the other, head on, with all that goes to and fro between their 2 N surfaces of reflectance R:
// they transmit (1 - R) / (1 + (2 N - 1) R) (Stokes 1862). Ways of less than a hundredth are left to chance, so there
// is noise.
TEST(PaneOfGlass, StacksTransmitWhatAllTheirReflectionsLeave) {
  for (const int panes : {1, 2, 4}) {
    std::string text = Header("0 0 0  0 0 1  0 1 0", 1) +
                       "AttributeBegin Material \"matte\" \"rgb Kd\" [0 0 0] Translate 0 0 20 ReverseOrientation "
                       "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] Shape \"disk\" \"float radius\" [2] AttributeEnd "
                       "Material \"glass\" Translate 0 0 1 ";
    for (int i = 0; i < panes; ++i)
      text +=
          "AttributeBegin ReverseOrientation Shape \"disk\" \"float radius\" [2] AttributeEnd "
          "Translate 0 0 0.5 Shape \"disk\" \"float radius\" [2] Translate 0 0 0.5 ";
    const double R = 0.04, exact = (1 - R) / (1 + (2 * panes - 1) * R);
    for (const char* integrator : {"path", "photon_mapping", "sppm", "hybrid"})
      ExpectRadiance(MeanRadiance(text + "WorldEnd", integrator, 64), exact);
  }
}

TEST(GlowingRoom, CornersAreAsBrightAsWalls) {
  // As in the sphere, but seen is a corner, of which most lies within the gather radius of some edge.
  const std::string text = Header("0 0 0  1 1 1  0 0 1", 40) +
                           "Material \"matte\" \"rgb Kd\" [.5 .5 .5] "
                           "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] \"bool twosided\" [\"true\"] "
                           "Shape \"trianglemesh\" \"integer indices\" [0 2 1 0 3 2  4 5 6 4 6 7  0 1 5 0 5 4  "
                           "1 6 2 1 5 6  2 3 7 2 7 6  3 0 4 3 4 7] \"point P\" [-1 -1 -1 1 -1 -1 1 1 -1 -1 1 -1 "
                           "-1 -1 1 1 -1 1 1 1 1 -1 1 1] WorldEnd";
  IntegratorOptions options;
  options.photonsPerPass = 4000;
  options.radius = 0.5;
  for (const char* integrator : {"photon_mapping", "sppm", "hybrid"})
    ExpectRadiance(MeanRadiance(text, integrator, 64, options), 2, 0.001);
}

TEST(IntegratingSphere, DepthCutsTheSeriesForAllAlike) {
  IntegratorOptions options;
  options.photonsPerPass = 4000;
  options.radius = 0.05;
  options.maxDepth = 2;
  const double exact = 1 + 0.5 + 0.25;
  for (const char* integrator : {"path", "light_tracing", "photon_mapping", "sppm", "hybrid"})
    ExpectRadiance(MeanRadiance(IntegratingSphere(0.5), integrator, 128, options), exact, 0.05 * 0.05);
}

// Lossless things under a sky of radiance one are invisible: they send on all that arrives.
std::string UnderWhiteSky(const std::string& material) {
  return Header("0 0 4  0 0 0  0 1 0", 20) + "LightSource \"infinite\" \"rgb L\" [1 1 1] " + material +
         " Shape \"sphere\" \"float radius\" [1] WorldEnd";
}

TEST(WhiteFurnace, DiffuseSphereIsInvisible) {
  const std::string scene = UnderWhiteSky("Material \"matte\" \"rgb Kd\" [1 1 1]");
  IntegratorOptions options;
  options.photonsPerPass = 4000;
  for (const char* integrator : {"path", "light_tracing", "photon_mapping", "sppm", "hybrid"})
    ExpectRadiance(MeanRadiance(scene, integrator, 64, options), 1);
}

TEST(WhiteFurnace, GlassAndMirrorAreInvisible) {
  for (const char* material : {"Material \"glass\" \"rgb Kr\" [1 1 1] \"rgb Kt\" [1 1 1] \"float eta\" [1.5]",
                               "Material \"mirror\" \"rgb Kr\" [1 1 1]"})
    for (const char* integrator : {"path", "photon_mapping", "sppm", "hybrid"}) {
      IntegratorOptions options;
      options.maxDepth = 1000;
      const Estimate estimate = MeanRadiance(UnderWhiteSky(material), integrator, 32, options);
      ExpectRadiance(estimate, 1);
    }
}

// A point light of intensity I at height h over a diffuse plane: at distance d from its foot, L = rho / pi I cos / r^2.
TEST(PointLight, FallsWithSquaredDistanceAndCosine) {
  for (double d : {0.0, 1.0, 2.5}) {
    const std::string scene =
        Header(fmt::format("{0} 0 20  {0} 0 0  0 1 0", d), 0.02) +
        "LightSource \"point\" \"rgb I\" [3 3 3] \"point from\" [0 0 2] "
        "Material \"matte\" \"rgb Kd\" [.5 .5 .5] Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] "
        "\"point P\" [-5 -5 0 5 -5 0 5 5 0 -5 5 0] WorldEnd";
    const double r2 = d * d + 4, exact = 0.5 / kPiD * 3 * (2 / std::sqrt(r2)) / r2;
    for (const char* integrator : {"path", "photon_mapping", "sppm", "hybrid"})
      ExpectRadiance(MeanRadiance(scene, integrator, 32), exact, 1e-4);
  }
}

// A sphere light of radius R at distance D straight above: the plane receives pi L (R / D)^2.
TEST(SphereLight, IrradianceStraightBelow) {
  const std::string scene =
      Header("0 0 -1  0 0 1  0 1 0", 0.5) +
      "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [2 2 2] Material \"matte\" \"rgb Kd\" [0 0 0] "
      "Translate 0 0 3 Shape \"sphere\" \"float radius\" [1] AttributeEnd "
      "Material \"translucent\" \"rgb Kd\" [1 1 1] \"rgb Ks\" [0 0 0] \"rgb reflect\" [0 0 0] \"rgb transmit\" [.5 .5 "
      ".5] "
      "Shape \"disk\" \"float radius\" [8] WorldEnd";
  const double exact = 0.5 * 2 / 9.0;
  IntegratorOptions options;
  options.photonsPerPass = 2000;
  for (const char* integrator : {"path", "photon_mapping", "sppm", "hybrid"})
    ExpectRadiance(MeanRadiance(scene, integrator, 64, options), exact, 1e-4);
}

// Whichever way direct light is found, and with however many samples: the light of a wide sphere light and of a dim sky
// on the plane below, pi (0.8 (1/2)^2 + 0.1 (3/4)) / pi of it sent back by an albedo of one half.
TEST(DirectLight, TechniquesAndSampleCountsAgree) {
  const std::string scene = Header("0 0 0.5  0 0.001 0  0 1 0", 1) +
                            "LightSource \"infinite\" \"rgb L\" [.1 .1 .1] \"integer samples\" 3 AttributeBegin "
                            "AreaLightSource \"diffuse\" \"rgb L\" [.8 .8 .8] Material \"matte\" \"rgb Kd\" [0 0 0] "
                            "Translate 0 0 2 Shape \"sphere\" \"float radius\" [1] AttributeEnd "
                            "Material \"matte\" \"rgb Kd\" [.5 .5 .5] Shape \"disk\" \"float radius\" [50] WorldEnd";
  const double exact = 0.5 * (0.8 * 0.25 + 0.1 * 0.75);
  for (const DirectTechnique technique : {DirectTechnique::Mis, DirectTechnique::Light, DirectTechnique::Bsdf})
    for (const std::optional<int> lightSamples : {std::optional<int>(), std::optional(1), std::optional(5)}) {
      IntegratorOptions options;
      options.direct = {technique, lightSamples};
      options.photonsPerPass = 100;
      ExpectRadiance(MeanRadiance(scene, "path", 64, options), exact, 1e-4);
      // The same functions serve both algorithms: one case is enough.
      if (technique == DirectTechnique::Light && lightSamples == 5)
        ExpectRadiance(MeanRadiance(scene, "sppm", 32, options), exact, 1e-4);
    }
}

// A sphere that shines to its outside only is dark inside, though all of its points are next to shining ones.
TEST(SphereLight, IsDarkInside) {
  const std::string scene =
      Header("100 0 0  101 .3 .2  0 1 0", 60) +
      "Translate 100 0 0 Material \"matte\" \"rgb Kd\" [.8 .8 .8] "
      "AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] Shape \"sphere\" \"float radius\" [3] WorldEnd";
  for (const char* integrator : {"path", "light_tracing", "photon_mapping", "sppm", "hybrid"})
    EXPECT_EQ(MeanRadiance(scene, integrator, 32).mean, 0) << integrator;
}

// Light through a pane of glass at right angles: a diffuse floor far below a distant light sees what the pane lets
// pass, 2 F / (1 + F) less, with F = ((n - 1) / (n + 1))^2; photons and light tracing only (no path finds a distant
// light).
TEST(Glass, PaneAtRightAnglesTransmitsByFresnel) {
  const std::string scene =
      Header("0.5 0 0.5  0 0 0  0 0 1", 40) +
      "LightSource \"distant\" \"rgb L\" [2 2 2] \"point from\" [0 0 1] \"point to\" [0 0 0] "
      "AttributeBegin Material \"glass\" \"rgb Kr\" [1 1 1] \"rgb Kt\" [1 1 1] \"float eta\" [1.5] "
      "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point P\" [-1 -1 2 1 -1 2 1 1 2 -1 1 2] "
      "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point P\" [-1 -1 1 -1 1 1 1 1 1 1 -1 1] AttributeEnd "
      "Material \"matte\" \"rgb Kd\" [.5 .5 .5] Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] "
      "\"point P\" [-1 -1 0 1 -1 0 1 1 0 -1 1 0] WorldEnd";
  // The first bounce on the floor alone: depth 3 leaves out light that returns from the pane.
  IntegratorOptions options;
  options.maxDepth = 3;
  options.photonsPerPass = 5000;
  options.radius = 0.1;
  const double F = 0.04, exact = 0.5 / kPiD * 2 * (1 - F) * (1 - F);
  for (const char* integrator : {"light_tracing", "photon_mapping", "sppm", "hybrid"})
    ExpectRadiance(MeanRadiance(scene, integrator, 32, options), exact, 1e-3);
}

}  // namespace
}  // namespace dapple
