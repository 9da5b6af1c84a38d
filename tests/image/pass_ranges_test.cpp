#include "src/image/pass_ranges.h"

#include <set>

#include <gtest/gtest.h>

#include "src/base/hash.h"

namespace dapple {
namespace {

PassRanges Of(const std::vector<PassRange>& ranges) {
  PassRanges set;
  for (const PassRange& range : ranges) set.Add(range);
  return set;
}

TEST(PassRanges, HaveOneFormInWhateverOrderTheyCame) {
  const PassRanges whole(PassRange{0, 10});
  EXPECT_EQ(Of({{4, 7}, {0, 4}, {7, 10}}), whole);
  EXPECT_EQ(Of({{7, 10}, {4, 7}, {0, 4}}), whole);
  EXPECT_EQ(Of({{0, 4}, {7, 10}, {4, 7}}), whole);
  EXPECT_EQ(Of({{3, 3}, {5, 2}}), PassRanges());
  EXPECT_EQ(Of({{7, 10}, {0, 4}}).All(), (std::vector<PassRange>{{0, 4}, {7, 10}}));
}

// Against a set of single numbers, over random additions.
TEST(PassRanges, AreTheSetOfTheirPasses) {
  PassRanges ranges;
  std::set<int64_t> single;
  for (uint64_t i = 0; i < 60; ++i) {
    const auto begin = static_cast<int64_t>(Hash(i, 1) % 100), length = static_cast<int64_t>(Hash(i, 2) % 4);
    const PassRange range{begin, begin + length};
    const auto common = ranges.FirstCommon(PassRanges(range));
    const auto missing = ranges.FirstMissing(range);
    const auto isThere = [&](int64_t pass) { return single.contains(pass); };
    int64_t firstCommon = begin, firstMissing = begin;
    while (firstCommon < range.end && !isThere(firstCommon)) ++firstCommon;
    while (firstMissing < range.end && isThere(firstMissing)) ++firstMissing;
    EXPECT_EQ(common ? common->begin : range.end, firstCommon);
    EXPECT_EQ(missing ? missing->begin : range.end, firstMissing);
    if (common || range.IsEmpty()) continue;
    ranges.Add(range);
    for (int64_t pass = range.begin; pass < range.end; ++pass) single.insert(pass);
    int64_t odd = 0;
    for (const int64_t pass : single) odd += pass % 2;
    EXPECT_EQ(ranges.Count(1), odd);
    EXPECT_EQ(ranges.Count(), static_cast<int64_t>(single.size()));
  }
  EXPECT_GT(single.size(), 30u);
}

TEST(PassRanges, AreToldWithTheirLastPass) {
  EXPECT_EQ(PassRanges().ToString(), "none");
  EXPECT_EQ(Of({{0, 16}, {20, 21}}).ToString(), "0 to 15, 20");
  EXPECT_EQ((PassRange{3, 4}).ToString(), "pass 3");
  EXPECT_EQ((PassRange{3, 8}).ToString(), "passes 3 to 7");
}

}  // namespace
}  // namespace dapple
