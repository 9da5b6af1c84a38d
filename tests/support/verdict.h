// What a check found. Checks give verdicts where the tests assert that one is good, and the mutation suite that it is
// bad where a fault was planted.
#pragma once

#include <string>

namespace dapple {

struct Verdict {
  bool passes = true;
  std::string message;
};

}  // namespace dapple
