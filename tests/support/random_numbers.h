// Independent uniform random numbers for tests.
#pragma once

#include <cstdint>
#include <random>

#include "src/base/vec.h"

namespace dapple::testing {

/// Numbers in [0, 1), the same for the same seed.
class UniformNumbers {
 public:
  explicit UniformNumbers(uint64_t seed) : engine_(seed) {}
  double Get1D() { return uniform_(engine_); }
  Vec2d Get2D() {
    const double x = Get1D();
    return {x, Get1D()};
  }

 private:
  std::mt19937_64 engine_;
  std::uniform_real_distribution<double> uniform_{0, 1};
};

}  // namespace dapple::testing
