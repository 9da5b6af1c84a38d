// The rays that a scene's lights emit, as photons begin with them, in the world of the scene's file; and the files that
// they are written to. docs/emission.md tells the columns and their units.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "src/scene/scene.h"

namespace dapple {

/// A ray as it leaves its light. Densities and their flags as in `LeSample`.
struct EmittedRay {
  int light = -1;        ///< its place in `Scene::Lights()`
  Vec3d origin;          ///< on the light, or on the disk before the scene that infinite light sets out from
  Vec3 direction;        ///< unit
  Vec3 normal{0, 0, 0};  ///< of the light's surface there; zero where there is none
  Color radiance;        ///< `LeSample::Le`: intensity of a point, irradiance of a distant light
  double pdfLight = 1;   ///< the probability with which this light was chosen
  double pdfPosition = 0;
  double pdfDirection = 0;
  bool positionIsDiscrete = false;
  bool directionIsDiscrete = false;
  Color flux;  ///< W; over all rays together its sum estimates the power of the lights
};

struct EmitOptions {
  int count = 1000;
  std::optional<int> light;  ///< its place in `Scene::Lights()`; nothing: each ray's is chosen by power
  int seed = 0;
};

struct EmittedRays {
  EmitOptions options;
  std::vector<EmittedRay> rays;  ///< fewer than were asked for where some began on black parts of their light
};

/// The first `count` rays of the sequence that the seed tells: the same on any number of threads. Throws `Error` where
/// the scene has no such light, or none at all.
EmittedRays EmitRays(const Scene& scene, const EmitOptions& options);

/// One line a ray below a header that names the columns; numbers have all their digits.
std::string RaysToCsv(const Scene& scene, const EmittedRays& emitted);
/// An object: "rays", "seed", "lights" (index, name, power in W), "columns" (as in the CSV header), "data" (one array a
/// ray).
std::string RaysToJson(const Scene& scene, const EmittedRays& emitted);
/// Binary, little-endian; one vertex a ray, its position the origin, nx ny nz the direction (what viewers draw), all
/// other columns as further properties. The lights' names are in comments.
std::string RaysToPly(const Scene& scene, const EmittedRays& emitted);

}  // namespace dapple
