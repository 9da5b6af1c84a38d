// Numbers as people read them.
#pragma once

#include <cstdint>
#include <exception>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "src/base/error.h"
#include "src/render/error_estimate.h"

namespace dapple {

/// "0", "812", "12.3 k", "4.56 M": three digits and a prefix; `value` >= 0.
std::string FormatCount(double value);

/// "0.42 s", "12.3 s", "4:05", "3:04:05", "1e+300 s"; `seconds` >= 0.
std::string FormatDuration(double seconds);

/// "812 B", "4.56 MB" (powers of 1000).
std::string FormatBytes(double bytes);

/// "error about 3.42 % (noise 3.1 %, bias 1.4 %)", or without its bias "noise about 3.42 %".
std::string FormatError(const ErrorEstimate& error, bool isBiasKnown);

/// "1 pass", "2 passes".
std::string FormatNumberOf(int64_t count, std::string_view one, std::string_view many);

/// Writes a line to the error stream. Where nobody reads it any more (a broken pipe) nothing happens: a render is not
/// lost for want of a listener.
void Tell(const std::string& line);

/// Writes to the standard output. That it failed is told when the program ends (main.cpp), and costs nothing before.
void Print(const std::string& text);

/// What went wrong as the one line that is told of it; `place`: where, if the error does not say so itself.
std::string ErrorLine(const std::exception& error, const FileLocation& place = {});

/// Calls `write`, which makes the file `path`. False, with a word, where it fails: what else is to be written still can
/// be.
template <typename F>
bool TryToWrite(const std::string& path, F write) {
  try {
    write();
    return true;
  } catch (const std::exception& error) {
    Tell(ErrorLine(error, FileLocation(path)));
    return false;
  }
}

}  // namespace dapple
