#include "src/image/metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "src/base/error.h"
#include "src/base/numerics.h"

namespace dapple {

namespace {

constexpr double kTrimmedFraction = 0.001;

double TrimmedMean(std::vector<double>& errors) {
  const auto kept = errors.size() - static_cast<size_t>(kTrimmedFraction * static_cast<double>(errors.size()));
  const auto end = errors.begin() + static_cast<ptrdiff_t>(kept);
  std::nth_element(errors.begin(), end - 1, errors.end());
  return std::accumulate(errors.begin(), end, 0.) / static_cast<double>(kept);
}

double Ratio(double test, double reference) {
  if (reference != 0) return test / reference;
  return test == 0 ? 1 : std::copysign(std::numeric_limits<double>::infinity(), test);
}

void CheckSizes(const Image& test, const Image& reference) {
  if (test.Width() != reference.Width() || test.Height() != reference.Height())
    throw Error(fmt::format("cannot compare images of {} x {} and {} x {} pixels: expected the same size", test.Width(),
                            test.Height(), reference.Width(), reference.Height()));
}

/// Mean over channels of (t - r)^2 / (r^2 + epsilon).
double RelativeSquare(const Color& t, const Color& r) {
  double sum = 0;
  for (int c = 0; c < Color::kComponents; ++c)
    sum += Sqr(double{t[c]} - double{r[c]}) / (Sqr(double{r[c]}) + kRelativeEpsilon);
  return sum / Color::kComponents;
}

/// The channels that make its colour, in the order R, G, B; Y for a gray one; empty where there is none.
std::string ColorChannels(const Image& image) {
  std::string names;
  for (const char* name : {"R", "G", "B"})
    if (image.FindChannel(name) >= 0) names += name;
  return names.empty() && image.FindChannel("Y") >= 0 ? "Y" : names;
}

void CheckChannels(const Image& test, const Image& reference) {
  const std::string ofTest = ColorChannels(test), ofReference = ColorChannels(reference);
  if (ofTest.empty() || ofReference.empty())
    throw Error(fmt::format("cannot compare: the {} has none of the channels R, G, B and Y, but {}",
                            ofTest.empty() ? "image" : "reference",
                            fmt::join((ofTest.empty() ? test : reference).ChannelNames(), ", ")));
  if (ofTest != ofReference)
    throw Error(fmt::format("cannot compare colour channels {} with {} of the reference: expected the same", ofTest,
                            ofReference));
}

PixelBounds WindowOf(const Image& image) { return {image.origin, image.origin + Vec2i(image.Width(), image.Height())}; }

/// The pixels of `window`, which lies inside the image's own.
Image CutTo(const Image& image, const PixelBounds& window) {
  if (window == WindowOf(image)) return image;
  Image cut(window.Width(), window.Height(), image.ChannelNames());
  cut.origin = window.min;
  cut.fullSize = image.fullSize;
  const Vec2i offset = window.min - image.origin;
  for (int y = 0; y < cut.Height(); ++y)
    for (int x = 0; x < cut.Width(); ++x)
      for (int c = 0; c < cut.Channels(); ++c) cut.At(x, y, c) = image.At(x + offset.x, y + offset.y, c);
  return cut;
}

}  // namespace

ImageDifference CompareImages(const Image& test, const Image& reference) {
  CheckSizes(test, reference);
  ImageDifference difference;
  std::vector<double> relativeErrors;
  relativeErrors.reserve(static_cast<size_t>(test.Width()) * static_cast<size_t>(test.Height()));
  double squares = 0, shares = 0, testSum = 0, referenceSum = 0;
  for (int y = 0; y < test.Height(); ++y) {
    for (int x = 0; x < test.Width(); ++x) {
      const Color t = test.ColorAt(x, y), r = reference.ColorAt(x, y);
      if (!t.IsFinite() || !r.IsFinite()) {
        ++difference.nonFinite;
        continue;
      }
      for (int c = 0; c < Color::kComponents; ++c) {
        const double offset = std::abs(double{t[c]} - double{r[c]});
        squares += Sqr(offset);
        shares += offset / (std::abs(double{r[c]}) + kRelativeEpsilon);
        testSum += double{t[c]};
        referenceSum += double{r[c]};
      }
      relativeErrors.push_back(RelativeSquare(t, r));
    }
  }
  if (relativeErrors.empty()) throw Error("cannot compare images: no pixel is finite in both");
  const auto count = static_cast<double>(relativeErrors.size());
  difference.mse = squares / (count * Color::kComponents);
  difference.relativeMse = std::accumulate(relativeErrors.begin(), relativeErrors.end(), 0.) / count;
  difference.trimmedRelativeMse = TrimmedMean(relativeErrors);
  difference.mape = shares / (count * Color::kComponents);
  difference.meanRatio = Ratio(testSum, referenceSum);
  return difference;
}

Image RelativeErrors(const Image& test, const Image& reference) {
  CheckSizes(test, reference);
  Image errors(test.Width(), test.Height(), {"Y"});
  for (int y = 0; y < test.Height(); ++y) {
    for (int x = 0; x < test.Width(); ++x) {
      const Color t = test.ColorAt(x, y), r = reference.ColorAt(x, y);
      const bool isFinite = t.IsFinite() && r.IsFinite();
      errors.At(x, y, 0) = isFinite ? static_cast<float>(std::sqrt(RelativeSquare(t, r))) : kInfinity;
    }
  }
  return errors;
}

ComparablePair MakeComparable(const Image& test, const Image& reference) {
  CheckChannels(test, reference);
  if (test.fullSize != reference.fullSize)
    throw Error(fmt::format("cannot compare pictures of {} x {} and {} x {} pixels: expected the same size",
                            test.fullSize.x, test.fullSize.y, reference.fullSize.x, reference.fullSize.y));
  const PixelBounds a = WindowOf(test), b = WindowOf(reference);
  const PixelBounds shared{{std::max(a.min.x, b.min.x), std::max(a.min.y, b.min.y)},
                           {std::min(a.max.x, b.max.x), std::min(a.max.y, b.max.y)}};
  if (shared.IsEmpty())
    throw Error(
        fmt::format("cannot compare: the data windows, from ({}, {}) to ({}, {}) and from ({}, {}) to ({}, {}), share "
                    "no pixel",
                    a.min.x, a.min.y, a.max.x, a.max.y, b.min.x, b.min.y, b.max.x, b.max.y));
  return {CutTo(test, shared), CutTo(reference, shared), shared != a || shared != b};
}

Image BlockMeans(const Image& image, int blockSize) {
  assert(blockSize >= 1);
  const auto blocks = [blockSize](int size) { return (size + blockSize - 1) / blockSize; };
  Image means(blocks(image.Width()), blocks(image.Height()), image.ChannelNames());
  std::vector<double> sums(means.Values().size());
  const auto channels = static_cast<size_t>(image.Channels());
  for (int y = 0; y < image.Height(); ++y) {
    for (int x = 0; x < image.Width(); ++x) {
      const size_t block =
          static_cast<size_t>(y / blockSize) * static_cast<size_t>(means.Width()) + static_cast<size_t>(x / blockSize);
      for (size_t c = 0; c < channels; ++c) sums[block * channels + c] += double{image.At(x, y, static_cast<int>(c))};
    }
  }
  for (int y = 0; y < means.Height(); ++y) {
    for (int x = 0; x < means.Width(); ++x) {
      const int width = std::min(blockSize, image.Width() - x * blockSize);
      const int height = std::min(blockSize, image.Height() - y * blockSize);
      const size_t block = static_cast<size_t>(y) * static_cast<size_t>(means.Width()) + static_cast<size_t>(x);
      for (size_t c = 0; c < channels; ++c)
        means.At(x, y, static_cast<int>(c)) = static_cast<float>(sums[block * channels + c] / (width * height));
    }
  }
  return means;
}

}  // namespace dapple
