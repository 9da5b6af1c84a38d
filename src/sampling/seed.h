// Seeds as users write them, and as random numbers take them.
#pragma once

#include <cstdint>

namespace dapple {

/// The seed of all random numbers for the number that a user or a file gives; negative ones are as good.
constexpr uint64_t SeedFrom(int number) { return static_cast<uint64_t>(int64_t{number}); }

}  // namespace dapple
