// Lights of every kind, ready to be tested for what is true of all of them.
#pragma once

#include <memory>
#include <random>
#include <string>
#include <vector>

#include "lights/light.h"
#include "src/geometry/shape.h"
#include "src/image/image.h"

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

/// Independent uniform random numbers.
class RandomNumbers {
 public:
  explicit RandomNumbers(unsigned seed) : engine_(seed) {}
  double Get1D() { return uniform_(engine_); }
  Vec2d Get2D() {
    const double x = Get1D();
    return {x, Get1D()};
  }
  LeRandom Le() {
    LeRandom u;
    u.part = Get1D(), u.position = Get2D(), u.direction = Get2D();
    return u;
  }
  LiRandom Li() {
    LiRandom u;
    u.part = Get1D(), u.direction = Get2D();
    return u;
  }

 private:
  std::mt19937_64 engine_;
  std::uniform_real_distribution<double> uniform_{0, 1};
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
  double StandardError() const { return std::sqrt(std::max(0.0, squares_) / (count_ * (count_ - 1))); }

 private:
  double count_ = 0, mean_ = 0, squares_ = 0;
};

/// An image of random radiances of which some pixels are black and one is much brighter than the rest.
Image RandomEnvironment(int width, int height, unsigned seed);

/// The first hit of the ray with the shape.
std::optional<SurfaceInteraction> FirstHit(const Shape& shape, const Ray& ray);

}  // namespace dapple
