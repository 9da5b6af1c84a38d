// What a pilot has traced: for the account of what a render needed.
#pragma once

#include <cstdint>

namespace dapple {

struct PilotUse {
  int64_t lightPaths = 0;  ///< begun
  int64_t rays = 0;        ///< segments of all paths, and visibility tests

  PilotUse& operator+=(const PilotUse& other) {
    lightPaths += other.lightPaths;
    rays += other.rays;
    return *this;
  }
  friend PilotUse operator+(PilotUse a, const PilotUse& b) { return a += b; }
  friend bool operator==(const PilotUse&, const PilotUse&) = default;
};

}  // namespace dapple
