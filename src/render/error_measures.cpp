#include "src/render/error_measures.h"

#include <cmath>

#include "src/image/metrics.h"

namespace dapple {

MeasuredErrors ErrorMeter::Measure(const Image& test) const {
  const ImageDifference difference = CompareImages(test, reference_);
  return {difference.relativeMse, difference.trimmedRelativeMse, difference.mse, difference.mape,
          flip_.Compare(test).mean};
}

std::optional<MeasuredErrors> ErrorsOfNoise(const Film& film, float exposure) {
  const auto n0 = static_cast<double>(film.PassCount(0)), n1 = static_cast<double>(film.PassCount(1));
  if (n0 == 0 || n1 == 0) return std::nullopt;
  Image mean = film.ToImage(), displaced = film.HalfImage(0);
  const Image other = film.HalfImage(1);
  const auto factor = static_cast<float>(std::sqrt(n0 * n1) / (n0 + n1));
  for (size_t i = 0; i < mean.Values().size(); ++i) {
    float& value = displaced.Values()[i];
    mean.Values()[i] *= exposure;
    value = mean.Values()[i] + (value - other.Values()[i]) * factor * exposure;
  }
  return ErrorMeter(std::move(mean)).Measure(displaced);
}

}  // namespace dapple
