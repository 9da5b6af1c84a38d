// Which known name did the user mean? For messages about misspelled directives, parameters and names.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace dapple {

/// The candidate at the least edit distance (insert, delete, replace or swap neighbours; upper and lower case are one),
/// the first of equals; "" where none is near: at most a third of the word's length, at least 1.
std::string NearestName(std::string_view word, const std::vector<std::string>& candidates);

/// '; did you mean "radius"?', or "" where no candidate is near.
std::string DidYouMean(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace dapple
