// Renders with an error bar: the passes of a render dealt out over independent groups, and block means compared with a
// reference within a stated tolerance plus the noise that the groups themselves show.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "integrators/integrator.h"
#include "src/image/metrics.h"
#include "src/scene/scene.h"

namespace dapple::testing_support {

/// Images of the same scene that are independent of each other.
struct GroupedImages {
  std::vector<Image> groups;

  /// The mean of all groups.
  Image Mean() const;
};

/// Renders passes 0 to `passes` - 1, pair by pair in turn into `groups` films of seeds of their own. The radius
/// schedule of progressive algorithms runs on over all groups, so each sees the same bias. Keeps the means of blocks of
/// blockSize^2 pixels.
GroupedImages RenderGroups(const Scene& scene, const std::string& integrator, const IntegratorOptions& options,
                           int passes, int groups, uint64_t seed = 1, int blockSize = 1);

/// The same as it would be at radius zero, to first order: twice what gathers of half the radius give, less what those
/// of the radius itself do, both of the same photons (`Film::TrackBlur`).
GroupedImages RenderGroupsAtRadiusZero(const Scene& scene, const std::string& integrator,
                                       const IntegratorOptions& options, int passes, int groups, uint64_t seed);

/// How block means differ from a reference.
struct BlockReport {
  double meanRatio = 1;        ///< of all blocks that were compared
  double worstExcess = -1;     ///< largest (|t - r| - tolerance r - 3 sigma) / (r + floor) over blocks and channels
  int blocks = 0, failed = 0;  ///< how many were compared; how many of them have a positive excess in any channel
  double medianSigma = 0;      ///< relative, over blocks and channels: a noisy picture agrees with anything
  Vec2i worstBlock;
  std::string text;  ///< the worst block in words
};

/// Compares the means of blocks of blockSize^2 pixels. Sigma is the standard error of the block's mean over the groups
/// of both sides. `skip`, where not empty, is one flag a pixel: blocks with any flagged pixel are left out. `floor` is
/// a difference that is allowed in any block, for references with an error of their own; `referenceVariance` is the
/// variance of a reference without groups, as a multiple of the test's.
BlockReport CompareBlocks(const GroupedImages& test, const GroupedImages& reference, int blockSize, double tolerance,
                          const std::vector<bool>& skip = {}, double floor = 0, double referenceVariance = 0);

/// One flag a pixel: any of a few rays through it meets a surface with a specular lobe, which light tracing is blind
/// to, or with one that is nearly so (GGX alpha below `minRoughness`), which it seldom finds.
std::vector<bool> PixelsOnSpecularSurfaces(const Scene& scene, float minRoughness = 0);

/// A reference image without an error bar of its own.
inline GroupedImages Exact(Image image) { return {{std::move(image)}}; }

}  // namespace dapple::testing_support
