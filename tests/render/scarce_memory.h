// Memory that runs out where a test says so, whatever the machine has.
#pragma once

#include <cstddef>

namespace dapple {

/// While it lives, `new` of so many bytes or more throws `std::bad_alloc`. One at a time.
class ScarceMemory {
 public:
  explicit ScarceMemory(size_t bytes);
  ~ScarceMemory();
  ScarceMemory(const ScarceMemory&) = delete;
  ScarceMemory& operator=(const ScarceMemory&) = delete;
};

}  // namespace dapple
