// The one door to oneTBB: loops over fixed chunks, so that no result depends on the number of threads.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

namespace dapple {

/// Calls `body(begin, end)` for the ranges that cut [0, count) into chunks of `chunkSize`, in parallel and in any
/// order. The cut depends on the two numbers alone. Exceptions of `body` are passed on.
void ParallelForChunks(int64_t count, int64_t chunkSize, const std::function<void(int64_t begin, int64_t end)>& body);

/// Calls `body(i)` for each i in [0, count), in parallel.
inline void ParallelFor(int64_t count, const std::function<void(int64_t i)>& body) {
  ParallelForChunks(count, 1, [&](int64_t begin, int64_t) { body(begin); });
}

/// Bounds the threads of all parallel loops while it lives; 0 means one a processor.
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads);
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

 private:
  struct Control;
  std::unique_ptr<Control> control_;
};

/// How many threads a parallel loop may use now.
int ThreadCount();

}  // namespace dapple
