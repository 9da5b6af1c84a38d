// The camera statement as a camera; and where the origin of render space lies.
#pragma once

#include <memory>

#include "src/io/build_context.h"
#include "src/scene/camera.h"

namespace dapple {

/// The translation that puts the origin of render space where the camera stands.
///
/// As seen from there, the rounding of a point to float is below 1e-7 of its distance, so below 1e-7 radians: under any
/// pixel, however large or far from the world's origin the scene is, and whatever lies far away (pbrt-v4,
/// section 5.1.1, "camera-world"). An orthographic camera may stand anywhere along its view; for it the origin moves
/// along the view, to the depth of the median shape.
Transform RenderFromWorld(const SceneDescription& description);

/// `resolution`: of the whole image. Throws `Error` at the place of a value that makes no sense.
std::unique_ptr<Camera> BuildCamera(const BuildContext& context, const Vec2i& resolution);

}  // namespace dapple
