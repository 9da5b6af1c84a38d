// The Hilbert curve: an order of the cells of a square in which neighbours on the curve are neighbours in the square.
#pragma once

#include <cstdint>
#include <utility>

#include "src/base/vec.h"

namespace dapple {

/// The cell at `index` on the curve through a square of 2^level x 2^level cells, from (0, 0) to (2^level - 1, 0);
/// 0 <= index < 4^level, level <= 15 (Hilbert 1891). Its quarters are visited one after the other, the first and the
/// last with x and y exchanged, so that they begin and end where their neighbours do.
constexpr Vec2i HilbertCell(int level, uint32_t index) {
  int x = 0, y = 0;
  for (int size = 1; size < 1 << level; size *= 2, index /= 4) {
    const uint32_t quarter = index % 4;
    if (quarter == 0 || quarter == 3) std::swap(x, y);
    if (quarter == 3) {
      x = 2 * size - 1 - x;
      y = size - 1 - y;
    } else {
      if (quarter == 2) x += size;
      if (quarter != 0) y += size;
    }
  }
  return {x, y};
}

}  // namespace dapple
