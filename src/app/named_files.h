// The files that one command names: what it writes must not replace what it reads, nor something else that it writes.
#pragma once

#include <string>
#include <vector>

namespace dapple {

/// A file, and what it is to the command, as its user calls it: "--stats", "the scene".
struct NamedFile {
  std::string role;
  std::string path;
};

/// "--stats and the scene are one file: 'box.pbrt'" of the first of `written` that is another of them, or one of
/// `read`, by whatever path; empty where there is none.
std::string FindClash(const std::vector<NamedFile>& written, const std::vector<NamedFile>& read);

/// The same of the snapshots of `outputs`, whatever their passes (src/render/snapshots.h): none may be one of `others`.
std::string FindSnapshotClash(const std::vector<std::string>& outputs, const std::vector<NamedFile>& others);

/// Throws `CLI::ValidationError`, wrong usage, where there is a clash.
void RequireNoClash(const std::vector<NamedFile>& written, const std::vector<NamedFile>& read);

/// `role` for each of the paths.
std::vector<NamedFile> NamedFiles(const std::string& role, const std::vector<std::string>& paths);

}  // namespace dapple
