#include "lights/product_strategy.h"

#include <algorithm>

#include "src/base/numerics.h"
#include "src/materials/bsdf.h"

namespace dapple {

namespace {

constexpr int kSplits = 64;               // of the heaviest leaves, once all are of the coarse level
constexpr int kCoarseNodes = 8;           // along the longer side of the map, at least
constexpr int kMostDirections = 1 << 16;  // of the finest level
constexpr size_t kUsualNodes = 512;       // of a tree: more are rare
constexpr double kLeastOfParent = 1. / 8;

double ScatteringToward(const Bsdf& bsdf, const Vec3& wo, const Vec3& wi) {
  return static_cast<double>(bsdf.Eval(wo, wi, TransportMode::Radiance).MaxComponent());
}

}  // namespace

struct ProductStrategy::Tree final : ReceiverTable {
  explicit Tree(const Light* of) : ReceiverTable(of) { nodes.reserve(kUsualNodes); }

  void WeightsBelow(const Node& node, double (&weights)[4]) const {
    for (int i = 0; i < 4; ++i) weights[i] = nodes[static_cast<size_t>(node.firstChild + i)].weight;
  }
  const Node& Child(const Node& node, int quarter) const {
    return nodes[static_cast<size_t>(node.firstChild + quarter)];
  }

  std::vector<Node> nodes;  // the root first, children behind their parent
};

ProductStrategy::ProductStrategy(const EnvironmentSpace& space) : space_(space) {
  const Vec2i cells = space.map.Cells();
  pyramid_ = WeightPyramid(space.map.CellWeights(0), cells.x, cells.y);
  coarse_ = pyramid_.Root().level;
  while (coarse_ > 0 && std::max(pyramid_.Size(coarse_).x, pyramid_.Size(coarse_).y) < kCoarseNodes) --coarse_;
  while (pyramid_.Size(finest_).x * int64_t{pyramid_.Size(finest_).y} > kMostDirections) ++finest_;
  FillDirections();
}

void ProductStrategy::FillDirections() {
  const auto indexOf = [this](int level, int x, int y) {
    return static_cast<size_t>(y) * static_cast<size_t>(pyramid_.Size(level).x) + static_cast<size_t>(x);
  };
  const auto countOf = [this](int level) {
    return static_cast<size_t>(pyramid_.Size(level).x) * static_cast<size_t>(pyramid_.Size(level).y);
  };
  std::vector<Vec3d> sums(countOf(finest_), Vec3d(0));
  const Vec2i cells = space_.map.Cells();
  for (int y = 0; y < cells.y; ++y) {
    for (int x = 0; x < cells.x; ++x) {
      const double light = pyramid_.Weight({0, {x, y}});
      if (light > 0)
        sums[indexOf(finest_, x >> finest_, y >> finest_)] +=
            space_.map.DirectionOf({x, y}, space_.map.SampleInCell({x, y}, Vec2d(0.5))) * light;
    }
  }
  for (int level = finest_;; ++level) {
    std::vector<Vec3>& directions = directions_.emplace_back();
    for (const Vec3d& sum : sums)
      directions.push_back(space_.frame.ToRender(LengthSquared(sum) > 0 ? Normalize(sum) : Vec3d(0, 0, 1)));
    if (level == pyramid_.Root().level) return;
    std::vector<Vec3d> above(countOf(level + 1), Vec3d(0));
    for (int y = 0; y < pyramid_.Size(level).y; ++y)
      for (int x = 0; x < pyramid_.Size(level).x; ++x)
        above[indexOf(level + 1, x / 2, y / 2)] += sums[indexOf(level, x, y)];
    sums = std::move(above);
  }
}

const Vec3& ProductStrategy::CentroidOf(const PyramidNode& node) const {
  return directions_[static_cast<size_t>(node.level - finest_)]
                    [static_cast<size_t>(node.at.y) * static_cast<size_t>(pyramid_.Size(node.level).x) +
                     static_cast<size_t>(node.at.x)];
}

const ProductStrategy::Tree* ProductStrategy::TreeOf(const LightContext& at) const {
  return static_cast<const Tree*>(at.TableOf(space_.light));
}

double ProductStrategy::MeanScattering(const PyramidNode& node, const Bsdf& bsdf, const Vec3& wo) const {
  if (node.level <= finest_) return ScatteringToward(bsdf, wo, CentroidOf(node));
  double sum = 0, light = 0;
  for (int quarter = 0; quarter < 4; ++quarter) {
    const PyramidNode part = node.Child(quarter);
    const double weight = pyramid_.Weight(part);
    if (weight > 0) sum += weight * ScatteringToward(bsdf, wo, CentroidOf(part));
    light += weight;
  }
  return sum / light;
}

void ProductStrategy::Split(int index, const Bsdf& bsdf, const Vec3& wo, Tree* tree) const {
  std::vector<Node>& nodes = tree->nodes;
  const Node parent = nodes[static_cast<size_t>(index)];
  nodes[static_cast<size_t>(index)].firstChild = static_cast<int>(nodes.size());
  for (int quarter = 0; quarter < 4; ++quarter) {
    Node child{.place = parent.place.Child(quarter)};
    const double light = pyramid_.Weight(child.place);
    if (light > 0) {
      child.scattering = std::max(MeanScattering(child.place, bsdf, wo), parent.scattering * kLeastOfParent);
      child.weight = light * child.scattering;
    }
    nodes.push_back(child);
  }
}

void ProductStrategy::Refine(const Bsdf& bsdf, const Vec3& wo, Tree* tree) const {
  std::vector<Node>& nodes = tree->nodes;
  std::vector<int> leaves;  // that may be split: a heap by weight
  leaves.reserve(kUsualNodes);
  const auto isLighter = [&nodes](int a, int b) {
    return nodes[static_cast<size_t>(a)].weight < nodes[static_cast<size_t>(b)].weight;
  };
  const auto push = [&](int index) {
    const Node& node = nodes[static_cast<size_t>(index)];
    if (!(node.weight > 0) || node.place.level <= finest_) return;
    leaves.push_back(index);
    std::push_heap(leaves.begin(), leaves.end(), isLighter);
  };
  for (size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i].place.level > coarse_) {
      if (nodes[i].weight > 0) Split(static_cast<int>(i), bsdf, wo, tree);
    } else {
      push(static_cast<int>(i));
    }
  }
  for (int split = 0; split < kSplits && !leaves.empty(); ++split) {
    std::pop_heap(leaves.begin(), leaves.end(), isLighter);
    const int index = leaves.back();
    leaves.pop_back();
    Split(index, bsdf, wo, tree);
    for (int i = 0; i < 4; ++i) push(nodes[static_cast<size_t>(index)].firstChild + i);
  }
}

std::shared_ptr<const ReceiverTable> ProductStrategy::PrepareReceiver(const Bsdf& bsdf, const Vec3& wo) const {
  // The mean over the sphere: whatever it is at the root, finer nodes know better.
  const double mean = static_cast<double>(bsdf.Albedo(wo).MaxComponent()) / (4 * kPiD);
  if (!(mean > 0)) return nullptr;
  const auto tree = std::make_shared<Tree>(space_.light);
  std::vector<Node>& nodes = tree->nodes;
  const PyramidNode root = pyramid_.Root();
  nodes.push_back({root, mean, mean * pyramid_.Weight(root), -1});
  Refine(bsdf, wo, tree.get());
  for (size_t i = nodes.size(); i-- > 0;) {
    if (nodes[i].firstChild < 0) continue;
    nodes[i].weight = 0;
    for (int j = 0; j < 4; ++j) nodes[i].weight += nodes[static_cast<size_t>(nodes[i].firstChild + j)].weight;
  }
  return tree;
}

Vec3 ProductStrategy::Sample(const LightContext& at, const LiRandom& u) const {
  const Tree* const tree = TreeOf(at);
  if (!tree) return space_.Sample(space_.map.Density(), u);
  Vec2d numbers = u.direction;
  const Node* node = tree->nodes.data();
  while (node->firstChild >= 0) {
    double weights[4];
    tree->WeightsBelow(*node, weights);
    node = &tree->Child(*node, SampleQuarter(weights, &numbers).quarter);
  }
  const Vec2i cell = pyramid_.Sample(node->place, &numbers).cell;
  return space_.frame.ToRender(space_.map.DirectionOf(cell, space_.map.SampleInCell(cell, numbers)));
}

double ProductStrategy::Pdf(const LightContext& at, const Vec3&, const EnvironmentPlace& place) const {
  const Tree* const tree = TreeOf(at);
  if (!tree) return space_.Pdf(space_.map.Density(), place);
  double probability = 1;
  const Node* node = tree->nodes.data();
  while (node->firstChild >= 0) {
    double weights[4];
    tree->WeightsBelow(*node, weights);
    const int quarter = QuarterOf(node->place.level, place.cell);
    probability *= QuarterProbability(weights, quarter);
    node = &tree->Child(*node, quarter);
  }
  if (!(node->weight > 0) || !(probability > 0)) return 0;
  probability *= pyramid_.Probability(node->place.level, place.cell);
  return probability > 0 ? probability * space_.map.PdfInCell(place.cell, place.s) : 0;
}

LiRandom ProductStrategy::Invert(const LightContext& at, const Vec3& wi) const {
  const Tree* const tree = TreeOf(at);
  if (!tree) return space_.Invert(space_.map.Density(), wi);
  LiRandom u;
  const EnvironmentPlace place = space_.map.PlaceOf(space_.frame.ToLight(wi));
  if (pyramid_.Weight({0, place.cell}) == 0) return u;
  std::vector<const Node*> path = {tree->nodes.data()};
  while (path.back()->firstChild >= 0)
    path.push_back(&tree->Child(*path.back(), QuarterOf(path.back()->place.level, place.cell)));
  u.direction = pyramid_.Invert(path.back()->place.level, place.cell, space_.map.InvertInCell(place.cell, place.s));
  for (path.pop_back(); !path.empty(); path.pop_back()) {
    double weights[4];
    tree->WeightsBelow(*path.back(), weights);
    u.direction = InvertQuarter(weights, QuarterOf(path.back()->place.level, place.cell), u.direction);
  }
  return u;
}

TableUse ProductStrategy::Tables() const {
  int64_t bytes = pyramid_.MemoryBytes();
  for (const std::vector<Vec3>& level : directions_) bytes += static_cast<int64_t>(level.size() * sizeof(Vec3));
  return TableUse::Of(bytes);
}

}  // namespace dapple
