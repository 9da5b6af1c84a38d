// How this program was called.
#pragma once

#include <string>

namespace dapple {

/// The command line of this process, as a shell would read it; empty where the system does not tell it.
std::string CommandLine();

}  // namespace dapple
