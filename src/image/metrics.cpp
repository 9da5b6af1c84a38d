#include "src/image/metrics.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include <fmt/format.h>

#include "src/base/error.h"
#include "src/base/numerics.h"

namespace dapple {

namespace {

constexpr double kRelativeOffset = 0.01;
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

}  // namespace

ImageDifference CompareImages(const Image& test, const Image& reference) {
  if (test.Width() != reference.Width() || test.Height() != reference.Height())
    throw Error(fmt::format("cannot compare images of {} x {} and {} x {} pixels: expected the same size", test.Width(),
                            test.Height(), reference.Width(), reference.Height()));
  ImageDifference difference;
  std::vector<double> relativeErrors;
  relativeErrors.reserve(static_cast<size_t>(test.Width()) * static_cast<size_t>(test.Height()));
  double squares = 0, testSum = 0, referenceSum = 0;
  for (int y = 0; y < test.Height(); ++y) {
    for (int x = 0; x < test.Width(); ++x) {
      const Color t = test.ColorAt(x, y), r = reference.ColorAt(x, y);
      if (!t.IsFinite() || !r.IsFinite()) {
        ++difference.nonFinite;
        continue;
      }
      double relative = 0;
      for (int c = 0; c < Color::kComponents; ++c) {
        const double square = Sqr(double{t[c]} - double{r[c]});
        squares += square;
        relative += square / (Sqr(double{r[c]}) + kRelativeOffset);
        testSum += double{t[c]};
        referenceSum += double{r[c]};
      }
      relativeErrors.push_back(relative / Color::kComponents);
    }
  }
  if (relativeErrors.empty()) throw Error("cannot compare images: no pixel is finite in both");
  const auto count = static_cast<double>(relativeErrors.size());
  difference.mse = squares / (count * Color::kComponents);
  difference.relativeMse = std::accumulate(relativeErrors.begin(), relativeErrors.end(), 0.) / count;
  difference.trimmedRelativeMse = TrimmedMean(relativeErrors);
  difference.meanRatio = Ratio(testSum, referenceSum);
  return difference;
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
