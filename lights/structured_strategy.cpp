#include "lights/structured_strategy.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

#include "src/base/numerics.h"

namespace dapple {

namespace {

constexpr int kStrata = 256;      // about as many in all
constexpr int kLayers = 6;        // as in the paper
constexpr double kWidest = 0.01;  // sr; parts wider than this get no more samples for their width
constexpr int kMostBlocks = 1 << 15;

/// A square of cells of the map.
struct Block {
  Vec2i at;          ///< in units of its size
  double light = 0;  ///< integral of importance
  double solidAngle = 0;
  Vec3d direction;  ///< of about its middle
  int part = -1;    ///< which connected part of a layer
  int stratum = -1;

  double Radiance() const { return light / solidAngle; }
};

struct Blocks {
  Vec2i size;
  bool wrapsAround;  ///< the first column continues the last
  std::vector<Block> list;

  Block& At(int x, int y) {
    return list[static_cast<size_t>(y) * static_cast<size_t>(size.x) + static_cast<size_t>(x)];
  }
};

Blocks MakeBlocks(const EnvironmentMap& map, const std::vector<double>& weights, int level) {
  const Vec2i cells = map.Cells();
  const int side = 1 << level;
  Blocks blocks{
      {(cells.x + side - 1) / side, (cells.y + side - 1) / side}, map.Mapping() == EnvironmentMapping::LatLong, {}};
  blocks.list.resize(static_cast<size_t>(blocks.size.x) * static_cast<size_t>(blocks.size.y));
  for (int y = 0; y < cells.y; ++y) {
    for (int x = 0; x < cells.x; ++x) {
      Block& block = blocks.At(x >> level, y >> level);
      block.light += weights[static_cast<size_t>(y) * static_cast<size_t>(cells.x) + static_cast<size_t>(x)];
      block.solidAngle += map.CellSolidAngle({x, y});
    }
  }
  const auto middle = [side](int block, int end) { return std::min(block * side + side / 2, end - 1); };
  for (int y = 0; y < blocks.size.y; ++y) {
    for (int x = 0; x < blocks.size.x; ++x) {
      Block& block = blocks.At(x, y);
      block.at = {x, y};
      block.direction = map.DirectionOf({middle(x, cells.x), middle(y, cells.y)}, Vec2d(side == 1 ? 0.5 : 0));
    }
  }
  return blocks;
}

/// The layer of each block: how many standard deviations its radiance has, at most `kLayers` - 1.
std::vector<int> LayersOf(const std::vector<Block>& blocks) {
  double mean = 0, square = 0, solidAngle = 0;
  for (const Block& block : blocks) {
    mean += block.light;
    square += block.light * block.Radiance();
    solidAngle += block.solidAngle;
  }
  mean /= solidAngle;
  const double deviation = SafeSqrt(square / solidAngle - Sqr(mean));
  std::vector<int> layers;
  for (const Block& block : blocks) {
    const double multiple = deviation > 0 ? block.Radiance() / deviation : 0;
    layers.push_back(static_cast<int>(std::min(multiple, kLayers - 1.0)));
  }
  return layers;
}

/// Numbers the connected parts of the layers; returns how many they are.
int FindParts(Blocks* blocks) {
  const std::vector<int> layers = LayersOf(blocks->list);
  const auto layerOf = [&](const Block& block) { return layers[static_cast<size_t>(&block - blocks->list.data())]; };
  int parts = 0;
  std::vector<Block*> open;
  for (Block& first : blocks->list) {
    if (first.part >= 0) continue;
    first.part = parts;
    open.push_back(&first);
    while (!open.empty()) {
      const Block& block = *open.back();
      open.pop_back();
      for (const Vec2i& step : {Vec2i(1, 0), Vec2i(-1, 0), Vec2i(0, 1), Vec2i(0, -1)}) {
        Vec2i to = block.at + step;
        if (blocks->wrapsAround) to.x = (to.x + blocks->size.x) % blocks->size.x;
        if (to.x < 0 || to.y < 0 || to.x >= blocks->size.x || to.y >= blocks->size.y) continue;
        Block& next = blocks->At(to.x, to.y);
        if (next.part >= 0 || layerOf(next) != layerOf(first)) continue;
        next.part = parts;
        open.push_back(&next);
      }
    }
    ++parts;
  }
  return parts;
}

/// Cuts a part into up to `count` strata, numbered from `firstStratum`: centres are chosen each as far as can be from
/// those before, the first where most of the light is. Returns how many they are.
int CutIntoStrata(const std::vector<Block*>& part, int count, int firstStratum) {
  std::vector<double> nearest(part.size(), -2);  // the largest cosine to any centre
  size_t center = 0;
  for (size_t i = 0; i < part.size(); ++i)
    if (part[i]->light > part[center]->light) center = i;
  for (int stratum = 0; stratum < count; ++stratum) {
    const Vec3d& direction = part[center]->direction;
    for (size_t i = 0; i < part.size(); ++i) {
      const double cosine = i == center ? 2 : Dot(part[i]->direction, direction);
      if (cosine <= nearest[i]) continue;
      nearest[i] = cosine;
      part[i]->stratum = firstStratum + stratum;
    }
    center = static_cast<size_t>(std::min_element(nearest.begin(), nearest.end()) - nearest.begin());
    if (nearest[center] >= 1 - 1e-12) return stratum + 1;
  }
  return count;
}

/// The bits of x and y in turn: near numbers are near places.
uint64_t MortonCode(const Vec2i& p) {
  uint64_t code = 0;
  for (int bit = 0; bit < 31; ++bit) {
    code |= (static_cast<uint64_t>(p.x >> bit) & 1) << (2 * bit);
    code |= (static_cast<uint64_t>(p.y >> bit) & 1) << (2 * bit + 1);
  }
  return code;
}

/// The strata of all parts, each with the probability that it is drawn.
std::vector<double> MakeStrata(Blocks* blocks) {
  std::vector<std::vector<Block*>> parts(static_cast<size_t>(FindParts(blocks)));
  for (Block& block : blocks->list)
    if (block.light > 0) parts[static_cast<size_t>(block.part)].push_back(&block);
  std::vector<double> importance;
  for (const std::vector<Block*>& part : parts) {
    double light = 0, solidAngle = 0;
    for (const Block* block : part) {
      light += block->light;
      solidAngle += block->solidAngle;
    }
    importance.push_back(light * std::pow(std::min(solidAngle, kWidest), 0.25));
  }
  const double sum = std::accumulate(importance.begin(), importance.end(), 0.0);
  std::vector<double> strata;
  for (size_t i = 0; i < parts.size(); ++i) {
    if (parts[i].empty()) continue;
    const double share = importance[i] / sum;
    const int wanted = std::max(1, static_cast<int>(std::lround(kStrata * share)));
    const int count = CutIntoStrata(parts[i], wanted, static_cast<int>(strata.size()));
    strata.insert(strata.end(), static_cast<size_t>(count), share / count);
  }
  return strata;
}

}  // namespace

StructuredStrategy::StructuredStrategy(const EnvironmentSpace& space) : space_(space) {
  const Vec2i cells = space.map.Cells();
  const std::vector<double> weights = space.map.CellWeights(0);
  pyramid_ = WeightPyramid(weights, cells.x, cells.y);
  while (pyramid_.Size(level_).x * int64_t{pyramid_.Size(level_).y} > kMostBlocks) ++level_;
  Blocks blocks = MakeBlocks(space.map, weights, level_);
  size_ = blocks.size;
  const std::vector<double> probabilities = MakeStrata(&blocks);

  std::vector<double> lights(probabilities.size());
  std::vector<Vec2i> corners(probabilities.size(), Vec2i(std::numeric_limits<int>::max()));
  std::vector<const Block*> order;
  for (const Block& block : blocks.list) {
    if (block.stratum < 0) continue;
    lights[static_cast<size_t>(block.stratum)] += block.light;
    Vec2i& corner = corners[static_cast<size_t>(block.stratum)];
    corner = {std::min(corner.x, block.at.x), std::min(corner.y, block.at.y)};
    order.push_back(&block);
  }
  // Part by part, in these stratum by stratum, and what is near next to each other: stratified numbers then give
  // stratified directions.
  const auto key = [&corners](const Block* block) {
    return std::tuple(block->part, MortonCode(corners[static_cast<size_t>(block->stratum)]), block->stratum,
                      MortonCode(block->at));
  };
  std::sort(order.begin(), order.end(), [&key](const Block* a, const Block* b) { return key(a) < key(b); });
  ranks_.assign(blocks.list.size(), -1);
  std::vector<double> shares;
  for (const Block* block : order) {
    const size_t stratum = static_cast<size_t>(block->stratum);
    ranks_[static_cast<size_t>(block - blocks.list.data())] = static_cast<int>(shares.size());
    shares.push_back(probabilities[stratum] * (block->light / lights[stratum]));
    blocks_.push_back(block->at);
  }
  byRank_ = Distribution1D(std::span<const double>(shares));
}

Vec3 StructuredStrategy::Sample(const LightContext&, const LiRandom& u) const {
  const int rank = byRank_.SampleDiscrete(u.part).index;
  Vec2d numbers = u.direction;
  const PyramidSample drawn = pyramid_.Sample({level_, blocks_[static_cast<size_t>(rank)]}, &numbers);
  return space_.frame.ToRender(space_.map.DirectionOf(drawn.cell, space_.map.SampleInCell(drawn.cell, numbers)));
}

double StructuredStrategy::Pdf(const LightContext&, const Vec3&, const EnvironmentPlace& place) const {
  const int rank = ranks_[BlockIndex(place.cell)];
  if (rank < 0) return 0;
  const double probability = byRank_.Probability(rank) * pyramid_.Probability(level_, place.cell);
  return probability > 0 ? probability * space_.map.PdfInCell(place.cell, place.s) : 0;
}

LiRandom StructuredStrategy::Invert(const LightContext&, const Vec3& wi) const {
  const EnvironmentPlace place = space_.map.PlaceOf(space_.frame.ToLight(wi));
  LiRandom u;
  const int rank = ranks_[BlockIndex(place.cell)];
  if (rank < 0) return u;
  u.part = byRank_.InvertDiscrete(rank, 0.5);
  Vec2d inCell(0);
  if (pyramid_.Weight({0, place.cell}) > 0) inCell = space_.map.InvertInCell(place.cell, place.s);
  u.direction = pyramid_.Invert(level_, place.cell, inCell);
  return u;
}

}  // namespace dapple
