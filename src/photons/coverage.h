// How much of a gather's disk its surface fills. Near the end of a surface, at the corner of a room or the rim of a
// table, part of the disk holds no photon of the surface, because it hangs in the air or lies on a mirror; a density
// estimate that divides by the whole disk is too dark there (the boundary bias, Jensen 2001, section 7.2.4). Where a
// surface goes on below what stands on it, the hidden part counts as filled, and the estimate stays too dark.
#pragma once

#include <cstdint>

#include "src/photons/kernel.h"
#include "src/photons/same_surface.h"
#include "src/scene/scene.h"

namespace dapple {

/// Estimates 1 / c, where c in (0, 1] is the integral of the kernel over the part of the site's tangent disk above or
/// below which, within the radius, lies what holds its photons: its surface (same_surface.h), neither black nor purely
/// specular. The estimate is the number of points drawn by the kernel until one is of that part, whose mean is 1 / c
/// (Booth 2007, "Unbiased Monte Carlo estimation of the reciprocal of an integral"). Where all points are, it is 1 and
/// costs one short ray. It is 64 at most, so that a surface much smaller than the disk is left too dark: the mean is
/// then (1 - (1 - c)^64) / c. `hit` is what gathers, `seed` is of the points; the rays traced are added to `*rays`.
float InverseCoverage(const Scene& scene, const SurfaceInteraction& hit, const GatherSite& site, KernelShape shape,
                      uint64_t seed, int64_t* rays);

}  // namespace dapple
