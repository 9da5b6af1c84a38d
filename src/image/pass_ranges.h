// Which passes a film holds: a set of pass numbers as ranges, so that a render may be cut into ranges and joined again.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace dapple {

/// Passes `begin` to `end` - 1; empty where end <= begin.
struct PassRange {
  int64_t begin = 0, end = 0;

  int64_t Count() const { return end > begin ? end - begin : 0; }
  bool IsEmpty() const { return end <= begin; }
  /// "pass 3" or "passes 3 to 7", for people: the last one is named too. Must not be empty.
  std::string ToString() const;
  friend bool operator==(const PassRange&, const PassRange&) = default;
};

/// A set of passes >= 0. It has one form only: ranges in rising order that neither overlap nor touch.
class PassRanges {
 public:
  PassRanges() = default;
  explicit PassRanges(const PassRange& range) { Add(range); }

  /// Adds passes that are not there yet; an empty range adds nothing.
  void Add(const PassRange& range);

  bool IsEmpty() const { return ranges_.empty(); }
  int64_t Count() const { return Count(0) + Count(1); }
  /// How many of them are even (0) or odd (1).
  int64_t Count(int half) const;
  const std::vector<PassRange>& All() const { return ranges_; }

  /// The first passes that both have, or nothing.
  std::optional<PassRange> FirstCommon(const PassRanges& other) const;
  /// The first passes within `range` that are not there, or nothing.
  std::optional<PassRange> FirstMissing(const PassRange& range) const;
  /// "0 to 15, 32 to 47", for people; "none".
  std::string ToString() const;

  friend bool operator==(const PassRanges&, const PassRanges&) = default;

 private:
  std::vector<PassRange> ranges_;
};

}  // namespace dapple
