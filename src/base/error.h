// Errors that a user can cause, warnings, and the place in a file that they speak of.
//
// An `Error` is thrown where the work cannot go on; a `Diagnostics` collects warnings, so that the caller decides where
// they are shown. Both read "scene.pbrt:12:8: error: ...", the form that editors and compilers share.
#pragma once

#include <functional>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>

namespace dapple {

/// A place in a text file; line and column count from 1, in bytes. Line 0: the file as a whole. No file: no place.
struct FileLocation {
  std::shared_ptr<const std::string> file;
  int line = 0;
  int column = 0;

  FileLocation() = default;
  FileLocation(std::shared_ptr<const std::string> f, int l, int c) : file(std::move(f)), line(l), column(c) {}
  /// A file as a whole.
  explicit FileLocation(std::string name) : file(std::make_shared<const std::string>(std::move(name))) {}

  /// "scene.pbrt:12:8", "scene.pbrt" or "".
  std::string ToString() const;
};

/// An error that a user can cause and mend. `what()` is the whole line: place, "error:", what was expected.
class Error : public std::runtime_error {
 public:
  explicit Error(const std::string& message) : Error(FileLocation(), message) {}
  Error(const FileLocation& location, const std::string& message);

  const FileLocation& Location() const { return location_; }

 private:
  FileLocation location_;
};

/// Receives warnings. A warning of the same text and place is passed on once.
class Diagnostics {
 public:
  using Sink = std::function<void(const std::string& line)>;

  /// `sink` receives each line ("scene.pbrt:12:8: warning: ..."), without a line end.
  explicit Diagnostics(Sink sink) : sink_(std::move(sink)) {}

  void Warn(const FileLocation& location, std::string_view message);
  int WarningCount() const { return static_cast<int>(seen_.size()); }

 private:
  Sink sink_;
  std::set<std::string> seen_;
};

}  // namespace dapple
