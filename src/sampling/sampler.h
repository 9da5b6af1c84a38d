// The low-discrepancy sequence behind every random decision: Owen-scrambled Sobol' points.
//
// A `Sampler` is a small value that stands for one sample: a camera path through a pixel, or a light path. Its numbers
// depend on (seed, what it is for, pass) alone. They come in blocks of eight dimensions, one block a path vertex;
// within a block the points of successive samples are an Owen-scrambled Sobol' sequence, and blocks are shuffled
// against each other (Burley 2020, "Practical Hash-based Owen Scrambling"). Even and odd passes are two replicates,
// scrambled independently: pass p takes point p div 2 of replicate p mod 2.
#pragma once

#include <array>
#include <cstdint>

#include "src/base/hash.h"
#include "src/base/vec.h"

namespace dapple {

class Sampler {
 public:
  static constexpr int kBlockDimensions = 8;

  /// One of `samplesPerPass` camera paths of a pass through a pixel.
  static Sampler ForPixel(uint64_t seed, const Vec2i& pixel, int pass, int sample = 0, int samplesPerPass = 1);
  /// Light path number `path` of the `pathsPerPass` of a pass: all of them together are one sequence.
  static Sampler ForLightPath(uint64_t seed, int64_t path, int pass, int64_t pathsPerPass);

  /// Moves to the first dimension of a block. A new sampler stands at block 0.
  void StartBlock(int block);

  /// A sampler for number `i` of `count` samples that are taken at the current block, of a sequence that only they use:
  /// the `count` (best a power of two) of one path are stratified against each other, and so are those of all paths.
  Sampler Branch(int i, int count) const;

  /// A sampler for a path that parts from this one at the current block and has all blocks to itself.
  Sampler Fork() const;

  /// A seed for random numbers beyond those of the block: of this sample and block alone.
  uint64_t BlockSeed() const { return Hash(seed_, index_, block_); }

  /// The next number of the block, in [0, 1), a multiple of 2^-32. At most eight a block.
  double Get1D() { return points_[static_cast<size_t>(next_++)] * 0x1p-32; }
  Vec2d Get2D() {
    const double x = Get1D();
    return {x, Get1D()};
  }

 private:
  Sampler(uint64_t seed, uint32_t index);

  uint64_t seed_;   // of the sequence: what it is for, and the replicate
  uint32_t index_;  // of the point in it
  int block_ = 0;
  int next_ = 0;
  alignas(32) std::array<uint32_t, kBlockDimensions> points_;
};

}  // namespace dapple
