#include "src/app/format.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <new>

namespace dapple {

namespace {

struct Scaled {
  std::string digits;
  std::string_view prefix;
};

/// Three digits, or all of a whole number below 1000.
Scaled Scale(double value) {
  constexpr std::array<std::string_view, 5> kPrefixes{"", "k", "M", "G", "T"};
  size_t i = 0;
  while (value >= 999.5 && i + 1 < kPrefixes.size()) {  // 999.5 would be printed as 1000
    value /= 1000;
    ++i;
  }
  const bool isWhole = i == 0 && value == std::floor(value);
  const int decimals = isWhole || value >= 99.95 ? 0 : (value >= 9.995 ? 1 : 2);
  return {fmt::format("{:.{}f}", value, decimals), kPrefixes[i]};
}

}  // namespace

std::string FormatCount(double value) {
  const Scaled scaled = Scale(value);
  return scaled.prefix.empty() ? scaled.digits : fmt::format("{} {}", scaled.digits, scaled.prefix);
}

std::string FormatBytes(double bytes) {
  const Scaled scaled = Scale(bytes);
  return fmt::format("{} {}B", scaled.digits, scaled.prefix);
}

std::string FormatDuration(double seconds) {
  if (seconds < 9.995) return fmt::format("{:.2f} s", seconds);
  if (seconds < 59.95) return fmt::format("{:.1f} s", seconds);
  if (seconds >= 1e9) return fmt::format("{:.3g} s", seconds);  // of decades nobody reads hours
  const auto whole = static_cast<int64_t>(std::llround(seconds));
  const int64_t hours = whole / 3600, minutes = whole / 60 % 60;
  if (hours == 0) return fmt::format("{}:{:02}", minutes, whole % 60);
  return fmt::format("{}:{:02}:{:02}", hours, minutes, whole % 60);
}

std::string FormatError(const ErrorEstimate& error, bool isBiasKnown) {
  const auto percent = [](double share) { return fmt::format("{:.3g} %", 100 * share); };
  if (!isBiasKnown) return fmt::format("noise about {}", percent(error.noise));
  return fmt::format("error about {} (noise {}, bias {})", percent(error.Total()), percent(error.noise),
                     percent(error.bias));
}

void Tell(const std::string& line) { std::fputs((line + "\n").c_str(), stderr); }

void Print(const std::string& text) { std::fputs(text.c_str(), stdout); }

std::string ErrorLine(const std::exception& error, const FileLocation& place) {
  if (dynamic_cast<const Error*>(&error)) return error.what();
  const bool isMemory = dynamic_cast<const std::bad_alloc*>(&error) != nullptr;
  return Error(place, isMemory ? "the memory does not suffice" : error.what()).what();
}

std::string FormatNumberOf(int64_t count, std::string_view one, std::string_view many) {
  return fmt::format("{} {}", count, count == 1 ? one : many);
}

}  // namespace dapple
