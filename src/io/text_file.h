// Whole files as text: plain or gzipped (told by their first bytes, not by their names); and numbers in text.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "src/base/error.h"

namespace dapple {

/// The bytes of a file, decompressed where it is gzip (several members too). Throws Error where it is missing, no
/// regular file, unreadable, damaged, or inflates to more than 64 MB and 100 times its size; `namedAt` is the place
/// that names the file.
std::string ReadTextFile(const std::filesystem::path& path, const FileLocation& namedAt = {});

enum class NumberStatus { Ok, Malformed, Overflow };

/// Reads the decimal number at `begin` ("+1", "-.5", "1e-3"; no hex, no "inf", no "nan"), no further than `last`;
/// `*end` is set behind it. What is too small for a double becomes zero; what is too large is Overflow.
NumberStatus ParseNumber(const char* begin, const char* last, double* value, const char** end);

/// `text` fit for a message: quoted, cut behind `longest` bytes, what is not printable as \xNN.
std::string Quoted(std::string_view text, std::size_t longest = 40);

}  // namespace dapple
