// The memory of a photon map: when it stands, and while it is built. The process is measured from outside, so the
// figures are exact where this runs alone, as ctest has it; memory that earlier tests left to the allocator makes them
// smaller.
#include <array>
#include <random>
#include <string>

#include <gtest/gtest.h>
#include <malloc.h>

#include "src/photons/photon_map.h"
#include "tests/support/process_memory.h"
#include "tests/support/sanitizers.h"

namespace dapple {
namespace {

using testing_support::ForgetPeak;
using testing_support::ProcessBytes;

TEST(PhotonMemory, AMillionPhotonsTake64MegabytesAtMost) {
  if (testing_support::kIsSanitized) GTEST_SKIP() << "the sanitizer has memory of its own";
  using Payload = std::array<float, 7>;  // flux, two directions, flags
  constexpr size_t kCount = 1000000;
  mallopt(M_MMAP_THRESHOLD, 1 << 20);  // what is freed goes back to the system
  { const PhotonMap<Payload> warm(std::vector<Vec3>(100000, Vec3(1)), std::vector<Payload>(100000)); }
  malloc_trim(0);

  const int64_t before = ProcessBytes("VmRSS");
  std::vector<Vec3> positions(kCount);
  std::vector<Payload> payloads(kCount);
  std::mt19937 random(1);
  std::uniform_real_distribution<float> uniform(-1, 1);
  for (Vec3& p : positions) p = {uniform(random), uniform(random), uniform(random)};
  if (!ForgetPeak()) GTEST_SKIP() << "this system does not tell the peak of a part of a program";
  const PhotonMap<Payload> map(std::move(positions), std::move(payloads));
  const int64_t peak = ProcessBytes("VmHWM") - before, after = ProcessBytes("VmRSS") - before;

  RecordProperty("bytesPerPhoton", std::to_string(static_cast<double>(map.MemoryBytes()) / kCount));
  RecordProperty("peakBytes", std::to_string(peak));
  constexpr double kBytesPerPhoton = 12 + sizeof(Payload) + 9;
  EXPECT_LT(static_cast<double>(map.MemoryBytes()), kBytesPerPhoton * kCount);
  // It takes no more than it says, but for the allocator's own.
  EXPECT_LT(static_cast<double>(after), 1.05 * static_cast<double>(map.MemoryBytes()));
  EXPECT_LT(peak, 64000000);
}

}  // namespace
}  // namespace dapple
