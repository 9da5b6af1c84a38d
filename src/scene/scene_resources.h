// What a scene had to build and open, counted where it was built: the proof that what it lacks costs nothing.
#pragma once

#include <cstdint>

#include "src/sampling/table_use.h"

namespace dapple {

/// Image files.
struct ImageUse {
  int opened = 0;
  int64_t bytes = 0;  ///< of the images that are kept, as textures are
};

struct SceneResources {
  TableUse environmentTables;  ///< of infinite lights: over directions, and of the disks that they emit from
  TableUse lightTables;        ///< of all other lights
  TableUse choiceTables;       ///< of the choice among lights
  ImageUse images;
  int64_t geometryBytes = 0;  ///< shapes, and what the ray tracer built over them
};

}  // namespace dapple
