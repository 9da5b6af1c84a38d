// What a render did, as JSON, for scripts and studies.
#pragma once

#include <string>

#include "src/render/driver.h"
#include "src/render/output.h"

namespace dapple {

/// One object: the record's fields, "version", "instructionSet", "seconds" and "prepareSeconds" (wall clock), "rays" by
/// kind, "photons" (emitted, stored), "gathers" (count, photons within reach), "splats", "nonFinite" (samples refused
/// by the film) and "noise" (estimated relative MSE; null before two passes). Ends with a line end.
std::string StatisticsToJson(const RenderRecord& record, const RenderResult& result, const Film& film);

}  // namespace dapple
