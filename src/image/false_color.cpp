#include "src/image/false_color.h"

#include <array>
#include <cmath>

#include "src/base/numerics.h"

namespace dapple {

namespace {

/// Colours of equal steps of the scale, from its low end to its high one (linear values).
constexpr std::array<Color, 6> kRamp = {Color(0, 0, 0),
                                        Color(0.05f, 0.01f, 0.16f),
                                        Color(0.32f, 0.02f, 0.18f),
                                        Color(0.85f, 0.12f, 0.03f),
                                        Color(1, 0.6f, 0.05f),
                                        Color(1, 1, 1)};

template <typename F>
Image Paint(const Image& values, F place) {
  Image picture = Image::Rgb(values.Width(), values.Height());
  picture.origin = values.origin;
  picture.fullSize = values.fullSize;
  for (int y = 0; y < values.Height(); ++y)
    for (int x = 0; x < values.Width(); ++x) picture.SetColor(x, y, RampColor(place(double{values.At(x, y, 0)})));
  return picture;
}

}  // namespace

Color RampColor(double t) {
  const double place = (std::isnan(t) ? 1 : std::clamp(t, 0.0, 1.0)) * (kRamp.size() - 1);
  const size_t i = std::min(static_cast<size_t>(place), kRamp.size() - 2);
  return Lerp(static_cast<float>(place - static_cast<double>(i)), kRamp[i], kRamp[i + 1]);
}

Image FalseColorLogarithmic(const Image& values, double low, double high) {
  assert(low > 0 && low < high);
  return Paint(values, [=](double value) {
    return value > low ? std::log(value / low) / std::log(high / low) : std::isnan(value) ? 1 : 0;
  });
}

Image FalseColorLinear(const Image& values) {
  return Paint(values, [](double value) { return value; });
}

}  // namespace dapple
