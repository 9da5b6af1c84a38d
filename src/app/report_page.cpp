#include "src/app/report_page.h"

#include <cassert>
#include <cstdint>

#include <nlohmann/json.hpp>

#include "src/render/json_text.h"

namespace dapple {

namespace {

/// RFC 4648, with padding.
std::string Base64(std::string_view bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (size_t i = 0; i < bytes.size(); i += 3) {
    const size_t count = std::min<size_t>(3, bytes.size() - i);
    uint32_t group = 0;
    for (size_t k = 0; k < 3; ++k) group = group << 8 | (k < count ? static_cast<uint8_t>(bytes[i + k]) : 0u);
    for (size_t k = 0; k < 4; ++k) text += k <= count ? kDigits[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

void Replace(std::string* text, std::string_view mark, std::string_view content) {
  const size_t at = text->find(mark);
  assert(at != std::string::npos);
  text->replace(at, mark.size(), content);
}

/// JSON that may stand in a script element: no "</" ends it early.
std::string ToScriptText(const nlohmann::ordered_json& data) {
  std::string text = DumpJson(data);
  for (size_t i = 0; (i = text.find("</", i)) != std::string::npos; i += 3) text.insert(i + 1, 1, '\\');
  return text;
}

}  // namespace

std::string PngUrl(std::string_view png) { return "data:image/png;base64," + Base64(png); }

std::string ReportPage(const nlohmann::ordered_json& data) {
  std::string page(ReportFile("report.html"));
  Replace(&page, "@STYLE@", ReportFile("report.css"));
  Replace(&page, "@SCRIPT@", ReportFile("report.js"));
  Replace(&page, "@DATA@", ToScriptText(data));  // last: names in it may look like marks
  return page;
}

}  // namespace dapple
