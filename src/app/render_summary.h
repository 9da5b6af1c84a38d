// What a render tells of itself when it is done.
#pragma once

#include <optional>

#include "src/render/driver.h"
#include "src/render/error_estimate.h"
#include "src/render/statistics.h"

namespace dapple {

/// Prints passes, seconds, rays, photons, accuracy and memory; lines of what did not happen are left out.
void PrintSummary(const RenderResult& result, const RenderNeeds& needs, const Film& film,
                  const std::optional<ErrorEstimate>& error);

}  // namespace dapple
