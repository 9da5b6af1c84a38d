// Shape statements as shapes, in render space or in the space of an object definition.
//
// Vertices are transformed in double, then rounded to float.
#pragma once

#include <memory>
#include <vector>

#include "src/geometry/shape.h"
#include "src/io/build_context.h"

namespace dapple {

/// The shapes that the statement stands for (a pbrt-v4 PLY file may hold triangles and patches); none, with a warning,
/// for a kind that Dapple lacks. `targetFromWorld` comes behind the statement's own transform. Throws `Error` at the
/// place of what is wrong.
std::vector<std::unique_ptr<Shape>> BuildShapes(const BuildContext& context, const ShapeDescription& shape,
                                                const Transform& targetFromWorld);

}  // namespace dapple
