#include "src/base/hash.h"

#include <array>
#include <bit>
#include <cmath>
#include <unordered_set>

#include <gtest/gtest.h>

namespace dapple {
namespace {

// MixBits undone: the inverses of its multiplications modulo 2^64, and of its shifts.
uint64_t UnmixBits(uint64_t v) {
  const auto inverse = [](uint64_t a) {
    uint64_t x = a;  // right to 3 bits; each Newton step doubles them
    for (int i = 0; i < 5; ++i) x *= 2 - a * x;
    return x;
  };
  v ^= v >> 31 ^ v >> 62;
  v *= inverse(0x94d049bb133111ebull);
  v ^= v >> 27 ^ v >> 54;
  v *= inverse(0xbf58476d1ce4e5b9ull);
  v ^= v >> 30 ^ v >> 60;
  return v;
}

TEST(Hash, MixBitsIsABijection) {
  for (uint64_t i = 0; i < 10000; ++i) {
    EXPECT_EQ(UnmixBits(MixBits(i)), i);
    EXPECT_EQ(UnmixBits(MixBits(~i << 20)), ~i << 20);
  }
}

// Each input bit flips each output bit in half the cases: over 20,000 inputs the frequency has deviation 0.0035. Among
// 64 x 64 pairs the largest stays below 6 deviations at a significance of 1e-5.
TEST(Hash, EachBitChangesEachBitHalfTheTime) {
  constexpr uint64_t kInputs = 20000;
  for (int input = 0; input < 64; ++input) {
    std::array<int, 64> flips{};
    for (uint64_t i = 0; i < kInputs; ++i) {
      const uint64_t value = i * 0x2545f4914f6cdd1dull;
      uint64_t changed = Hash(value) ^ Hash(value ^ (1ull << input));
      for (; changed != 0; changed &= changed - 1) ++flips[static_cast<size_t>(std::countr_zero(changed))];
    }
    for (const int count : flips) EXPECT_NEAR(static_cast<double>(count) / kInputs, 0.5, 6 * 0.5 / std::sqrt(kInputs));
  }
}

TEST(Hash, NeighbouringTuplesDiffer) {
  std::unordered_set<uint64_t> seen;
  for (uint64_t pixel = 0; pixel < 64; ++pixel)
    for (int pass = 0; pass < 64; ++pass)
      for (uint32_t dimension = 0; dimension < 64; ++dimension) seen.insert(Hash(pixel, pass, dimension));
  EXPECT_EQ(seen.size(), 64u * 64 * 64);
}

TEST(Hash, OrderAndLengthMatter) {
  EXPECT_NE(Hash(1, 2), Hash(2, 1));
  EXPECT_NE(Hash(1), Hash(1, 0));
  EXPECT_NE(Hash(0), Hash(0, 0));
  EXPECT_NE(Hash(0, 0), Hash(0, 0, 0));
  static_assert(Hash(1, 2, 3) == Hash(1, 2, 3));
}

// The top 53 bits of hashed counters as uniform numbers: mean and variance within 5 deviations.
TEST(Hash, CountersGiveUniformNumbers) {
  constexpr int kCount = 100000;
  for (uint64_t dimension = 0; dimension < 4; ++dimension) {
    double sum = 0, squares = 0;
    for (uint64_t i = 0; i < kCount; ++i) {
      const double u = static_cast<double>(Hash(i, dimension) >> 11) * 0x1p-53;
      sum += u;
      squares += u * u;
    }
    EXPECT_NEAR(sum / kCount, 0.5, 5 * std::sqrt(1. / 12 / kCount));
    EXPECT_NEAR(squares / kCount, 1. / 3, 5 * std::sqrt(4. / 45 / kCount));
  }
}

}  // namespace
}  // namespace dapple
