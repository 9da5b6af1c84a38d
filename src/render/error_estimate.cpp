#include "src/render/error_estimate.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <new>
#include <vector>

#include "src/base/numerics.h"
#include "src/base/parallel.h"
#include "src/image/metrics.h"

namespace dapple {

namespace {

/// Between smooth radiance (4 / 3) and steps (2.15 and more).
constexpr double kBiasOfBlur = 1.9;

/// The mean of the pixels around one, itself left out.
double MeanAround(const Image& image, int x, int y, int c) {
  constexpr int kReach = 2;
  const int x0 = std::max(x - kReach, 0), x1 = std::min(x + kReach + 1, image.Width());
  const int y0 = std::max(y - kReach, 0), y1 = std::min(y + kReach + 1, image.Height());
  double sum = -double{image.At(x, y, c)};
  for (int row = y0; row < y1; ++row)
    for (int column = x0; column < x1; ++column) sum += double{image.At(column, row, c)};
  const int count = (x1 - x0) * (y1 - y0) - 1;
  return count > 0 ? sum / count : double{image.At(x, y, c)};
}

double Median(double a, double b, double c) { return std::max(std::min(a, b), std::min(std::max(a, b), c)); }

/// Sums of relative squares.
struct Squares {
  double noise = 0, bias = 0;
};

class Estimator {
 public:
  Estimator(const Film& film, float exposure)
      : mean_(film.ToImage()),
        halves_{film.HalfImage(0), film.HalfImage(1)},
        n0_(static_cast<double>(film.PassCount(0))),
        n1_(static_cast<double>(film.PassCount(1))),
        exposure_(double{exposure}) {
    if (film.TracksBlur()) blurs_ = {film.BlurImage(0), film.BlurImage(1)};
  }

  /// Means over pixels and channels.
  Squares Estimate() const {
    std::vector<Squares> rows(static_cast<size_t>(mean_.Height()));
    ParallelFor(mean_.Height(), [&](int64_t y) { rows[static_cast<size_t>(y)] = OfRow(static_cast<int>(y)); });
    Squares sum;
    for (const Squares& row : rows) sum.noise += row.noise, sum.bias += row.bias;
    const double values = static_cast<double>(mean_.Width()) * mean_.Height() * Color::kComponents;
    return {sum.noise / values, sum.bias / values};
  }

 private:
  Squares OfRow(int y) const {
    Squares sum;
    for (int x = 0; x < mean_.Width(); ++x) {
      for (int c = 0; c < Color::kComponents; ++c) {
        const double h0 = double{halves_[0].At(x, y, c)}, h1 = double{halves_[1].At(x, y, c)};
        const double expected = exposure_ * Median(h0, h1, MeanAround(mean_, x, y, c));
        const double weight = Sqr(exposure_) / (Sqr(expected) + kRelativeEpsilon);
        sum.noise += weight * Sqr(h0 - h1) * n0_ * n1_ / Sqr(n0_ + n1_);
        if (blurs_[0].Width() > 0)
          sum.bias += weight * Sqr(kBiasOfBlur) * double{blurs_[0].At(x, y, c)} * double{blurs_[1].At(x, y, c)};
      }
    }
    return sum;
  }

  Image mean_;
  std::array<Image, 2> halves_, blurs_;
  double n0_, n1_, exposure_;
};

}  // namespace

double ErrorEstimate::Total() const { return std::sqrt(Sqr(noise) + Sqr(bias)); }

std::optional<ErrorEstimate> EstimateError(const Film& film, float exposure) {
  if (film.PassCount(0) == 0 || film.PassCount(1) == 0) return std::nullopt;
  try {
    const Squares squares = Estimator(film, exposure).Estimate();
    // Where there is next to no bias the products of two independent values scatter around zero.
    return ErrorEstimate{std::sqrt(squares.noise), std::sqrt(std::max(0., squares.bias))};
  } catch (const std::bad_alloc&) {
    return std::nullopt;
  }
}

bool IsErrorDue(int passes) {
  if (passes < 8) return false;
  const auto n = static_cast<unsigned>(passes);
  return n % (std::bit_floor(n) / 4) == 0;
}

}  // namespace dapple
