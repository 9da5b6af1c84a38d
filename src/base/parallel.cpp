#include "src/base/parallel.h"

#include <algorithm>

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#if defined(DAPPLE_THREAD_SANITIZER)
#include <sanitizer/tsan_interface.h>
#endif

namespace dapple {

namespace {

/// Tells the thread sanitizer what TBB takes care of, whose code it does not see (nor this file's, where TBB's
/// templates become code: see CMakeLists.txt): what was written before a loop is seen in its bodies, and what these
/// write is seen behind it, also where one of them throws. Without a thread sanitizer it is nothing.
class LoopOrder {
 public:
#if defined(DAPPLE_THREAD_SANITIZER)
  LoopOrder() { __tsan_release(&begin_); }
  ~LoopOrder() { __tsan_acquire(&end_); }
#endif

  /// Lives as long as a body runs.
  class Body {
   public:
#if defined(DAPPLE_THREAD_SANITIZER)
    explicit Body(LoopOrder& loop) : loop_(loop) { __tsan_acquire(&loop.begin_); }
    ~Body() { __tsan_release(&loop_.end_); }

   private:
    LoopOrder& loop_;
#else
    explicit Body(LoopOrder&) {}
#endif
  };

#if defined(DAPPLE_THREAD_SANITIZER)
 private:
  char begin_ = 0, end_ = 0;
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
          [[maybe_unused]] const LoopOrder::Body running(order);
          for (int64_t chunk = range.begin(); chunk != range.end(); ++chunk)
            body(chunk * chunkSize, std::min(count, (chunk + 1) * chunkSize));
        },
        tbb::simple_partitioner());
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
