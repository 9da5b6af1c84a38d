// Weights of multiple importance sampling.
#pragma once

namespace dapple {

/// The weight of a sample drawn with density `pdf` where another technique could have drawn it with density `otherPdf`,
/// both in the same measure: the power heuristic of exponent 2 (Veach 1997, equation 9.13). Densities may be infinite
/// ratios apart; 0 where `pdf` is 0.
inline double PowerHeuristic(double pdf, double otherPdf) {
  if (!(pdf > 0)) return 0;
  const double ratio = otherPdf / pdf;
  return 1 / (1 + ratio * ratio);
}

}  // namespace dapple
