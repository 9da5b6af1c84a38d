// What a scene lacks costs nothing: what `--stats` counts of whole renders.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "src/image/image_io.h"
#include "tests/app/program.h"

namespace dapple {
namespace {

constexpr const char* kHead =
    "LookAt 0 -4 1  0 0 0  0 0 1 Camera \"perspective\" \"float fov\" [40] "
    "Film \"image\" \"integer xresolution\" [8] \"integer yresolution\" [8] WorldBegin ";
constexpr const char* kFloor =
    "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point P\" [-2 -2 -1  2 -2 -1  2 2 -1  -2 2 -1] ";
constexpr const char* kBall = "Shape \"sphere\" \"float radius\" [0.5] ";
constexpr const char* kPoint = "LightSource \"point\" \"point from\" [0 -1 3] ";
const std::string kMatte = "Material \"matte\" ", kMirror = "Material \"mirror\" ";

class Skip : public ProgramTest {
 protected:
  /// The counters of a render of this world with one pass.
  nlohmann::json Stats(const std::string& world, const std::string& options = "") const {
    Write("scene.pbrt", kHead + world + "WorldEnd");
    const ProgramResult result = Run("scene.pbrt --passes 1 --quiet -o a.exr --stats stats.json " + options);
    EXPECT_EQ(result.exitCode, 0) << result.err;
    return result.exitCode == 0 ? nlohmann::json::parse(Read("stats.json")) : nlohmann::json();
  }
  /// A map of 8 x 4 pixels.
  void WriteMap(const std::string& name, float value) const {
    Image map = Image::Rgb(8, 4);
    for (float& v : map.Values()) v = value;
    WriteExr(Path(name), map);
  }
};

/// Nothing of photons; `learned` tables are of something else.
void ExpectNoPhotons(const nlohmann::json& stats, int learned = 0) {
  EXPECT_EQ(stats["rays"]["photon"], 0);
  EXPECT_EQ(stats["photons"]["emitted"], 0);
  EXPECT_EQ(stats["photons"]["inPilots"], 0);
  EXPECT_EQ(stats["photonMaps"]["built"], 0);
  EXPECT_EQ(stats["photonMaps"]["bytes"], 0);
  EXPECT_EQ(stats["tables"]["learned"], learned);
}

TEST_F(Skip, ADiffuseSceneTracesNoPhotonInAuto) {
  const std::string world = kPoint + kMatte + kFloor + kBall;
  const nlohmann::json stats = Stats(world, "--integrator auto");
  EXPECT_EQ(stats["integrator"], "path");
  // How many camera paths each part of the picture gets is learned.
  ExpectNoPhotons(stats, 1);
  EXPECT_GT(stats["rays"]["camera"], 0);
  EXPECT_GT(stats["rays"]["shadow"], 0);
  // Photons where they are asked for.
  const nlohmann::json photons = Stats(world, "--integrator sppm --photons 1000");
  EXPECT_EQ(photons["photons"]["emitted"], 1000);
  EXPECT_GT(photons["photons"]["inPilots"], 0);
  EXPECT_GT(photons["rays"]["photon"], 0);
  EXPECT_EQ(photons["photonMaps"]["built"], 1);
  EXPECT_GT(photons["photonMaps"]["bytes"], photons["photons"]["stored"]);
}

TEST_F(Skip, NoPhotonIsTracedWhereNoneCouldBeGathered) {
  const std::string mirrors = kPoint + kMirror + kFloor + kBall, dark = kMatte + kFloor + kBall;
  for (const std::string integrator : {"photon_mapping", "sppm", "hybrid"}) {
    const std::string option = "--integrator " + integrator;
    ExpectNoPhotons(Stats(mirrors, option));
    ExpectNoPhotons(Stats("Material \"glass\" " + mirrors, option));
    ExpectNoPhotons(Stats("LightSource \"point\" \"rgb I\" [0 0 0] " + dark, option));
    ExpectNoPhotons(Stats(kPoint + dark, option + " --max-depth 1"));
    // One surface that catches light is enough.
    EXPECT_GE(Stats(kPoint + kMirror + kBall + kMatte + kFloor, option + " --photons 1000")["photonMaps"]["built"], 1);
  }
}

TEST_F(Skip, NoCausticMapIsBuiltWhereNothingMakesCaustics) {
  const std::string option = "--integrator photon_mapping --photons 1000", floor = kMatte + kFloor;
  const nlohmann::json diffuse = Stats(kPoint + floor + kBall, option);
  const nlohmann::json caustic = Stats(kPoint + kMirror + kBall + floor, option);
  EXPECT_EQ(diffuse["photonMaps"]["built"], 1);
  EXPECT_EQ(caustic["photonMaps"]["built"], 2);
  // What each pilot learned: the guide of emission, radii of all photons, where final gathers look, and radii of
  // caustics.
  EXPECT_EQ(diffuse["tables"]["learned"], 3);
  EXPECT_EQ(caustic["tables"]["learned"], 4);
}

TEST_F(Skip, ASceneWithoutAnEnvironmentBuildsNoTableOfOne) {
  WriteMap("sky.exr", 1);
  const nlohmann::json none = Stats(kPoint + kMatte + kFloor, "--integrator path");
  for (const char* kind : {"environment", "lights", "choice", "learned", "bytes"}) EXPECT_EQ(none["tables"][kind], 0);
  EXPECT_EQ(none["textures"]["opened"], 0);
  // The same radiance from everywhere needs no table over directions, but the disks that it is emitted from.
  const nlohmann::json even = Stats("LightSource \"infinite\" " + kMatte + kFloor);
  const nlohmann::json map = Stats("LightSource \"infinite\" \"string mapname\" \"sky.exr\" " + kMatte + kFloor);
  // Of a map its own, and that of irradiance, which is Dapple's choice where nobody names another.
  EXPECT_EQ(map["tables"]["environment"], even["tables"]["environment"].get<int>() + 2);
  const nlohmann::json named = Stats(
      "LightSource \"infinite\" \"string mapname\" \"sky.exr\" \"string sampling\" \"importance\" " + kMatte + kFloor);
  EXPECT_EQ(named["tables"]["environment"], even["tables"]["environment"].get<int>() + 1);
  EXPECT_GT(map["tables"]["bytes"], even["tables"]["bytes"]);
  EXPECT_EQ(map["textures"]["opened"], 1);
  EXPECT_EQ(map["textures"]["bytes"], 0) << "the image of a light is not kept";
}

TEST_F(Skip, NoTableOfDirectionsTowardLightsIsBuiltWhereNoneIsDrawn) {
  Image sky = Image::Rgb(8, 4);
  for (size_t i = 0; i < sky.Values().size(); ++i) sky.Values()[i] = static_cast<float>(1 + i % 5);
  WriteExr(Path("sky.exr"), sky);
  const auto worldOf = [](const std::string& sampling) {
    return "LightSource \"infinite\" \"string mapname\" \"sky.exr\" \"string sampling\" \"" + sampling + "\" " +
           kMatte + kFloor;
  };
  const auto tables = [&](const std::string& sampling, const std::string& options) {
    return Stats(worldOf(sampling), options)["tables"]["environment"].get<int>();
  };
  const auto heldByEmit = [&](const std::string& sampling) {
    Write("scene.pbrt", kHead + worldOf(sampling) + "WorldEnd");
    const std::string out = Run("emit scene.pbrt -o rays.csv").out;
    return out.substr(std::min(out.find("held"), out.size()));
  };
  const int own = tables("importance", "");
  const std::string held = heldByEmit("importance");
  EXPECT_TRUE(Contains(held, fmt::format("{} tables", own))) << held;
  for (const std::string sampling : {"irradiance", "structured", "compensated", "product"}) {
    EXPECT_EQ(tables(sampling, ""), own + 1) << sampling;
    EXPECT_EQ(tables(sampling, "--direct light"), own + 1) << sampling;
    EXPECT_EQ(tables(sampling, "--direct bsdf"), own) << sampling;
    EXPECT_EQ(tables(sampling, "--integrator light_tracing"), own) << sampling;
    EXPECT_EQ(heldByEmit(sampling), held) << sampling;
  }
}

TEST_F(Skip, BlackLightsEmitNothingAndGetNoTable) {
  WriteMap("black.exr", 0);
  const std::string black =
      "LightSource \"infinite\" \"string mapname\" \"black.exr\" "
      "LightSource \"infinite\" \"rgb L\" [0 0 0] "
      "LightSource \"goniometric\" \"string mapname\" \"black.exr\" "
      "LightSource \"projection\" \"string mapname\" \"black.exr\" "
      "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [0 0 0] Translate 0 0 5 " +
      std::string(kFloor) + "AttributeEnd ";
  const nlohmann::json stats = Stats(black + kPoint + kMatte + kFloor, "--integrator sppm");
  for (const char* kind : {"environment", "lights", "choice"}) EXPECT_EQ(stats["tables"][kind], 0);
  EXPECT_EQ(stats["textures"]["opened"], 3);
  // All photons are the point light's: so are they without the others.
  const nlohmann::json alone = Stats(kPoint + kMatte + kFloor, "--integrator sppm");
  EXPECT_EQ(stats["photons"]["emitted"], alone["photons"]["emitted"]);
  // What is scaled to nothing is not even read.
  const nlohmann::json unread = Stats(
      "LightSource \"infinite\" \"string mapname\" \"missing.exr\" \"rgb scale\" [0 0 0] "
      "LightSource \"goniometric\" \"string mapname\" \"missing.exr\" \"rgb I\" [0 0 0] " +
      kMatte + kFloor);
  EXPECT_EQ(unread["textures"]["opened"], 0);
  EXPECT_EQ(unread["rays"]["shadow"], 0);
}

TEST_F(Skip, TexturesNobodyRefersToAreNeverOpened) {
  WriteMap("there.exr", 0.5f);
  const std::string textures =
      "Texture \"lost\" \"color\" \"imagemap\" \"string filename\" \"missing.exr\" "
      "Texture \"there\" \"color\" \"imagemap\" \"string filename\" \"there.exr\" "
      "MakeNamedMaterial \"unused\" \"string type\" \"matte\" \"texture Kd\" \"lost\" ";
  const nlohmann::json none = Stats(textures + kPoint + kMatte + kFloor);
  EXPECT_EQ(none["textures"]["opened"], 0);
  EXPECT_EQ(none["textures"]["bytes"], 0);
  // Used twice, opened once.
  const nlohmann::json used = Stats(textures + kPoint + "Material \"matte\" \"texture Kd\" \"there\" " + kFloor +
                                    "Material \"mirror\" \"texture Kr\" \"there\" " + kBall);
  EXPECT_EQ(used["textures"]["opened"], 1);
  EXPECT_EQ(used["textures"]["bytes"], 8 * 4 * 3 * 4);
  // The one that is missing is missed as soon as a shape uses it.
  Write("bad.pbrt", kHead + textures + "NamedMaterial \"unused\" " + kFloor + "WorldEnd");
  EXPECT_TRUE(Contains(Run("bad.pbrt --quiet").err, "missing.exr"));
}

TEST_F(Skip, GeometryCountsItsBytes) {
  const auto bytes = [&](const std::string& world) { return Stats(world)["geometry"]["bytes"].get<int64_t>(); };
  std::string many = kPoint + kMatte;
  for (int i = 0; i < 50; ++i) many += kFloor;
  // Four vertices and six indices each, at least.
  EXPECT_GT(bytes(many), bytes(kPoint + kMatte + kFloor) + 49 * (4 * 12 + 6 * 4));
}

TEST_F(Skip, TheSummarySaysWhatWasHeld) {
  Write("scene.pbrt", kHead + std::string(kPoint) + kMatte + kFloor + kBall + "WorldEnd");
  const ProgramResult plain = Run("scene.pbrt --passes 1 --integrator path");
  EXPECT_TRUE(Contains(plain.out, "; 0 tables (0 B); 0 image files (0 B)\n"));
  const ProgramResult photons = Run("scene.pbrt --passes 1 --integrator sppm --photons 1000");
  EXPECT_TRUE(Contains(photons.out, " in pilots\n"));
  EXPECT_TRUE(Contains(photons.out, "; a photon map of up to "));
}

}  // namespace
}  // namespace dapple
