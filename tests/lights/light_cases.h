// Lights of every kind, ready to be tested for what is true of all of them.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "lights/light.h"
#include "src/geometry/shape.h"
#include "src/image/image.h"
#include "tests/support/random_numbers.h"

namespace dapple {

/// The sphere that stands for the scene of all cases; all lights with a place lie inside.
inline const SceneExtent kTestExtent{Vec3(0.5f, -0.25f, 1), 4};

/// A light, prepared, with the shape it shines from (null: none).
struct LightCase {
  std::string name;
  std::unique_ptr<Shape> shape;
  std::unique_ptr<Light> light;
};

std::vector<LightCase> AllLights();

inline LeRandom DrawLe(testing::UniformNumbers& random) {
  LeRandom u;
  u.part = random.Get1D(), u.position = random.Get2D(), u.direction = random.Get2D();
  return u;
}

inline LiRandom DrawLi(testing::UniformNumbers& random) {
  LiRandom u;
  u.part = random.Get1D(), u.direction = random.Get2D();
  return u;
}

/// Independent uniform random numbers, as lights take them.
class RandomNumbers : public testing::UniformNumbers {
 public:
  using UniformNumbers::UniformNumbers;
  LeRandom Le() { return DrawLe(*this); }
  LiRandom Li() { return DrawLi(*this); }
};

/// Mean of numbers and its standard error.
class Mean {
 public:
  void Add(double x) {
    ++count_;
    const double delta = x - mean_;
    mean_ += delta / count_;
    squares_ += delta * (x - mean_);
  }
  double Value() const { return mean_; }
  double Count() const { return count_; }
  double StandardDeviation() const { return std::sqrt(std::max(0.0, squares_) / (count_ - 1)); }
  double StandardError() const { return StandardDeviation() / std::sqrt(count_); }

 private:
  double count_ = 0, mean_ = 0, squares_ = 0;
};

/// An image of random radiances of which some pixels are black and one is much brighter than the rest.
Image RandomEnvironment(int width, int height, unsigned seed);

/// The first hit of the ray with the shape.
std::optional<SurfaceInteraction> FirstHit(const Shape& shape, const Ray& ray);

}  // namespace dapple
