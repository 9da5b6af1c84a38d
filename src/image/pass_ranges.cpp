#include "src/image/pass_ranges.h"

#include <algorithm>
#include <cassert>

#include <fmt/format.h>

namespace dapple {

namespace {

std::string Numbers(const PassRange& range) {
  return range.Count() == 1 ? fmt::format("{}", range.begin) : fmt::format("{} to {}", range.begin, range.end - 1);
}

/// How many of 0 to n - 1 are even (0) or odd (1).
int64_t CountBelow(int64_t n, int half) { return half == 0 ? (n + 1) / 2 : n / 2; }

}  // namespace

std::string PassRange::ToString() const { return (Count() == 1 ? "pass " : "passes ") + Numbers(*this); }

void PassRanges::Add(const PassRange& range) {
  if (range.IsEmpty()) return;
  assert(range.begin >= 0 && FirstMissing(range) == range);
  const auto next = std::ranges::lower_bound(ranges_, range.begin, {}, &PassRange::begin);
  const auto added = ranges_.insert(next, range);
  const auto last = std::next(added);
  if (last != ranges_.end() && last->begin == range.end) {
    added->end = last->end;
    ranges_.erase(last);
  }
  if (added != ranges_.begin() && std::prev(added)->end == range.begin) {
    std::prev(added)->end = added->end;
    ranges_.erase(added);
  }
}

int64_t PassRanges::Count(int half) const {
  int64_t count = 0;
  for (const PassRange& range : ranges_) count += CountBelow(range.end, half) - CountBelow(range.begin, half);
  return count;
}

std::optional<PassRange> PassRanges::FirstCommon(const PassRanges& other) const {
  for (auto a = ranges_.begin(), b = other.ranges_.begin(); a != ranges_.end() && b != other.ranges_.end();) {
    const PassRange common{std::max(a->begin, b->begin), std::min(a->end, b->end)};
    if (!common.IsEmpty()) return common;
    if (a->end < b->end) {
      ++a;
    } else {
      ++b;
    }
  }
  return std::nullopt;
}

std::optional<PassRange> PassRanges::FirstMissing(const PassRange& range) const {
  PassRange missing = range;
  for (const PassRange& present : ranges_) {
    if (present.end <= missing.begin) continue;
    if (present.begin > missing.begin) {
      missing.end = std::min(missing.end, present.begin);
      break;
    }
    missing.begin = present.end;
  }
  if (missing.IsEmpty()) return std::nullopt;
  return missing;
}

std::string PassRanges::ToString() const {
  std::string text;
  for (const PassRange& range : ranges_) text += (text.empty() ? "" : ", ") + Numbers(range);
  return text.empty() ? "none" : text;
}

}  // namespace dapple
