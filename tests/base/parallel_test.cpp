#include "src/base/parallel.h"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace dapple {
namespace {

using Range = std::pair<int64_t, int64_t>;

std::vector<Range> ChunksOf(int64_t count, int64_t chunkSize) {
  std::mutex mutex;
  std::vector<Range> chunks;
  ParallelForChunks(count, chunkSize, [&](int64_t begin, int64_t end) {
    const std::lock_guard lock(mutex);
    chunks.emplace_back(begin, end);
  });
  std::sort(chunks.begin(), chunks.end());
  return chunks;
}

TEST(ParallelForChunks, CutsEveryRangeOnceWhateverTheThreads) {
  for (const int threads : {1, 2, 3, 8}) {
    const ThreadLimit limit(threads);
    EXPECT_EQ(ChunksOf(10, 4), (std::vector<Range>{{0, 4}, {4, 8}, {8, 10}}));
    EXPECT_EQ(ChunksOf(8, 4), (std::vector<Range>{{0, 4}, {4, 8}}));
    EXPECT_EQ(ChunksOf(3, 100), (std::vector<Range>{{0, 3}}));
    EXPECT_TRUE(ChunksOf(0, 4).empty());
    EXPECT_EQ(ChunksOf(1000, 1).size(), 1000u);
  }
}

TEST(ParallelFor, VisitsEachIndexOnce) {
  std::vector<std::atomic<int>> visits(10007);
  ParallelFor(static_cast<int64_t>(visits.size()), [&](int64_t i) { ++visits[static_cast<size_t>(i)]; });
  EXPECT_TRUE(std::all_of(visits.begin(), visits.end(), [](const auto& v) { return v == 1; }));
}

TEST(ParallelFor, LoopsInLoopsEnd) {
  std::atomic<int> sum = 0;
  ParallelFor(20, [&](int64_t) { ParallelFor(30, [&](int64_t) { ++sum; }); });
  EXPECT_EQ(sum, 600);
}

TEST(ParallelFor, ExceptionsReachTheCaller) {
  EXPECT_THROW(ParallelFor(1000,
                           [](int64_t i) {
                             if (i == 777) throw std::runtime_error("x");
                           }),
               std::runtime_error);
  std::atomic<int> after = 0;
  ParallelFor(10, [&](int64_t) { ++after; });
  EXPECT_EQ(after, 10);
}

TEST(ThreadLimit, BoundsTheThreadsWhileItLives) {
  const int before = ThreadCount();
  EXPECT_GE(before, 1);
  {
    const ThreadLimit one(1);
    EXPECT_EQ(ThreadCount(), 1);
    std::mutex mutex;
    std::set<std::thread::id> threads;
    ParallelFor(1000, [&](int64_t) {
      const std::lock_guard lock(mutex);
      threads.insert(std::this_thread::get_id());
    });
    EXPECT_EQ(threads.size(), 1u);
  }
  EXPECT_EQ(ThreadCount(), before);
}

// More threads than processors are really there: their bodies wait for each other, for as long as it takes; only where
// one is missing do they give up.
TEST(ThreadLimit, MoreThreadsThanProcessors) {
  const int processors = static_cast<int>(std::thread::hardware_concurrency());
  const ThreadLimit limit(processors + 1);
  EXPECT_EQ(ThreadCount(), processors + 1);
  std::mutex mutex;
  std::set<std::thread::id> threads;
  std::atomic<int> inside = 0, most = 0;
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(2);
  ParallelFor(processors + 1, [&](int64_t) {
    most = std::max<int>(most, ++inside);
    while (most < processors + 1 && std::chrono::steady_clock::now() < deadline) {
      most = std::max<int>(most, inside);
      std::this_thread::yield();
    }
    --inside;
  });
  EXPECT_EQ(most, processors + 1);
}

TEST(ThreadLimit, ZeroMeansOneAProcessor) {
  const ThreadLimit limit(0);
  EXPECT_EQ(ThreadCount(), static_cast<int>(std::thread::hardware_concurrency()));
}

}  // namespace
}  // namespace dapple
