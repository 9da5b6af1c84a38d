#include "src/base/parallel.h"

#include <algorithm>

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#if defined(__SANITIZE_THREAD__)
#include <sanitizer/tsan_interface.h>
#endif

namespace dapple {

namespace {

/// Tells the thread sanitizer what TBB, whose code it does not see, takes care of: what was written before a loop is
/// seen in its bodies, and what these write is seen behind it. Without a thread sanitizer it is nothing.
class LoopOrder {
 public:
#if defined(__SANITIZE_THREAD__)
  LoopOrder() { __tsan_release(&begin_); }
  void BeginBody() { __tsan_acquire(&begin_); }
  void EndBody() { __tsan_release(&end_); }
  void Join() { __tsan_acquire(&end_); }

 private:
  char begin_ = 0, end_ = 0;
#else
  void BeginBody() {}
  void EndBody() {}
  void Join() {}
#endif
};

}  // namespace

void ParallelForChunks(int64_t count, int64_t chunkSize, const std::function<void(int64_t, int64_t)>& body) {
  const int64_t chunks = (count + chunkSize - 1) / chunkSize;
  LoopOrder order;
  const auto loop = [&] {
    tbb::parallel_for(
        tbb::blocked_range<int64_t>(0, chunks, 1),
        [&](const tbb::blocked_range<int64_t>& range) {
          order.BeginBody();
          for (int64_t chunk = range.begin(); chunk != range.end(); ++chunk)
            body(chunk * chunkSize, std::min(count, (chunk + 1) * chunkSize));
          order.EndBody();
        },
        tbb::simple_partitioner());
    order.Join();
  };
  // TBB's own arena has one place a processor; where more threads are asked for, the loop needs a larger one.
  if (ThreadCount() <= tbb::this_task_arena::max_concurrency()) return loop();
  tbb::task_arena(ThreadCount()).execute(loop);
}

struct ThreadLimit::Control {
  tbb::global_control control;
};

// Where more threads are asked for than there are processors, TBB needs a stated limit above its default.
ThreadLimit::ThreadLimit(int threads)
    : control_(new Control{
          tbb::global_control(tbb::global_control::max_allowed_parallelism,
                              static_cast<size_t>(threads > 0 ? threads : tbb::info::default_concurrency()))}) {}

ThreadLimit::~ThreadLimit() = default;

int ThreadCount() {
  return static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

}  // namespace dapple
