// The memory of the process, as the system sees it from outside.
#pragma once

#include <cstdint>
#include <fstream>
#include <string>

namespace dapple::testing_support {

/// A figure of the process, in bytes: VmRSS (now) or VmHWM (the peak).
inline int64_t ProcessBytes(const std::string& key) {
  std::ifstream status("/proc/self/status");
  std::string word;
  int64_t kilobytes = 0;
  while (status >> word)
    if (word == key + ":" && status >> kilobytes) return kilobytes * 1024;
  return -1;
}

/// The peak starts anew from what is in use; false where the system does not allow it.
inline bool ForgetPeak() {
  std::ofstream("/proc/self/clear_refs") << "5" << std::flush;
  return ProcessBytes("VmHWM") >= 0 && ProcessBytes("VmHWM") <= ProcessBytes("VmRSS") + (1 << 20);
}

}  // namespace dapple::testing_support
