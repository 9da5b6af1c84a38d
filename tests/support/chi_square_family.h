// The family of all chi-square fits of the project's tests: one level for each of them, so that the
// probability that any fails by chance in a run of all test programs is one percent at most (Sidak).
//
// The table says how many fits each test makes at the most; the level follows from their sum. `CountFit`, which the
// harness calls for each fit, fails a test that makes more than its share, that has more instances, or that is not in
// the table.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

namespace dapple::testing {

struct FitShare {
  std::string_view suite, test;  ///< without the names of instances and types
  int fits = 0;                  ///< of each instance
  int instances = 1;             ///< of a test with parameters or types
};

inline constexpr FitShare kFitShares[] = {
    {"ChiSquareHarness", "TrueDensitiesFailAsOftenAsTheLevelSays", 400},
    {"ChiSquareHarness", "RejectsWhatIsFalse", 6},
    {"ChiSquareHarness", "MoreFitsThanTheShareFail", 1},
    {"WarpsChiSquare", "Disks", 6},
    {"WarpsChiSquare", "Sphere", 3},
    {"WarpsChiSquare", "Hemisphere", 3},
    {"WarpsChiSquare", "CosineHemisphere", 3},
    {"WarpsChiSquare", "Cone", 8},
    {"WarpsChiSquare", "Triangle", 3},
    {"WarpsChiSquare", "Linear", 4},
    {"WarpsChiSquare", "Bilinear", 4},
    {"DistributionChiSquare", "OneDimension", 9},
    {"DistributionChiSquare", "TwoDimensions", 4},
    {"NonSpecularBsdf", "SamplesFollowThePdf", 14, 33},
    {"Microfacets", "VisibleNormalsFollowTheirDensity", 14, 4},
    {"Microfacets", "SamplingLeavesAUniformNumber", 7, 4},
    {"EveryLightProof", "DirectionsTowardItFollowTheirDensity", 134},
    {"EveryLightProof", "OriginsOfRaysFollowTheirDensity", 33},
    {"EveryLightProof", "DirectionsOfRaysFollowTheirDensity", 54},
    {"EveryLightProof", "OriginsAndDirectionsFollowTheirDensityTogether", 30},
    {"EnvironmentStrategy", "DirectionsFollowTheirDensityWhichIntegratesToOne", 96},
    {"ProjectionMap", "DirectionsFollowTheirDensity", 3},
    {"AreaLight", "TrianglesOfABigMeshAreChosenByArea", 1},
    {"LightPicker", "PicksFollowTheirProbabilities", 3},
    {"DirectionTable", "DirectionsFollowTheirDensity", 1},
    {"GuidedBsdfs", "DirectionsFollowTheirDensity", 2, 4},
    {"Mutation", "IsRejectedInTheSamplerInTheDensityAndInBoth", 16, 17},
};

constexpr int CountOfAllFits() {
  int count = 0;
  for (const FitShare& share : kFitShares) count += share.fits * share.instances;
  return count;
}

/// The level of each of `tests` independent tests, so that one of them fails by chance with probability `family`.
inline double SidakLevel(double family, int tests) { return -std::expm1(std::log1p(-family) / tests); }

/// The level of every fit of the project.
inline double FitLevel() { return SidakLevel(0.01, CountOfAllFits()); }

namespace internal {

/// "Prefix/Suite/Type" and "Test/0" hold the names of the table between slashes.
inline bool HasPart(const std::string& name, std::string_view part) {
  std::istringstream parts(name);
  for (std::string one; std::getline(parts, one, '/');)
    if (one == part) return true;
  return false;
}

inline bool IsOf(const ::testing::TestInfo& test, const FitShare& share) {
  return HasPart(test.test_suite_name(), share.suite) && HasPart(test.name(), share.test);
}

/// Of the test program, run or not.
inline int InstancesOf(const FitShare& share) {
  const ::testing::UnitTest& program = *::testing::UnitTest::GetInstance();
  int count = 0;
  for (int i = 0; i < program.total_test_suite_count(); ++i) {
    const ::testing::TestSuite& suite = *program.GetTestSuite(i);
    for (int j = 0; j < suite.total_test_count(); ++j) count += IsOf(*suite.GetTestInfo(j), share);
  }
  return count;
}

}  // namespace internal

/// Counts a fit of the running test, which fails where that is too many.
inline void CountFit() {
  static std::map<const ::testing::TestInfo*, int> counts;
  const ::testing::TestInfo* const test = ::testing::UnitTest::GetInstance()->current_test_info();
  if (!test) {
    ADD_FAILURE() << "a chi-square fit outside of any test";
    return;
  }
  const int count = ++counts[test];
  const auto* const share = std::find_if(std::begin(kFitShares), std::end(kFitShares),
                                         [&](const FitShare& s) { return internal::IsOf(*test, s); });
  if (share == std::end(kFitShares)) {
    if (count == 1) ADD_FAILURE() << "a test that fits by chi-square needs its share in kFitShares";
    return;
  }
  if (count == share->fits + 1) ADD_FAILURE() << "more fits than the share in kFitShares: " << share->fits;
  if (count == 1 && internal::InstancesOf(*share) > share->instances)
    ADD_FAILURE() << "more instances than in kFitShares: " << internal::InstancesOf(*share);
}

}  // namespace dapple::testing
