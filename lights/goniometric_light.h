// A goniometric light: a point light whose intensity in each direction is read from an image of the sphere of
// directions, as measurements of lamps give it.
//
// pbrt: `LightSource "goniometric"`, at the origin of its space, y up.
//
// | parameter | version | meaning | default |
// |---|---|---|---|
// | "I" | 3, 4 | colour of the intensity, W / sr, by which the image is multiplied | 1 |
// | "scale" | 3: colour, 4: number | another factor | 1 |
// | "mapname" | 3 | image, latitude-longitude, row 0 is up (+y), column 0 at +x, going by +z | even |
// | "filename" | 4 | image, square, equal-area; its middle is up (+y), right is +x, down is +z; colours are averaged |
// even | | "power" | 4 | the flux (by luminance of the image times scale) in all directions; replaces the image's own |
// - |
//
// The image is looked up bilinearly and directions are drawn from what is looked up: both are `EnvironmentMap`'s.
#pragma once

#include "lights/environment_map.h"
#include "lights/image_point_light.h"

namespace dapple {

class GoniometricLight final : public ImagePointLight<EnvironmentMap> {
 public:
  /// The map's intensity is `image` (as `EnvironmentMap` takes it) times `scale`, W / sr. `mapToRender` turns the map's
  /// space, which `mapping` tells, to render space.
  GoniometricLight(const Vec3& position, const Transform& mapToRender, const Image& image, EnvironmentMapping mapping,
                   const Color& scale)
      : ImagePointLight(position, mapToRender, EnvironmentMap(image, mapping, scale)) {}

  std::string_view Name() const override { return "goniometric"; }
};

}  // namespace dapple
