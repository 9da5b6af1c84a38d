// Light statements as lights. Units and scales are those of the file's version of pbrt.
//
// pbrt-v3: every light has a colour "scale". pbrt-v4: a number "scale"; spectra and black bodies are first brought to
// luminance one, RGB is taken as it is; "power" (lumen, so to speak) then makes the light's colour, times its scale,
// emit that much (with an image: the image as it is lit), and "illuminance" (of an infinite light: of its upper
// hemisphere, z > 0) shine that much on a plane.
//
// Dapple's own: infinite lights have a string "emission", "importance" (default) or "uniform", which says how the
// directions of emitted photons are drawn (`EnvironmentEmission`); the light itself is the same.
#pragma once

#include <memory>

#include "lights/light.h"
#include "src/geometry/shape.h"
#include "src/io/build_values.h"

namespace dapple {

/// Throws `Error` at the place of what is wrong.
std::unique_ptr<Light> BuildLight(Values& values, const LightDescription& light);

/// The light of a shape, which must outlive it. pbrt gives the
/// "power" of an area light to each triangle of a mesh; here the mesh as a whole gets as much, spread evenly.
/// `alpha` may be null.
std::unique_ptr<Light> BuildAreaLight(Values& values, const Entity& light, const Shape& shape, FloatTexturePtr alpha);

}  // namespace dapple
