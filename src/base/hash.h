// Integer hashing for random seeds: bijective mixers, no state.
#pragma once

#include <cstdint>

namespace dapple {

/// A bijection of 64 bits in which each input bit changes each output bit with probability near one half
/// (Stafford's variant 13 of the MurmurHash3 finaliser).
constexpr uint64_t MixBits(uint64_t v) {
  v ^= v >> 30;
  v *= 0xbf58476d1ce4e5b9ull;
  v ^= v >> 27;
  v *= 0x94d049bb133111ebull;
  v ^= v >> 31;
  return v;
}

/// A hash of a short sequence of integers; the order matters.
template <typename... Rest>
constexpr uint64_t Hash(uint64_t first, Rest... rest) {
  const uint64_t mixed = MixBits(first + 0x9e3779b97f4a7c15ull);
  if constexpr (sizeof...(rest) == 0) {
    return mixed;
  } else {
    uint64_t h = mixed;
    ((h = MixBits(h * 0x9e3779b97f4a7c15ull + static_cast<uint64_t>(rest) + 1)), ...);
    return h;
  }
}

}  // namespace dapple
