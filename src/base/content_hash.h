// A 128-bit hash of content, to tell whether something is still what it was. No defence against forgery.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

#include "src/base/hash.h"

namespace dapple {

/// Takes pieces one after another; how a text is cut into pieces matters, so that "ab", "c" is not "a", "bc".
class ContentHash {
 public:
  void AddText(std::string_view text) {
    Mix(text.size());
    for (; text.size() >= sizeof(uint64_t); text.remove_prefix(sizeof(uint64_t))) {
      uint64_t word;
      std::memcpy(&word, text.data(), sizeof(word));
      Mix(word);
    }
    uint64_t rest = 0;
    std::memcpy(&rest, text.data(), text.size());
    Mix(rest);
  }
  template <typename T>
  requires std::is_integral_v<T> || std::is_enum_v<T>
  void Add(T number) { Mix(static_cast<uint64_t>(number)); }
  void Add(double number) { Mix(std::bit_cast<uint64_t>(number)); }

  /// 32 hexadecimal digits.
  std::string Hex() const {
    constexpr std::string_view kDigits = "0123456789abcdef";
    std::string hex;
    for (const uint64_t lane : lanes_)
      for (int shift = 60; shift >= 0; shift -= 4) hex += kDigits[MixBits(lane) >> shift & 15];
    return hex;
  }

 private:
  // Both lanes are bijections of what they held before, for any word; they differ in how the word goes in.
  void Mix(uint64_t word) {
    lanes_[0] = MixBits(lanes_[0] ^ word) * 0x9e3779b97f4a7c15ull;
    lanes_[1] = std::rotl(lanes_[1] * 0xd1b54a32d192ed03ull + word, 29) ^ (lanes_[0] >> 32);
  }

  std::array<uint64_t, 2> lanes_{0x243f6a8885a308d3ull, 0x13198a2e03707344ull};
};

}  // namespace dapple
