#include "src/image/atomic_file.h"

#include <atomic>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
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
  OutputFile(int descriptor, fs::path path, bool removeOnFailure, const std::string& shownPath)
      : path_(std::move(path)), shownPath_(shownPath), descriptor_(descriptor), removeOnFailure_(removeOnFailure) {
    if (descriptor_ < 0) Fail(shownPath_, "cannot write the file", errno);
  }
  ~OutputFile() {
    if (removeOnFailure_) ::unlink(path_.c_str());
    if (descriptor_ >= 0) ::close(descriptor_);
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
  bool removeOnFailure_;
};

fs::path FolderOf(const fs::path& target) { return target.has_parent_path() ? target.parent_path() : fs::path("."); }

// Whether a file in the target's folder has the name of one of its temporaries: two numbers behind the target's.
bool IsTemporaryName(std::string_view name, const fs::path& target) {
  const std::string begin = fmt::format(".{}.", target.filename().string());
  constexpr std::string_view kEnd = ".tmp", kDigits = "0123456789";
  if (!name.starts_with(begin) || !name.ends_with(kEnd) || name.size() < begin.size() + kEnd.size()) return false;
  const std::string_view numbers = name.substr(begin.size(), name.size() - begin.size() - kEnd.size());
  const size_t dot = numbers.find_first_not_of(kDigits);
  return dot != 0 && dot != std::string_view::npos && dot + 1 < numbers.size() && numbers[dot] == '.' &&
         numbers.find_first_not_of(kDigits, dot + 1) == std::string_view::npos;
}

/// Held by who writes a temporary file until it is renamed or removed, or the process ends however it ends: so it tells
/// which temporaries are nobody's, to all processes whose locks the file system brings together: those of one machine,
/// in whatever container, and on most network file systems those of all machines.
bool Lock(int descriptor) { return ::flock(descriptor, LOCK_EX | LOCK_NB) == 0; }

bool IsNameOf(int descriptor, const fs::path& name) {
  struct stat opened, named;
  return ::fstat(descriptor, &opened) == 0 && ::lstat(name.c_str(), &named) == 0 && opened.st_dev == named.st_dev &&
         opened.st_ino == named.st_ino;
}

// Removes the temporary files for `target` that were left behind by processes that were killed while they wrote.
void RemoveStaleTemporaries(const fs::path& target) {
  std::error_code ignored;
  std::vector<fs::path> found;
  for (fs::directory_iterator entry(FolderOf(target), ignored); !ignored && entry != fs::directory_iterator();
       entry.increment(ignored))
    if (IsTemporaryName(entry->path().filename().string(), target)) found.push_back(entry->path());
  for (const fs::path& file : found) {
    const int descriptor = ::open(file.c_str(), O_WRONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    if (descriptor < 0) continue;
    // Since it was opened it may have been renamed, and another have its name.
    if (Lock(descriptor) && IsNameOf(descriptor, file)) ::unlink(file.c_str());
    ::close(descriptor);
  }
}

// A new file in the target's folder, locked; -1 and errno where there can be none.
int OpenTemporary(const fs::path& target, fs::path* name) {
  static std::atomic<int64_t> number = 0;  // none is used twice
  for (;;) {
    *name = target.parent_path() / fmt::format(".{}.{}.{}.tmp", target.filename().string(), ::getpid(), number++);
    const int descriptor = ::open(name->c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor < 0 && errno == EEXIST) continue;
    if (descriptor < 0) return -1;
    // Another process may take it for stale before the lock is held. Where there are no locks nobody takes it for
    // stale.
    if ((Lock(descriptor) || errno != EWOULDBLOCK) && IsNameOf(descriptor, *name)) return descriptor;
    ::close(descriptor);
  }
}

OutputFile MakeTemporary(const fs::path& target, const std::string& shownPath) {
  RemoveStaleTemporaries(target);
  fs::path name;
  const int descriptor = OpenTemporary(target, &name);
  return OutputFile(descriptor, std::move(name), /*removeOnFailure=*/true, shownPath);
}

/// A device, a pipe: what can be written to, and not replaced.
bool IsDevice(const fs::file_status& status) { return fs::exists(status) && !fs::is_regular_file(status); }

/// Where links lead, whether something is there or not.
fs::path TargetOf(const std::string& path) {
  constexpr int kMostLinks = 40;
  fs::path target = path;
  std::error_code failure;
  for (int links = 0; fs::is_symlink(fs::symlink_status(target, failure)); ++links) {
    if (links == kMostLinks) Fail(path, "cannot write the file", ELOOP);
    target = target.parent_path() / fs::read_symlink(target, failure);
    if (failure) Fail(path, "cannot write the file", failure.value());
  }
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
    OutputFile file(::open(path.c_str(), O_WRONLY | O_CLOEXEC), path, /*removeOnFailure=*/false, path);
    for (const std::string_view piece : pieces) file.Write(piece);
    return file.Close();
  }
  const fs::path target = TargetOf(path);
  OutputFile file = MakeTemporary(target, path);
  for (const std::string_view piece : pieces) file.Write(piece);
  file.Flush();
  file.RenameTo(target);
  FlushFolder(target);
}

void CheckWritable(const std::string& path) {
  std::error_code failure;
  const fs::file_status status = fs::status(path, failure);
  if (fs::is_directory(status)) Fail(path, "cannot write the file", EISDIR);
  if (!IsDevice(status)) MakeTemporary(TargetOf(path), path);
}

}  // namespace dapple
