// The report of `dapple converge` as one page that needs nothing else: src/app/report/ filled with the data.
#pragma once

#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

namespace dapple {

/// A file of src/app/report/, as it was when the program was built; empty for an unknown name.
std::string_view ReportFile(std::string_view name);

/// "data:image/png;base64,..." for the bytes of a PNG file.
std::string PngUrl(std::string_view png);

/// The page: report.html with style, script and `data` (as `ConvergenceToJson`, with "pictures" in each scene) in it.
std::string ReportPage(const nlohmann::ordered_json& data);

}  // namespace dapple
