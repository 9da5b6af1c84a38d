// What a render did, as JSON, for scripts and studies.
#pragma once

#include <optional>
#include <string>

#include "src/render/driver.h"
#include "src/render/output.h"

namespace dapple {

/// What a render needed beside rays: of its scene, and of its integrator's preparation, its choice included.
struct RenderNeeds {
  SceneResources scene;
  PreparationUse preparation;
};

/// One object: the record's fields, "version", "instructionSet", "seconds" and "prepareSeconds" (wall clock), "rays" by
/// kind, "photons" (emitted, stored; begun in pilots), "photonMaps" (built, bytes of the largest), "gathers" (count,
/// photons within reach), "splats", "tables" (how many of the environment, of other lights, of the choice among lights,
/// of what pilots learned; bytes of all), "textures" (image files opened, bytes that are kept), "geometry" (bytes),
/// "nonFinite" (contributions left out), "nonFiniteSources" (how many of these each light, material or the integrator
/// gave), both of all passes in the film, and "error" (as error_estimate.h estimates it: total, noise and bias,
/// which is null where the film does not track it; null where there is no estimate). Ends with a line end.
std::string StatisticsToJson(const RenderRecord& record, const RenderResult& result, const RenderNeeds& needs,
                             const Film& film, const std::optional<ErrorEstimate>& error);

/// "7 of light 0 (point), 2 of material \"wall\" (scene.pbrt:3:1)": what gave the film's values that are not finite;
/// empty where there are none.
std::string DescribeNonFinite(const Film& film);

/// All tables that a render built.
TableUse AllTables(const RenderNeeds& needs);

}  // namespace dapple
