#include "src/sampling/distribution.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "tests/support/chi_square.h"
#include "tests/support/table_checks.h"

namespace dapple {
namespace {

constexpr double kBelowOne = 0x1.fffffffffffffp-1;

Distribution1D Make(const std::vector<double>& weights) { return Distribution1D(std::span<const double>(weights)); }

std::vector<double> RandomNumbers(int count) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<double> numbers = {0, 0x1p-53, 0.5, kBelowOne};
  for (int i = 0; i < count; ++i) numbers.push_back(uniform(random));
  return numbers;
}

// Tables that are hard in some way: zeros at the ends and in runs, one cell, one bright cell, many cells.
std::vector<std::vector<double>> Tables() {
  std::vector<double> bright(1000, 1e-3), large(100000);
  bright[371] = 1e6;
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(-0.5, 1);
  for (double& w : large) w = std::max(0.0, uniform(random));
  return {{1}, {0, 1}, {1, 0}, {0, 0, 3, 0, 0, 1, 0}, {1, 2, 3, 4}, {1e-300, 3e-300}, {1e300, 1e300}, bright, large};
}

TEST(Distribution1D, CellsAreDrawnByTheirShare) {
  for (const std::vector<double>& weights : Tables()) {
    const Distribution1D distribution = Make(weights);
    double sum = 0, before = 0;
    for (double w : weights) sum += w;
    for (int i = 0; i < distribution.Size(); ++i) {
      const double share = weights[static_cast<size_t>(i)] / sum;
      ASSERT_NEAR(distribution.Probability(i), share, 1e-14);
      if (share > 1e-12) {
        // The interval of random numbers that gives the cell is as long as its share, and stands in the cells' order.
        EXPECT_EQ(distribution.SampleDiscrete(before + share / 2).index, i);
      }
      before += share;
    }
    EXPECT_NEAR(before, 1, 1e-9);
  }
}

TEST(Distribution1D, ZeroCellsAreNeverDrawn) {
  for (const std::vector<double>& weights : Tables()) {
    const Distribution1D distribution = Make(weights);
    for (double u : RandomNumbers(10000)) {
      const DiscreteSample drawn = distribution.SampleDiscrete(u);
      ASSERT_GT(weights[static_cast<size_t>(drawn.index)], 0) << u;
      ASSERT_GT(drawn.probability, 0);
      ASSERT_TRUE(drawn.u >= 0 && drawn.u < 1);
    }
  }
}

TEST(Distribution1D, DensityOfADrawIsThatOfItsPlaceBitForBit) {
  for (const std::vector<double>& weights : Tables()) {
    const Distribution1D distribution = Make(weights);
    for (double u : RandomNumbers(10000)) {
      const ContinuousSample sample = distribution.SampleContinuous(u);
      ASSERT_EQ(sample.pdf, distribution.Pdf(sample.x));
      ASSERT_EQ(sample.index, distribution.CellOf(sample.x));
      ASSERT_TRUE(sample.x >= 0 && sample.x < 1);
      const DiscreteSample discrete = distribution.SampleDiscrete(u);
      ASSERT_EQ(discrete.probability, distribution.Probability(discrete.index));
    }
  }
}

TEST(Distribution1D, InverseLeadsBack) {
  for (const std::vector<double>& weights : Tables()) {
    const Distribution1D distribution = Make(weights);
    for (double u : RandomNumbers(10000)) {
      const DiscreteSample drawn = distribution.SampleDiscrete(u);
      ASSERT_NEAR(distribution.InvertDiscrete(drawn.index, drawn.u), u, 4 * 0x1p-53);
      // x is known to half an ulp of a number below 1: within a cell of probability p that is n p / 2 ulp of u.
      const ContinuousSample sample = distribution.SampleContinuous(u);
      const double scale = std::max(1.0, sample.pdf);
      ASSERT_NEAR(distribution.Invert(sample.x), u, 4 * 0x1p-53 * scale);
    }
  }
}

TEST(Distribution1D, DensityIntegratesToOne) {
  const Distribution1D distribution = Make({0, 2, 5, 0, 1});
  double integral = 0;
  for (int i = 0; i < 5000; ++i) integral += distribution.Pdf((i + 0.5) / 5000) / 5000;
  EXPECT_NEAR(integral, 1, 1e-12);
  EXPECT_GT(distribution.Pdf(1), 0);
}

TEST(Distribution1D, NothingIsDrawnWhereAllIsZero) {
  const Distribution1D distribution = Make({0, 0, 0});
  EXPECT_TRUE(distribution.IsZero());
  EXPECT_EQ(distribution.SampleDiscrete(0.3).index, -1);
  EXPECT_EQ(distribution.SampleContinuous(0.3).index, -1);
  EXPECT_EQ(distribution.Pdf(0.3), 0);
  EXPECT_TRUE(Distribution1D().IsZero());
  EXPECT_TRUE(Make({}).IsZero());
}

Distribution2D Make(const std::vector<float>& weights, int width, int height) {
  return Distribution2D(std::span<const float>(weights), width, height);
}

// Rows of zeros at both ends and in the middle, zero cells, one bright cell.
Distribution2D HardTable() {
  return Make({0, 0,    0,     0,  //
               1, 2,    0,     0,  //
               0, 0,    0,     0,  //
               0, 1e6f, 0,     3,  //
               0, 0,    1e-3f, 0,  //
               0, 0,    0,     0},
              4, 6);
}

double RowProbability(const Distribution2D& table, int y) {
  double sum = 0;
  for (int x = 0; x < table.Width(); ++x) sum += table.Probability({x, y});
  return sum;
}

TEST(Distribution2D, DrawDensityAndInverseAgree) {
  for (const Distribution2D& table :
       {HardTable(), Make({5}, 1, 1), Make({0, 0, 0, 1}, 2, 2), Make({1, 0, 0, 0}, 2, 2)}) {
    const std::vector<double> numbers = RandomNumbers(10000);
    for (size_t i = 0; i + 1 < numbers.size(); ++i) {
      const Vec2d u(numbers[i], numbers[i + 1]);
      const ContinuousSample2D sample = table.Sample(u);
      ASSERT_GT(sample.pdf, 0);
      ASSERT_EQ(sample.pdf, table.Pdf(sample.p));
      // Along each axis x is known to half an ulp: within a cell of conditional probability p that is n p / 2 of u.
      const double rowShare = RowProbability(table, sample.cell.y);
      const Vec2d scale(std::max(1.0, sample.pdf / (rowShare * table.Height())),
                        std::max(1.0, rowShare * table.Height()));
      ASSERT_NEAR(table.Invert(sample.p).x, u.x, 4 * 0x1p-53 * scale.x);
      ASSERT_NEAR(table.Invert(sample.p).y, u.y, 4 * 0x1p-53 * scale.y);
      const DiscreteSample2D cell = table.SampleDiscrete(u);
      ASSERT_EQ(cell.cell, sample.cell);
      ASSERT_EQ(cell.probability, table.Probability(cell.cell));
      ASSERT_NEAR(table.InvertDiscrete(cell.cell, cell.u).x, u.x, 4 * 0x1p-53);
      ASSERT_NEAR(table.InvertDiscrete(cell.cell, cell.u).y, u.y, 4 * 0x1p-53);
    }
  }
}

// Any columns of a row: those with weight are drawn, each with its share of the part, and found again.
TEST(Distribution2D, PartsOfRowsAreDrawnAndFoundAgain) {
  const Distribution2D table = HardTable();
  const std::vector<double> numbers = RandomNumbers(50);
  double whole = 0;
  for (int y = 0; y < table.Height(); ++y) {
    whole += table.RowShare(y, 0, table.Width());
    for (int first = 0; first < table.Width(); ++first)
      for (int last = first + 1; last <= table.Width(); ++last) {
        double sum = 0;
        for (int x = first; x < last; ++x) sum += table.Probability({x, y});
        ASSERT_NEAR(table.RowShare(y, first, last), sum, 1e-15);
        if (sum == 0) continue;
        for (double u : numbers) {
          const DiscreteSample drawn = table.SampleRow(y, first, last, u);
          ASSERT_GE(drawn.index, first);
          ASSERT_LT(drawn.index, last);
          ASSERT_GT(drawn.probability, 0);
          ASSERT_NEAR(drawn.probability * sum, table.Probability({drawn.index, y}), 1e-15);
          // The row's table is known to an ulp of one: of the part that is a greater share.
          ASSERT_NEAR(table.InvertRow({drawn.index, y}, first, last, drawn.u), u,
                      4 * 0x1p-53 * table.RowShare(y, 0, table.Width()) / sum);
        }
      }
  }
  EXPECT_NEAR(whole, 1, 1e-15);
}

TEST(Distribution2D, DensityIsTheWeightOverTheMean) {
  const std::vector<float> weights = {1, 2, 3, 0, 5, 1};
  const Distribution2D table = Make(weights, 3, 2);
  const Verdict verdict = testing::CheckTableDensity(table, weights);
  EXPECT_TRUE(verdict.passes) << verdict.message;
  EXPECT_EQ(table.Pdf({0.1, 0.75}), 0);
  EXPECT_NEAR(table.Pdf({1, 1}), 0.5, 1e-14);
  EXPECT_NEAR(table.Sum(), 12, 1e-12);
}

TEST(Distribution2D, NothingIsDrawnWhereAllIsZero) {
  const Distribution2D table = Make({0, 0}, 2, 1);
  EXPECT_TRUE(table.IsZero());
  EXPECT_EQ(table.Sample({0.5, 0.5}).cell.x, -1);
  EXPECT_EQ(table.Pdf({0.5, 0.5}), 0);
}

TEST(DistributionChiSquare, OneDimension) {
  for (const std::vector<double>& weights : Tables()) {
    const Distribution1D distribution = Make(weights);
    const auto sample = [&](double u) { return distribution.SampleContinuous(u).x; };
    const auto pdf = [&](double x) { return distribution.Pdf(x); };
    const testing::ChiSquareOptions options{.samples = 50'000, .rows = 10, .columns = 25, .seed = 4};
    const testing::ChiSquare fit = testing::ChiSquareOnInterval(sample, pdf, 0, 1, options);
    EXPECT_TRUE(fit.Passes()) << weights.size() << " cells: " << fit.message;
  }
}

TEST(DistributionChiSquare, TwoDimensions) {
  const std::vector<float> uneven = {3, 0, 1, 2, 0, 0, 0, 5, 4, 1, 1, 1};
  for (const Distribution2D& table : {HardTable(), Make(uneven, 4, 3), Make(uneven, 3, 4), Make({5}, 1, 1)}) {
    const Verdict verdict = testing::CheckTableDraws(table);
    EXPECT_TRUE(verdict.passes) << verdict.message;
  }
}

// Random numbers are multiples of 2^-32 (src/sampling/sampler.h); 24 bits would reach 170 numbers a cell here, of which
// dim cells would have none.
TEST(DistributionLargeTables, EveryOneOfAHundredThousandCellsIsDrawnByItsShare) {
  constexpr int kCells = 100'000;
  std::vector<double> weights(kCells);
  for (int i = 0; i < kCells; ++i) weights[static_cast<size_t>(i)] = i % 1000 == 7 ? 1e-4 : 1 + i % 3;
  const Distribution1D distribution = Make(weights);
  for (int i = 0; i < kCells; ++i) {
    // The multiples of 2^-32 that give the cell are as many as its probability says, to within one.
    const double low = distribution.InvertDiscrete(i, 0) * 0x1p32, high = distribution.InvertDiscrete(i, 1) * 0x1p32;
    const double first = std::ceil(low), count = std::ceil(high) - first;
    ASSERT_NEAR(count, distribution.Probability(i) * 0x1p32, 1);
    ASSERT_GE(count, 1) << i;
    for (const double k : {first, first + std::floor(count / 2), first + count - 1}) {
      ASSERT_EQ(distribution.SampleDiscrete(k * 0x1p-32).index, i) << k;
    }
  }
}

TEST(DistributionLargeTables, A16384x8192TableIsExactAtEveryCell) {
  constexpr int kWidth = 16384, kHeight = 8192;
  // Rows of zeros, zeros within rows, and one bright cell.
  std::vector<float> row(kWidth), weights(static_cast<size_t>(kWidth) * kHeight);
  for (int x = 0; x < kWidth; ++x) row[static_cast<size_t>(x)] = static_cast<float>(x * 7 % 11);
  double rowSum = 0, sum = 0;
  for (const float w : row) rowSum += static_cast<double>(w);
  for (int y = 0; y < kHeight; ++y) {
    if (y % 5 == 0) continue;
    std::copy(row.begin(), row.end(), weights.begin() + static_cast<ptrdiff_t>(y) * kWidth);
    sum += rowSum;
  }
  constexpr int kBrightRow = 4321;
  constexpr double kBright = 1e6;
  weights[static_cast<size_t>(kBrightRow) * kWidth + 12345] += static_cast<float>(kBright);
  sum += kBright;
  const Distribution2D table(std::span<const float>(weights), kWidth, kHeight);
  EXPECT_NEAR(table.Sum() / sum, 1, 1e-14);
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int i = 0; i < 200'000; ++i) {
    const Vec2d u(uniform(random), uniform(random));
    const ContinuousSample2D drawn = table.Sample(u);
    const float weight = weights[static_cast<size_t>(drawn.cell.y) * kWidth + static_cast<size_t>(drawn.cell.x)];
    ASSERT_GT(weight, 0);
    ASSERT_EQ(drawn.pdf, table.Pdf(drawn.p));
    // A cell's share is a difference of sums near one: known to 2^-53 of its row and of the column of rows.
    ASSERT_NEAR(drawn.pdf / (static_cast<double>(weight) / sum * kWidth * kHeight), 1, 1e-8);
    const Vec2d back = table.Invert(drawn.p);
    const double rowPdf = (rowSum + (drawn.cell.y == kBrightRow ? kBright : 0)) / sum * kHeight;
    ASSERT_NEAR(back.x, u.x, 4 * 0x1p-53 * std::max(1.0, drawn.pdf / rowPdf));
    ASSERT_NEAR(back.y, u.y, 4 * 0x1p-53 * std::max(1.0, rowPdf));
  }
}

}  // namespace
}  // namespace dapple
