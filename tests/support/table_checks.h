// What must be true of a table over the unit square that is drawn from, such as Distribution2D, as checks that give a
// verdict.
//
// `Table` has Width(), Height(), `Sample(u)` with the place `.p`, and `Pdf(p)`.
#pragma once

#include <cmath>
#include <span>
#include <string>

#include "tests/support/chi_square.h"
#include "tests/support/verdict.h"

namespace dapple::testing {

/// Chi-square of what is drawn against the density, over quarters of cells.
template <typename Table>
Verdict CheckTableDraws(const Table& table) {
  const ChiSquare fit = ChiSquareOnCube<2>(
      [&](UniformNumbers& random) {
        const Vec2d p = table.Sample(random.Get2D()).p;
        return std::optional(Coordinates<2>{p.x, p.y});
      },
      [&](const Coordinates<2>& x) {
        return table.Pdf({x[0], x[1]});
      },
      {2 * table.Width(), 2 * table.Height()}, 50'000, 5);
  return {fit.Passes(), fit.message};
}

/// The density is the weight of the cell over the mean of all, within rounding, in the middle of each cell. `weights`:
/// row by row.
template <typename Table>
Verdict CheckTableDensity(const Table& table, std::span<const float> weights) {
  double sum = 0;
  for (const float w : weights) sum += static_cast<double>(w);
  const double mean = sum / static_cast<double>(weights.size());
  for (int y = 0; y < table.Height(); ++y) {
    for (int x = 0; x < table.Width(); ++x) {
      const double pdf = table.Pdf({(x + 0.5) / table.Width(), (y + 0.5) / table.Height()});
      const double expected = static_cast<double>(weights[static_cast<size_t>(y * table.Width() + x)]) / mean;
      if (!(std::abs(pdf - expected) <= 1e-14 * expected))
        return {false, "density " + std::to_string(pdf) + " instead of " + std::to_string(expected) + " in cell " +
                           std::to_string(x) + ", " + std::to_string(y)};
    }
  }
  return {};
}

}  // namespace dapple::testing
