// Putting plain data in a given order without a second copy of it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

#include "src/base/parallel.h"

namespace dapple {

/// values[i] becomes what was values[order[i]]; `order` is a permutation of [0, values.size()). In parallel, eight
/// bytes of each value at a time: needs eight bytes a value besides.
template <typename T>
void PermuteInPlace(std::span<T> values, std::span<const uint32_t> order) {
  static_assert(std::is_trivially_copyable_v<T>);
  constexpr size_t kColumn = 8;
  constexpr int64_t kChunk = 1 << 14;
  const int64_t count = static_cast<int64_t>(values.size());
  auto* bytes = reinterpret_cast<std::byte*>(values.data());
  std::vector<uint64_t> column(values.size());
  for (size_t begin = 0; begin < sizeof(T); begin += kColumn) {
    const size_t width = std::min(kColumn, sizeof(T) - begin);
    ParallelForChunks(count, kChunk, [&](int64_t first, int64_t last) {
      for (int64_t i = first; i < last; ++i)
        std::memcpy(&column[static_cast<size_t>(i)], bytes + order[static_cast<size_t>(i)] * sizeof(T) + begin, width);
    });
    ParallelForChunks(count, kChunk, [&](int64_t first, int64_t last) {
      for (int64_t i = first; i < last; ++i)
        std::memcpy(bytes + static_cast<size_t>(i) * sizeof(T) + begin, &column[static_cast<size_t>(i)], width);
    });
  }
}

}  // namespace dapple
