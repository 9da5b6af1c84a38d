// Bounds of the constant values that a file states. What a texture gives is bounded where it is used.
#pragma once

#include <limits>

#include "src/io/parameters.h"

namespace dapple {

/// What values may be.
struct ValueBounds {
  double least = 0, most = std::numeric_limits<double>::infinity();
  bool isLeastAllowed = true;

  bool Contains(double value) const { return (isLeastAllowed ? value >= least : value > least) && value <= most; }
  /// "0 or more", "more than 0", "-1 to 1".
  std::string ToString() const;
};

inline constexpr ValueBounds kNotNegative{};
inline constexpr ValueBounds kPositive{.isLeastAllowed = false};

/// Throws `Error` at the place of the parameter where one of its values, as they are written, is out of bounds:
/// numbers, integers, components of "rgb", values of a spectrum's pairs. Says nothing of a parameter that is not there,
/// nor of textures and other types.
void CheckBounds(const ParameterList& params, std::string_view name, const ValueBounds& bounds);

/// Warns where a share of light, after its multiplication by `scale`, leaves [0, 1], to which it is clamped.
void WarnOfClampedShare(const ParameterList& params, std::string_view name, double scale, Diagnostics& diagnostics);

}  // namespace dapple
