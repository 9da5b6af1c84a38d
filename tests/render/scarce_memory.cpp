#include "tests/render/scarce_memory.h"

#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <new>

namespace {

std::atomic<size_t> refusedFrom{SIZE_MAX};

}  // namespace

void* operator new(size_t bytes) {
  void* const memory = bytes < refusedFrom ? std::malloc(bytes > 0 ? bytes : 1) : nullptr;
  if (!memory) throw std::bad_alloc();
  return memory;
}

void operator delete(void* memory) noexcept { std::free(memory); }

void operator delete(void* memory, size_t) noexcept { std::free(memory); }

namespace dapple {

ScarceMemory::ScarceMemory(size_t bytes) { refusedFrom = bytes; }

ScarceMemory::~ScarceMemory() { refusedFrom = SIZE_MAX; }

}  // namespace dapple
