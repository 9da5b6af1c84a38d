// How many tables something has built, and what they hold: for the account of what a render needed.
#pragma once

#include <cstdint>

namespace dapple {

struct TableUse {
  int count = 0;
  int64_t bytes = 0;

  /// One table of that size; none where it holds nothing.
  static TableUse Of(int64_t size) { return {size > 0 ? 1 : 0, size}; }

  TableUse& operator+=(const TableUse& other) {
    count += other.count;
    bytes += other.bytes;
    return *this;
  }
  friend TableUse operator+(TableUse a, const TableUse& b) { return a += b; }
  friend bool operator==(const TableUse&, const TableUse&) = default;
};

}  // namespace dapple
