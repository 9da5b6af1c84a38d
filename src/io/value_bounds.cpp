#include "src/io/value_bounds.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace dapple {

namespace {

/// The values as they are written, which colours' conversions may bring out of bounds; empty for types that state none.
std::vector<double> StatedValues(const Parameter& parameter) {
  std::vector<double> values;
  switch (parameter.type) {
    case ParameterType::Float:
    case ParameterType::Rgb:
      return parameter.numbers;
    case ParameterType::Integer:
      values.assign(parameter.integers.begin(), parameter.integers.end());
      return values;
    case ParameterType::Spectrum:
      for (std::size_t i = 1; i < parameter.numbers.size(); i += 2) values.push_back(parameter.numbers[i]);
      return values;
    default:
      return values;
  }
}

}  // namespace

std::string ValueBounds::ToString() const {
  if (std::isfinite(most)) return fmt::format("{} to {}", least, most);
  return isLeastAllowed ? fmt::format("{} or more", least) : fmt::format("more than {}", least);
}

void CheckBounds(const ParameterList& params, std::string_view name, const ValueBounds& bounds) {
  const Parameter* parameter = params.Find(name);
  if (!parameter) return;
  for (const double value : StatedValues(*parameter))
    if (!bounds.Contains(value))
      throw Error(parameter->location,
                  fmt::format("parameter \"{}\" is {}, expected {}", name, value, bounds.ToString()));
}

void WarnOfClampedShare(const ParameterList& params, std::string_view name, double scale, Diagnostics& diagnostics) {
  const Parameter* parameter = params.Find(name);
  if (!parameter) return;
  std::vector<double> values = StatedValues(*parameter), clamped;
  for (double& value : values) {
    value *= scale;
    clamped.push_back(std::clamp(value, 0., 1.));
  }
  // What only rounding brings above 1 is no mistake.
  const auto isClamped = [](double value) { return value < 0 || static_cast<float>(value) > 1; };
  const auto first = std::find_if(values.begin(), values.end(), isClamped);
  if (first == values.end()) return;
  const char* const times = scale == 1 ? "" : " times \"scale\"";
  if (parameter->type == ParameterType::Spectrum)
    diagnostics.Warn(parameter->location, fmt::format("parameter \"{}\"{} has the value {}, expected 0 to 1; where the "
                                                      "colour that it makes is beyond that, it is clamped",
                                                      name, times, *first));
  else
    diagnostics.Warn(parameter->location, fmt::format("parameter \"{}\"{} is {}, expected 0 to 1; it is clamped to {}",
                                                      name, times, fmt::join(values, " "), fmt::join(clamped, " ")));
}

}  // namespace dapple
