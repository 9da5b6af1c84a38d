#include "src/image/atomic_file.h"

#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include "src/base/error.h"

namespace dapple {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void Fail(const std::string& path, std::string_view what, int errorNumber) {
  throw Error(FileLocation(path), fmt::format("{}: {}", what, std::strerror(errorNumber)));
}

// An open file that is closed, and removed if it is a temporary, unless all went well.
class OutputFile {
 public:
  OutputFile(fs::path path, int flags, bool removeOnFailure, const std::string& shownPath)
      : path_(std::move(path)), shownPath_(shownPath), descriptor_(::open(path_.c_str(), flags, 0666)) {
    if (descriptor_ < 0) Fail(shownPath_, "cannot write the file", errno);
    removeOnFailure_ = removeOnFailure;
  }
  ~OutputFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
    if (removeOnFailure_) ::unlink(path_.c_str());
  }
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void Write(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) Fail(shownPath_, "cannot write the file", errno);
      bytes.remove_prefix(static_cast<size_t>(written));
    }
  }
  void Flush() {
    if (::fsync(descriptor_) != 0) Fail(shownPath_, "cannot flush the file to the disk", errno);
  }
  void Close() {
    const int result = ::close(std::exchange(descriptor_, -1));
    if (result != 0) Fail(shownPath_, "cannot close the file", errno);
  }
  void RenameTo(const fs::path& target) {
    if (::rename(path_.c_str(), target.c_str()) != 0) Fail(shownPath_, "cannot replace the file", errno);
    removeOnFailure_ = false;
  }

 private:
  fs::path path_;
  const std::string& shownPath_;
  int descriptor_;
  bool removeOnFailure_ = false;
};

fs::path FolderOf(const fs::path& target) { return target.has_parent_path() ? target.parent_path() : fs::path("."); }

// A name in the target's folder that no other process and no file there has.
fs::path TemporaryName(const fs::path& target) {
  for (int i = 0;; ++i) {
    fs::path name = target.parent_path() / fmt::format(".{}.{}.{}.tmp", target.filename().string(), ::getpid(), i);
    std::error_code ignored;
    if (!fs::exists(fs::symlink_status(name, ignored))) return name;
  }
}

// The process that a temporary file for `target` belongs to, by its name; 0 where it is none.
pid_t OwnerOf(const fs::path& temporary, const fs::path& target) {
  const std::string name = temporary.filename().string(), beginning = fmt::format(".{}.", target.filename().string());
  if (!name.starts_with(beginning) || !name.ends_with(".tmp")) return 0;
  pid_t owner = 0;
  std::from_chars(name.data() + beginning.size(), name.data() + name.size(), owner);
  return owner;
}

// Removes the temporary files for `target` that processes of this machine left behind which were killed while they
// wrote.
void RemoveStaleTemporaries(const fs::path& target) {
  std::error_code ignored;
  std::vector<fs::path> stale;
  for (const auto& entry : fs::directory_iterator(FolderOf(target), ignored)) {
    const pid_t owner = OwnerOf(entry.path(), target);
    if (owner > 0 && ::kill(owner, 0) != 0 && errno == ESRCH) stale.push_back(entry.path());
  }
  for (const fs::path& file : stale) fs::remove(file, ignored);
}

OutputFile MakeTemporary(const fs::path& target, const std::string& shownPath) {
  RemoveStaleTemporaries(target);
  return OutputFile(TemporaryName(target), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, /*removeOnFailure=*/true,
                    shownPath);
}

/// A device, a pipe: what can be written to, and not replaced.
bool IsDevice(const fs::file_status& status) { return fs::exists(status) && !fs::is_regular_file(status); }

/// Where links lead.
fs::path TargetOf(const std::string& path, const fs::file_status& status) {
  if (!fs::exists(status)) return path;
  std::error_code failure;
  const fs::path target = fs::canonical(path, failure);
  if (failure) Fail(path, "cannot write the file", failure.value());
  return target;
}

// The rename itself is durable once the folder is; some file systems cannot do this, and then nothing is lost.
void FlushFolder(const fs::path& target) {
  const int descriptor = ::open(FolderOf(target).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

}  // namespace

void WriteFileAtomically(const std::string& path, std::string_view bytes) { WriteFileAtomically(path, {bytes}); }

void WriteFileAtomically(const std::string& path, std::initializer_list<std::string_view> pieces) {
  std::error_code failure;
  const fs::file_status status = fs::status(path, failure);
  if (fs::is_directory(status)) Fail(path, "cannot write the file", EISDIR);
  if (IsDevice(status)) {
    OutputFile file(path, O_WRONLY | O_CLOEXEC, /*removeOnFailure=*/false, path);
    for (const std::string_view piece : pieces) file.Write(piece);
    return file.Close();
  }
  const fs::path target = TargetOf(path, status);
  OutputFile file = MakeTemporary(target, path);
  for (const std::string_view piece : pieces) file.Write(piece);
  file.Flush();
  file.Close();
  file.RenameTo(target);
  FlushFolder(target);
}

void CheckWritable(const std::string& path) {
  std::error_code failure;
  const fs::file_status status = fs::status(path, failure);
  if (fs::is_directory(status)) Fail(path, "cannot write the file", EISDIR);
  if (!IsDevice(status)) MakeTemporary(TargetOf(path, status), path);
}

}  // namespace dapple
