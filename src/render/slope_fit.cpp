#include "src/render/slope_fit.h"

#include <cassert>
#include <cmath>
#include <numeric>

#include "src/base/numerics.h"

namespace dapple {

namespace {

double Mean(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.) / static_cast<double>(values.size());
}

/// The probability that |T| < t, t >= 0.
double StudentTCentralMass(double t, int n) {
  const double theta = std::atan(t / std::sqrt(static_cast<double>(n)));
  const double sine = std::sin(theta), cosineSquared = Sqr(std::cos(theta));
  // The sum over powers of the cosine ends at n - 2 (even n) or n - 3 steps, each term a ratio of the one before.
  const bool isOdd = n % 2 == 1;
  double term = isOdd ? std::cos(theta) : 1, sum = 0;
  for (int k = isOdd ? 3 : 2; k <= n; k += 2) {
    sum += term;
    term *= cosineSquared * (k - 1) / k;
  }
  return isOdd ? 2 / kPiD * (theta + sine * sum) : sine * sum;
}

}  // namespace

std::optional<double> LogLogSlope(std::span<const double> x, std::span<const double> y) {
  assert(x.size() == y.size());
  std::vector<double> logX, logY;
  for (size_t i = 0; i < x.size(); ++i) {
    assert(x[i] > 0 && y[i] > 0);
    logX.push_back(std::log(x[i]));
    logY.push_back(std::log(y[i]));
  }
  if (logX.empty()) return std::nullopt;
  const double meanX = Mean(logX), meanY = Mean(logY);
  double products = 0, squares = 0;
  for (size_t i = 0; i < logX.size(); ++i) {
    products += (logX[i] - meanX) * (logY[i] - meanY);
    squares += Sqr(logX[i] - meanX);
  }
  if (!(squares > 0)) return std::nullopt;
  return products / squares;
}

double StudentTQuantile(double probability, int degreesOfFreedom) {
  assert(probability > 0 && probability < 1 && degreesOfFreedom >= 1);
  const double mass = std::abs(2 * probability - 1);
  double low = 0, high = 1;
  while (StudentTCentralMass(high, degreesOfFreedom) < mass) high *= 2;
  for (int i = 0; i < 100; ++i) {
    const double middle = (low + high) / 2;
    (StudentTCentralMass(middle, degreesOfFreedom) < mass ? low : high) = middle;
  }
  return std::copysign((low + high) / 2, probability - 0.5);
}

std::optional<SlopeEstimate> EstimateSlope(std::span<const double> slopes) {
  if (slopes.empty()) return std::nullopt;
  SlopeEstimate estimate{Mean(slopes), std::nullopt, static_cast<int>(slopes.size())};
  if (estimate.seeds < 2) return estimate;
  double squares = 0;
  for (const double slope : slopes) squares += Sqr(slope - estimate.slope);
  const double deviation = std::sqrt(squares / (estimate.seeds - 1) / estimate.seeds);
  estimate.halfWidth = StudentTQuantile(0.975, estimate.seeds - 1) * deviation;
  return estimate;
}

ReachTime TimeToReach(std::span<const double> seconds, std::span<const double> errors, double error,
                      const std::optional<double>& slope) {
  assert(!seconds.empty() && seconds.size() == errors.size());
  if (errors[0] <= error) return {ReachTime::Kind::AtMost, seconds[0]};
  for (size_t i = 1; i < errors.size(); ++i) {
    if (errors[i] > error) continue;
    const double share = std::log(errors[i - 1] / error) / std::log(errors[i - 1] / errors[i]);
    return {ReachTime::Kind::Measured, seconds[i - 1] * std::pow(seconds[i] / seconds[i - 1], share)};
  }
  constexpr double kFlattest = -0.05;
  if (!slope || *slope > kFlattest) return {};
  return {ReachTime::Kind::Extrapolated, seconds.back() * std::pow(error / errors.back(), 1 / *slope)};
}

}  // namespace dapple
