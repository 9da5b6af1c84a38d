// How much of a gather's disk its surface fills. Near the end of a surface, at the corner of a room or the rim of a
// table, part of the disk hangs in the air or lies in the wall, where no photon of the surface can be; a density
// estimate that divides by the whole disk is too dark there (the boundary bias, Jensen 2001, section 7.2.4).
#pragma once

#include <cstdint>

#include "src/photons/kernel.h"
#include "src/photons/same_surface.h"
#include "src/scene/scene.h"

namespace dapple {

/// Estimates 1 / c, where c in (0, 1] is the integral of the kernel over the part of the site's tangent
/// disk above or below which its surface lies (same_surface.h) within the radius: the number of points drawn by the
/// kernel until one is of the surface, whose mean is 1 / c (Booth 2007, "Unbiased Monte Carlo estimation of the
/// reciprocal of an integral"). Where all points are, it is 1 and costs one short ray. At most 64 points are tried, so
/// that a surface much smaller than the disk is left too dark. `seed`: of the points. The rays traced are added to
/// `*rays`.
float InverseCoverage(const Scene& scene, const GatherSite& site, KernelShape shape, uint64_t seed, int64_t* rays);

}  // namespace dapple
