// A grid of numbers, row by row, and its smoothing.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <vector>

namespace dapple {

/// `columns` x `rows` numbers, at least one.
struct Grid {
  Grid(int columnCount, int rowCount)
      : columns(columnCount), rows(rowCount), values(static_cast<size_t>(columns) * static_cast<size_t>(rows)) {}

  int columns, rows;
  std::vector<double> values;

  /// Of the cell, or of the nearest one beyond the border.
  double& At(int x, int y) { return values[Index(x, y)]; }
  double At(int x, int y) const { return values[Index(x, y)]; }

 private:
  size_t Index(int x, int y) const {
    return static_cast<size_t>(std::clamp(y, 0, rows - 1)) * static_cast<size_t>(columns) +
           static_cast<size_t>(std::clamp(x, 0, columns - 1));
  }
};

/// Each number joined with its neighbours, by binomial weights.
inline Grid Smoothed(const Grid& grid) {
  Grid result(grid.columns, grid.rows);
  for (int y = 0; y < grid.rows; ++y)
    for (int x = 0; x < grid.columns; ++x) {
      double sum = 0;
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) sum += (2 - std::abs(dx)) * (2 - std::abs(dy)) * grid.At(x + dx, y + dy);
      result.At(x, y) = sum / 16;
    }
  return result;
}

}  // namespace dapple
