#include "lights/weight_pyramid.h"

#include <algorithm>
#include <cassert>
#include <limits>

#include "src/base/parallel.h"

namespace dapple {

namespace {

constexpr int64_t kRowsPerChunk = 16;

/// The share of the second half, as the difference that random numbers see.
double SecondShare(double first, double second) { return 1 - first / (first + second); }

/// Cuts [0, 1) in two by the halves' weights: true for the second.
bool SampleHalf(double first, double second, double* u, double* probability) {
  constexpr double kBelowOne = 0x1.fffffffffffffp-1;
  const double border = first / (first + second);
  const bool isSecond = *u >= border;
  *probability = isSecond ? SecondShare(first, second) : border;
  *u = std::min((isSecond ? *u - border : *u) / *probability, kBelowOne);
  return isSecond;
}

double HalfProbability(double first, double second, bool isSecond) {
  if (!(first + second > 0)) return 0;
  return isSecond ? SecondShare(first, second) : first / (first + second);
}

double InvertHalf(double first, double second, bool isSecond, double u) {
  if (!(first + second > 0)) return u;
  const double border = first / (first + second);
  return isSecond ? border + u * SecondShare(first, second) : u * border;
}

}  // namespace

QuarterSample SampleQuarter(const double (&w)[4], Vec2d* u) {
  double pRow, pColumn;
  const int row = SampleHalf(w[0] + w[1], w[2] + w[3], &u->y, &pRow) ? 2 : 0;
  const int column = SampleHalf(w[row], w[row + 1], &u->x, &pColumn) ? 1 : 0;
  return {row + column, pRow * pColumn};
}

double QuarterProbability(const double (&w)[4], int quarter) {
  const int row = quarter & 2;
  return HalfProbability(w[0] + w[1], w[2] + w[3], row != 0) * HalfProbability(w[row], w[row + 1], (quarter & 1) != 0);
}

Vec2d InvertQuarter(const double (&w)[4], int quarter, const Vec2d& u) {
  const int row = quarter & 2;
  return {InvertHalf(w[row], w[row + 1], (quarter & 1) != 0, u.x), InvertHalf(w[0] + w[1], w[2] + w[3], row != 0, u.y)};
}

WeightPyramid::WeightPyramid(std::span<const double> weights, int width, int height) {
  const double largest = *std::max_element(weights.begin(), weights.end());
  assert(largest > 0);
  const auto stored = [](double w) {
    return w > 0 ? std::max(static_cast<float>(w), std::numeric_limits<float>::min()) : 0.f;
  };
  levels_.push_back({{width, height}, std::vector<float>(weights.size())});
  ParallelForChunks(height, kRowsPerChunk, [&](int64_t begin, int64_t end) {
    for (size_t i = static_cast<size_t>(begin * width); i < static_cast<size_t>(end * width); ++i)
      levels_[0].weights[i] = stored(weights[i] / largest);
  });
  while (levels_.back().size != Vec2i(1, 1)) {
    const int level = static_cast<int>(levels_.size());
    const Vec2i below = levels_.back().size, size((below.x + 1) / 2, (below.y + 1) / 2);
    Level next{size, std::vector<float>(static_cast<size_t>(size.x) * static_cast<size_t>(size.y))};
    ParallelForChunks(size.y, kRowsPerChunk, [&](int64_t begin, int64_t end) {
      for (int y = static_cast<int>(begin); y < end; ++y)
        for (int x = 0; x < size.x; ++x) {
          double w[4];
          WeightsBelow({level, {x, y}}, w);
          next.weights[static_cast<size_t>(y) * static_cast<size_t>(size.x) + static_cast<size_t>(x)] =
              stored(w[0] + w[1] + w[2] + w[3]);
        }
    });
    levels_.push_back(std::move(next));
  }
}

void WeightPyramid::WeightsBelow(const PyramidNode& node, double (&weights)[4]) const {
  for (int quarter = 0; quarter < 4; ++quarter) weights[quarter] = Weight(node.Child(quarter));
}

PyramidSample WeightPyramid::Sample(PyramidNode node, Vec2d* u) const {
  double probability = 1;
  while (node.level > 0) {
    double weights[4];
    WeightsBelow(node, weights);
    const QuarterSample drawn = SampleQuarter(weights, u);
    probability *= drawn.probability;
    node = node.Child(drawn.quarter);
  }
  return {node.at, probability};
}

double WeightPyramid::Probability(int level, const Vec2i& cell) const {
  double probability = 1;
  for (; level > 0 && probability > 0; --level) {
    double weights[4];
    WeightsBelow(NodeAbove(level, cell), weights);
    probability *= QuarterProbability(weights, QuarterOf(level, cell));
  }
  return probability;
}

Vec2d WeightPyramid::Invert(int level, const Vec2i& cell, Vec2d u) const {
  for (int l = 1; l <= level; ++l) {
    double weights[4];
    WeightsBelow(NodeAbove(l, cell), weights);
    u = InvertQuarter(weights, QuarterOf(l, cell), u);
  }
  return u;
}

int64_t WeightPyramid::MemoryBytes() const {
  int64_t bytes = 0;
  for (const Level& level : levels_) bytes += static_cast<int64_t>(level.weights.size() * sizeof(float));
  return bytes;
}

}  // namespace dapple
