// Film, pixel filter, sampler and integrator statements as render settings.
#pragma once

#include "src/io/build_context.h"
#include "src/io/build_scene.h"
#include "src/scene/render_settings.h"

namespace dapple {

/// Throws `Error` at the place of a value that makes no sense.
RenderSettings BuildSettings(const BuildContext& context, const BuildOptions& options);

}  // namespace dapple
