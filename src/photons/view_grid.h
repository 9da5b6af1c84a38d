// Cubes of space as large as some pixels are at their distance from the camera, for what is learned place by place.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "src/base/hash.h"
#include "src/base/vec.h"
#include "src/scene/scene.h"

namespace dapple {

class ViewGrid {
 public:
  ViewGrid() = default;
  /// For cubes about so many pixels wide.
  ViewGrid(const Scene& scene, double pixels) : camera_(scene.GetCamera().Position()), unit_(scene.Extent().radius) {
    const Vec2i& resolution = scene.Settings().resolution;
    const Vec2 middle(static_cast<float>(resolution.x) / 2, static_cast<float>(resolution.y) / 2);
    const CameraRay camera = scene.GetCamera().GenerateRay(middle, Vec2d(0.5), 0.5);
    widthAtLens_ = camera.footprintAtLens * static_cast<float>(pixels);
    spread_ = camera.footprintSpread * static_cast<float>(pixels);
  }

  /// Of so many pixels at the distance of `p` from the camera; positive at the camera too.
  float Width(const Vec3& p) const { return std::max(widthAtLens_ + spread_ * Distance(p, camera_), unit_ * 1e-9f); }

  /// Of the cube that holds `p`, `doublings` times twice as wide as the power of two at or below `Width(p)`, so that
  /// neighbours at nearly the same distance share a grid. `kind` tells grids apart. Never 0.
  uint64_t KeyOf(const Vec3& p, int doublings, int kind) const {
    const int exponent = std::ilogb(Width(p) / unit_) + doublings;
    const Vec3d fromCamera = (ToDouble(p) - ToDouble(camera_)) / static_cast<double>(unit_);
    const auto coordinate = [&](double x) { return static_cast<int64_t>(std::floor(std::ldexp(x, -exponent))); };
    const uint64_t key = Hash(static_cast<uint64_t>(exponent), kind, coordinate(fromCamera.x), coordinate(fromCamera.y),
                              coordinate(fromCamera.z));
    return key | 1;
  }

 private:
  Vec3 camera_{0};
  float unit_ = 1;  // the scene's radius: cubes are cut in these units from the camera, so that no scale matters
  float widthAtLens_ = 0, spread_ = 0;
};

/// Where a hash table with open addressing, a power of two long and never full, holds `key` or would hold it.
template <typename Table>
auto& SlotOf(Table& table, uint64_t key) {
  size_t slot = key & (table.size() - 1);
  while (table[slot].key != 0 && table[slot].key != key) slot = (slot + 1) & (table.size() - 1);
  return table[slot];
}

}  // namespace dapple
