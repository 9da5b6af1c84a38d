// How fast an error falls: slopes on log-log axes, what is known of them from a few seeds, and when a curve reaches an
// error.
//
// The snapshots of one run are means over nested sets of passes, so their errors move together: a line through them has
// residuals that say little of how well its slope is known. Here each seed gives one slope, seeds are independent, and
// the interval is that of their mean.
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace dapple {

/// The least-squares slope of log y against log x (all > 0, as many of both); nothing where there are fewer than two
/// different x.
std::optional<double> LogLogSlope(std::span<const double> x, std::span<const double> y);

/// The quantile of Student's t distribution: the t below which `probability` in (0, 1) of it lies; at least one degree
/// of freedom. From the closed form of its integral (Abramowitz and Stegun, 26.7.3 and 26.7.4).
double StudentTQuantile(double probability, int degreesOfFreedom);

/// A slope with the interval in which it lies with a confidence of 95 %: slope - halfWidth to slope + halfWidth.
struct SlopeEstimate {
  double slope = 0;
  std::optional<double> halfWidth;  ///< nothing from one seed
  int seeds = 0;
};

/// The mean of slopes of independent seeds, with Student's interval; nothing where there are none.
std::optional<SlopeEstimate> EstimateSlope(std::span<const double> slopes);

/// When a curve reaches an error.
struct ReachTime {
  enum class Kind {
    Measured,
    AtMost,        ///< its first point lies there or below
    Extrapolated,  ///< beyond its last point, along its slope
    Never,         ///< beyond its last point, and it falls by less than the 20th root of time
  };
  Kind kind = Kind::Never;
  double seconds = 0;  ///< 0 for `Never`
};

/// The first time at which the curve through (seconds, errors), straight between points on log-log axes, is at or below
/// `error`. Times ascend; all are > 0; there is at least one point. `slope` is what the curve goes on with.
ReachTime TimeToReach(std::span<const double> seconds, std::span<const double> errors, double error,
                      const std::optional<double>& slope);

}  // namespace dapple
