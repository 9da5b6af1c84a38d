#include "src/base/error.h"

#include <fmt/format.h>

namespace dapple {

namespace {

std::string Line(const FileLocation& location, std::string_view kind, std::string_view message) {
  const std::string place = location.ToString();
  return place.empty() ? fmt::format("{}: {}", kind, message) : fmt::format("{}: {}: {}", place, kind, message);
}

}  // namespace

std::string FileLocation::ToString() const {
  if (!file) return "";
  return line > 0 ? fmt::format("{}:{}:{}", *file, line, column) : *file;
}

Error::Error(const FileLocation& location, const std::string& message)
    : std::runtime_error(Line(location, "error", message)), location_(location) {}

void Diagnostics::Warn(const FileLocation& location, std::string_view message) {
  std::string line = Line(location, "warning", message);
  const auto [entry, isNew] = seen_.insert(std::move(line));
  if (isNew) sink_(*entry);
}

}  // namespace dapple
