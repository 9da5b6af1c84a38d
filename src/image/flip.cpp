#include "src/image/flip.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "src/base/error.h"
#include "src/base/numerics.h"
#include "src/base/parallel.h"
#include "src/base/vec.h"

namespace dapple {

namespace {

// Linear Rec. 709 to CIE XYZ (IEC 61966-2-1); white is the sum of the columns.
constexpr std::array<std::array<double, 3>, 3> kXyzFromRgb = {
    {{0.4124564, 0.3575761, 0.1804375}, {0.2126729, 0.7151522, 0.0721750}, {0.0193339, 0.1191920, 0.9503041}}};

/// X, Y and Z, each over that of white.
Vec3d RelativeXyz(const Vec3d& rgb) {
  Vec3d xyz;
  for (int i = 0; i < 3; ++i) {
    const auto& row = kXyzFromRgb[static_cast<size_t>(i)];
    xyz[i] = (row[0] * rgb.x + row[1] * rgb.y + row[2] * rgb.z) / (row[0] + row[1] + row[2]);
  }
  return xyz;
}

/// The inverse of `RelativeXyz`, by Cramer's rule: the columns are what red, green and blue give.
Vec3d RgbFromRelativeXyz(const Vec3d& xyz) {
  static const std::array<Vec3d, 3> columns = {RelativeXyz({1, 0, 0}), RelativeXyz({0, 1, 0}), RelativeXyz({0, 0, 1})};
  static const double determinant = columns[0].dot(columns[1].cross(columns[2]));
  return Vec3d(xyz.dot(columns[1].cross(columns[2])), xyz.dot(columns[2].cross(columns[0])),
               xyz.dot(columns[0].cross(columns[1]))) /
         determinant;
}

/// YCxCz, the linear opponent space in which an eye's blur is known (2020, section 4.1): luminance, red against green,
/// blue against yellow.
Vec3d OpponentFromRgb(const Vec3d& rgb) {
  const Vec3d xyz = RelativeXyz(rgb);
  return {116 * xyz.y - 16, 500 * (xyz.x - xyz.y), 200 * (xyz.y - xyz.z)};
}

Vec3d RgbFromOpponent(const Vec3d& opponent) {
  const double y = (opponent.x + 16) / 116;
  return RgbFromRelativeXyz({y + opponent.y / 500, y, y - opponent.z / 200});
}

/// CIE 1976 L*a*b*, its chroma scaled by lightness for the Hunt effect: colours look stronger where it is bright.
Vec3d HuntLabFromRgb(const Vec3d& rgb) {
  constexpr double kDelta = 6. / 29;
  const auto f = [](double t) { return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * Sqr(kDelta)) + 4. / 29; };
  const Vec3d xyz = RelativeXyz(rgb);
  const Vec3d root(f(xyz.x), f(xyz.y), f(xyz.z));
  const double lightness = 116 * root.y - 16;
  return {lightness, 0.01 * lightness * 500 * (root.x - root.y), 0.01 * lightness * 200 * (root.y - root.z)};
}

/// HyAB: city blocks in lightness, Euclidean in chroma; for large differences of colour.
double ColorDistance(const Vec3d& p, const Vec3d& q) { return std::abs(p.x - q.x) + std::hypot(p.y - q.y, p.z - q.z); }

constexpr double kColorExponent = 0.7, kFeatureExponent = 0.5;

/// Colour distances from 0 to the largest become [0, 1]: those below 0.4 of it most of the range, 0.95.
double RedistributeColor(double distance) {
  constexpr double kBend = 0.4, kAtBend = 0.95;
  static const double largest =
      std::pow(ColorDistance(HuntLabFromRgb({0, 1, 0}), HuntLabFromRgb({0, 0, 1})), kColorExponent);
  const double power = std::pow(distance, kColorExponent), bend = kBend * largest;
  if (power < bend) return kAtBend * power / bend;
  return kAtBend + (1 - kAtBend) * (power - bend) / (largest - bend);
}

/// The tone mapper of HDR-FLIP: Narkowicz's fit of the ACES curve, a ratio of quadratics, the exposure of 0.6 in it.
struct ToneCurve {
  static constexpr double kA = 0.6 * 0.6 * 2.51, kB = 0.6 * 0.03, kC = 0.6 * 0.6 * 2.43, kD = 0.6 * 0.59, kE = 0.14;

  static double At(double x) { return std::min((kA * x + kB) * x / ((kC * x + kD) * x + kE), 1.); }
  /// The positive x at which the curve is y, in (0, 1).
  static double Inverse(double y) {
    const double a = kA - y * kC, halfB = (kB - y * kD) / 2, c = -y * kE;
    return (-halfB + std::sqrt(Sqr(halfB) - a * c)) / a;
  }
};

/// What is no light counts as none.
Vec3d LightOf(const Color& color) {
  if (!color.IsFinite()) return Vec3d(0);
  return {std::max(0., double{color.r}), std::max(0., double{color.g}), std::max(0., double{color.b})};
}

/// The value of f(x) for x from -radius to radius, over the sum of all.
template <typename F>
std::vector<float> NormalisedKernel(int radius, F f) {
  std::vector<double> values;
  double sum = 0;
  for (int x = -radius; x <= radius; ++x) sum += values.emplace_back(f(x));
  std::vector<float> kernel;
  for (const double value : values) kernel.push_back(static_cast<float>(value / sum));
  return kernel;
}

/// As above, but positive and negative values each over the sum of their own (2020, section 4.2).
template <typename F>
std::vector<float> BalancedKernel(int radius, F f) {
  std::vector<double> values;
  double positive = 0, negative = 0;
  for (int x = -radius; x <= radius; ++x) {
    const double value = values.emplace_back(f(x));
    (value > 0 ? positive : negative) += value;
  }
  std::vector<float> kernel;
  for (const double value : values)
    kernel.push_back(static_cast<float>(value > 0 ? value / positive : -value / negative));
  return kernel;
}

/// A Gaussian of the contrast sensitivity (2020, equation 2): a sqrt(pi / b) exp(-pi^2 x^2 / b), x in degrees.
struct SensitivityTerm {
  double a, b;
};

}  // namespace

double PixelsPerDegree(double distanceMetres, double widthMetres, int widthPixels) {
  return distanceMetres * (widthPixels / widthMetres) * kPiD / 180;
}

FlipExposures ExposuresOf(const Image& reference) {
  std::vector<double> luminances;
  for (int y = 0; y < reference.Height(); ++y) {
    for (int x = 0; x < reference.Width(); ++x) luminances.push_back(RelativeXyz(LightOf(reference.ColorAt(x, y))).y);
  }
  std::ranges::sort(luminances);
  const auto brighter = std::ranges::upper_bound(luminances, 0.);
  if (brighter == luminances.end()) return {};
  const auto median = [](auto begin, auto end) {
    const auto count = end - begin;
    return (*(begin + (count - 1) / 2) + *(begin + count / 2)) / 2;
  };
  double middle = median(luminances.begin(), luminances.end());
  if (middle <= 0) middle = median(brighter, luminances.end());
  const double bright = ToneCurve::Inverse(0.85);
  FlipExposures exposures{std::log2(bright / luminances.back()), std::log2(bright / middle), 2};
  exposures.count = std::max(2, static_cast<int>(std::ceil(exposures.last - exposures.first)));
  return exposures;
}

FlipReference::FlipReference(const Image& reference, FlipRange range, double pixelsPerDegree)
    : width_(reference.Width()), height_(reference.Height()), range_(range) {
  assert(pixelsPerDegree > 0);
  // The widest Gaussian of all channels bounds the kernels of each.
  const int radius = static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * Sqr(kPiD))) * pixelsPerDegree));
  const auto makeBlur = [&](const SensitivityTerm& first, const SensitivityTerm& second) {
    const auto gaussian = [&](const SensitivityTerm& term) {
      return [&](int x) { return std::exp(-Sqr(kPiD * x / pixelsPerDegree) / term.b); };
    };
    // In two dimensions a term weighs its height times the square of the sum of its Gaussian.
    const auto weight = [&](const SensitivityTerm& term) {
      double sum = 0;
      for (int x = -radius; x <= radius; ++x) sum += gaussian(term)(x);
      return term.a * std::sqrt(kPiD / term.b) * Sqr(sum);
    };
    const double share = weight(first) / (weight(first) + weight(second));
    return Blur{NormalisedKernel(radius, gaussian(first)), NormalisedKernel(radius, gaussian(second)),
                static_cast<float>(share)};
  };
  achromatic_ = makeBlur({1, 0.0047}, {0, 1e-5});
  redGreen_ = makeBlur({1, 0.0053}, {0, 1e-5});
  blueYellow_ = makeBlur({34.1, 0.04}, {13.5, 0.025});

  const double sigma = 0.5 * 0.082 * pixelsPerDegree;  // features are 0.082 degrees wide
  const int reach = static_cast<int>(std::ceil(3 * sigma));
  const auto gaussian = [sigma](int x) { return std::exp(-Sqr(x / sigma) / 2); };
  smooth_ = NormalisedKernel(reach, gaussian);
  edge_ = BalancedKernel(reach, [&](int x) { return -x * gaussian(x); });
  point_ = BalancedKernel(reach, [&](int x) { return (Sqr(x / sigma) - 1) * gaussian(x); });

  if (range == FlipRange::High) exposures_ = ExposuresOf(reference);
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) isFinite_.push_back(reference.ColorAt(x, y).IsFinite());
  for (int i = 0; i < exposures_.count; ++i) views_.push_back(Look(reference, exposures_.At(i)));
}

FlipReference::Plane FlipReference::Convolve(const Plane& plane, const Kernel& alongX, const Kernel& alongY) const {
  Plane rows(plane.size()), result(plane.size(), 0.f);
  const auto w = static_cast<size_t>(width_);
  // Beyond the edges the nearest pixel goes on.
  ParallelFor(height_, [&](int64_t y) {
    const int radius = static_cast<int>(alongX.size()) / 2;
    std::vector<float> padded(w + alongX.size() - 1);
    const float* const row = plane.data() + static_cast<size_t>(y) * w;
    for (size_t x = 0; x < padded.size(); ++x) padded[x] = row[std::clamp(static_cast<int>(x) - radius, 0, width_ - 1)];
    float* const out = rows.data() + static_cast<size_t>(y) * w;
    for (size_t k = 0; k < alongX.size(); ++k)
      for (size_t x = 0; x < w; ++x) out[x] += alongX[k] * padded[x + k];
  });
  ParallelFor(height_, [&](int64_t y) {
    const int radius = static_cast<int>(alongY.size()) / 2;
    float* const out = result.data() + static_cast<size_t>(y) * w;
    for (int k = -radius; k <= radius; ++k) {
      const float* const row =
          rows.data() + static_cast<size_t>(std::clamp(static_cast<int>(y) + k, 0, height_ - 1)) * w;
      const float weight = alongY[static_cast<size_t>(k + radius)];
      for (size_t x = 0; x < w; ++x) out[x] += weight * row[x];
    }
  });
  return result;
}

FlipReference::Plane FlipReference::Apply(const Plane& plane, const Blur& blur) const {
  Plane result = Convolve(plane, blur.first, blur.first);
  if (blur.share == 1) return result;
  const Plane second = Convolve(plane, blur.second, blur.second);
  for (size_t i = 0; i < result.size(); ++i) result[i] = blur.share * result[i] + (1 - blur.share) * second[i];
  return result;
}

FlipReference::View FlipReference::Look(const Image& image, double exposure) const {
  const size_t count = isFinite_.size();
  std::array<Plane, 3> opponent;
  for (Plane& plane : opponent) plane.resize(count);
  Plane luminance(count);
  const double factor = std::exp2(exposure);
  ParallelFor(height_, [&](int64_t y) {
    for (int x = 0; x < width_; ++x) {
      Vec3d rgb = LightOf(image.ColorAt(x, static_cast<int>(y)));
      for (int c = 0; c < 3; ++c)
        rgb[c] = range_ == FlipRange::High ? ToneCurve::At(factor * rgb[c]) : std::min(rgb[c], 1.);
      const Vec3d value = OpponentFromRgb(rgb);
      const size_t i = static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x);
      for (int c = 0; c < 3; ++c) opponent[static_cast<size_t>(c)][i] = static_cast<float>(value[c]);
      luminance[i] = static_cast<float>((value.x + 16) / 116);
    }
  });
  View view;
  view.lightness = Apply(opponent[0], achromatic_);
  view.a = Apply(opponent[1], redGreen_);
  view.b = Apply(opponent[2], blueYellow_);
  ParallelForChunks(static_cast<int64_t>(count), 1 << 12, [&](int64_t begin, int64_t end) {
    for (auto i = static_cast<size_t>(begin); i < static_cast<size_t>(end); ++i) {
      const Vec3d blurred(double{view.lightness[i]}, double{view.a[i]}, double{view.b[i]});
      Vec3d rgb = RgbFromOpponent(blurred);
      for (int c = 0; c < 3; ++c) rgb[c] = std::clamp(rgb[c], 0., 1.);
      const Vec3d lab = HuntLabFromRgb(rgb);
      view.lightness[i] = static_cast<float>(lab.x);
      view.a[i] = static_cast<float>(lab.y);
      view.b[i] = static_cast<float>(lab.z);
    }
  });
  LookForFeatures(luminance, &view);
  return view;
}

void FlipReference::LookForFeatures(const Plane& luminance, View* view) const {
  const auto magnitude = [&](const Kernel& kernel) {
    Plane result = Convolve(luminance, kernel, smooth_);
    const Plane alongY = Convolve(luminance, smooth_, kernel);
    for (size_t i = 0; i < result.size(); ++i) result[i] = std::hypot(result[i], alongY[i]);
    return result;
  };
  view->edges = magnitude(edge_);
  view->points = magnitude(point_);
}

void FlipReference::AddDifference(const View& reference, const View& test, Plane* map) const {
  const auto colorOf = [](const View& view, size_t i) {
    return Vec3d(double{view.lightness[i]}, double{view.a[i]}, double{view.b[i]});
  };
  ParallelForChunks(static_cast<int64_t>(map->size()), 1 << 12, [&](int64_t begin, int64_t end) {
    for (auto i = static_cast<size_t>(begin); i < static_cast<size_t>(end); ++i) {
      const double color = RedistributeColor(ColorDistance(colorOf(reference, i), colorOf(test, i)));
      const double edges = std::abs(double{reference.edges[i]} - double{test.edges[i]});
      const double points = std::abs(double{reference.points[i]} - double{test.points[i]});
      const double feature = std::pow(std::max(edges, points) / std::numbers::sqrt2, kFeatureExponent);
      // Features strengthen a difference of colour (2020, equation 8); alone they make none.
      const double difference = std::pow(color, 1 - std::min(feature, 1.));
      (*map)[i] = std::max((*map)[i], static_cast<float>(std::min(difference, 1.)));
    }
  });
}

FlipResult FlipReference::Compare(const Image& test) const {
  if (test.Width() != width_ || test.Height() != height_)
    throw Error(fmt::format("cannot compare images of {} x {} and {} x {} pixels: expected the same size", test.Width(),
                            test.Height(), width_, height_));
  Plane map(isFinite_.size(), 0.f);
  for (int i = 0; i < exposures_.count; ++i)
    AddDifference(views_[static_cast<size_t>(i)], Look(test, exposures_.At(i)), &map);
  FlipResult result;
  int64_t counted = 0;
  for (size_t i = 0; i < map.size(); ++i) {
    const int x = static_cast<int>(i % static_cast<size_t>(width_)),
              y = static_cast<int>(i / static_cast<size_t>(width_));
    if (isFinite_[i] && test.ColorAt(x, y).IsFinite()) {
      result.mean += double{map[i]};
      ++counted;
    } else {
      map[i] = 1;
    }
  }
  if (counted == 0) throw Error("cannot compare images: no pixel is finite in both");
  result.mean /= static_cast<double>(counted);
  result.map = Image(width_, height_, {"Y"}, std::move(map));
  return result;
}

}  // namespace dapple
