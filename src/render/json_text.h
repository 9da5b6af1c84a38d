// JSON as text, for all files and lines of JSON that Dapple writes.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace dapple {

/// In one line, or with that many spaces for each level. Names of files may hold any bytes: what is not UTF-8 becomes
/// U+FFFD, so that no render is lost to its name. Numbers that JSON does not have become null.
std::string DumpJson(const nlohmann::ordered_json& json, int indent = -1);

}  // namespace dapple
