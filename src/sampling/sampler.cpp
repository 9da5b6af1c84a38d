#include "src/sampling/sampler.h"

#include <bit>

#include "src/base/hash.h"

namespace dapple {

namespace {

constexpr int kDimensions = Sampler::kBlockDimensions;

constexpr uint32_t ReverseBits(uint32_t x) {
  x = __builtin_bswap32(x);
  x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
  x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
  return ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
}

// A dimension of the Sobol' sequence: a primitive polynomial of degree s over GF(2), its inner coefficients a, and the
// first direction integers (Joe and Kuo 2008, "Constructing Sobol sequences with better two-dimensional projections").
struct Polynomial {
  int s;
  uint32_t a;
  std::array<uint32_t, 5> m;
};
constexpr std::array<Polynomial, kDimensions - 1> kPolynomials = {{{1, 0, {1}},
                                                                   {2, 1, {1, 3}},
                                                                   {3, 1, {1, 3, 1}},
                                                                   {3, 2, {1, 1, 1}},
                                                                   {4, 1, {1, 1, 3, 3}},
                                                                   {4, 4, {1, 3, 5, 13}},
                                                                   {5, 2, {1, 1, 5, 5, 17}}}};

// Entry [bit][dimension]: the direction number that this bit of the index adds, its bits reversed, as scrambling wants
// it.
using DirectionTable = std::array<std::array<uint32_t, kDimensions>, 32>;

constexpr DirectionTable MakeDirections() {
  DirectionTable table{};
  for (uint32_t bit = 0; bit < 32; ++bit) table[bit][0] = 1u << bit;
  for (size_t dimension = 1; dimension < kDimensions; ++dimension) {
    const auto& [s, a, m] = kPolynomials[dimension - 1];
    std::array<uint32_t, 32> v{};
    for (int i = 0; i < 32; ++i) {
      if (i < s) {
        v[static_cast<size_t>(i)] = m[static_cast<size_t>(i)] << (31 - i);
        continue;
      }
      const uint32_t base = v[static_cast<size_t>(i - s)];
      uint32_t value = base ^ (base >> s);
      for (int k = 1; k < s; ++k)
        if ((a >> (s - 1 - k)) & 1) value ^= v[static_cast<size_t>(i - k)];
      v[static_cast<size_t>(i)] = value;
    }
    for (size_t i = 0; i < 32; ++i) table[i][dimension] = ReverseBits(v[i]);
  }
  return table;
}

alignas(32) constexpr DirectionTable kDirections = MakeDirections();

// A nested uniform scramble of reversed bits: each bit flips by a hash of those below it (Laine and Karras 2011, with
// constants found by N. Vegdahl, 2021).
constexpr uint32_t ScrambleReversed(uint32_t x, uint32_t seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return x;
}

}  // namespace

Sampler::Sampler(uint64_t seed, uint32_t index) : seed_(seed), index_(index) { StartBlock(0); }

Sampler Sampler::ForPixel(uint64_t seed, const Vec2i& pixel, int pass, int sample, int samplesPerPass) {
  const uint64_t index = static_cast<uint64_t>(pass / 2) * static_cast<uint64_t>(samplesPerPass) + sample;
  constexpr uint64_t kCamera = 0;
  return {Hash(seed, kCamera, pixel.x, pixel.y, pass & 1, index >> 32), static_cast<uint32_t>(index)};
}

Sampler Sampler::ForLightPath(uint64_t seed, int64_t path, int pass, int64_t pathsPerPass) {
  const uint64_t index = static_cast<uint64_t>(pass / 2) * static_cast<uint64_t>(pathsPerPass) + path;
  constexpr uint64_t kLight = 1;
  return {Hash(seed, kLight, pass & 1, index >> 32), static_cast<uint32_t>(index)};
}

Sampler Sampler::Branch(int i, int count) const {
  constexpr int kBranches = 1 << 20;  // beyond the blocks of any path
  Sampler branch = *this;
  branch.index_ = index_ * static_cast<uint32_t>(count) + static_cast<uint32_t>(i);
  branch.StartBlock(block_ + kBranches);
  return branch;
}

Sampler Sampler::Fork() const {
  constexpr uint64_t kFork = 2;
  Sampler fork = *this;
  fork.seed_ = Hash(seed_, kFork, block_);
  fork.StartBlock(0);
  return fork;
}

void Sampler::StartBlock(int block) {
  next_ = 0;
  block_ = block;
  const uint64_t blockSeed = MixBits(seed_ + static_cast<uint64_t>(block) * 0x9e3779b97f4a7c15ull);
  // The points of a block keep their sequence's order but for an Owen scramble of the index, which leaves every aligned
  // run of 2^k points together: each stays a net. Block 0 is not shuffled.
  uint32_t index = index_;
  if (block > 0) index = ReverseBits(ScrambleReversed(ReverseBits(index), static_cast<uint32_t>(blockSeed >> 32)));
  std::array<uint32_t, kDimensions> x{};
  for (; index != 0; index &= index - 1) {
    const auto& direction = kDirections[static_cast<size_t>(std::countr_zero(index))];
    for (size_t d = 0; d < kDimensions; ++d) x[d] ^= direction[d];
  }
  for (size_t d = 0; d < kDimensions; ++d) {
    const uint32_t seed = static_cast<uint32_t>(blockSeed) + static_cast<uint32_t>(d) * 0x9e3779b9u;
    points_[d] = ReverseBits(ScrambleReversed(x[d], seed * 0x85ebca6bu ^ (seed >> 15)));
  }
}

}  // namespace dapple
