// The stack of files that a scene is read from: the main file and, on top of it, what it includes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <unordered_set>
#include <vector>

#include "src/base/error.h"
#include "src/io/pbrt_lexer.h"

namespace dapple {

/// How much text there may be for what lies on disk. Gzip shrinks scenes to a tenth or so, and a file made to fill the
/// memory to a thousandth. A small file may be included some thousand times, at a megabyte each; reading that takes a
/// minute or so.
struct TextLimits {
  std::uintmax_t openAnyway = std::uintmax_t{64} << 20;  ///< Bytes of the files that are being read, however small.
  std::uintmax_t readAnyway = std::uintmax_t{4} << 30;   ///< Bytes of all files that were read.
  std::uintmax_t mostOfDisk = 100;                       ///< For each byte on disk, beyond these.
};

class PbrtSources {
 public:
  explicit PbrtSources(const TextLimits& limits = {}) : limits_(limits) {}

  /// A text that is being read.
  struct Source {
    std::unique_ptr<const std::string> text;
    std::filesystem::path canonicalPath;  ///< Empty: text from memory.
    std::uintmax_t diskBytes = 0;         ///< Of the file; of text from memory its own.
    std::unique_ptr<PbrtLexer> lexer;
    bool isImport = false;
    std::size_t blockCount = 0;  ///< Blocks that were open where the file was imported.
    FileLocation includedAt;
  };

  /// Text from memory; `name` stands in messages.
  void PushText(std::string text, const std::string& name);
  /// A file, decompressed where needed. Throws Error at `includedAt` where it cannot be read, is being read already, or
  /// lies deeper than 64 files, is the 100,001st (files that include each other twice, 64 deep, would never end), or
  /// goes beyond the limits: of all files that are open, and of all that were read, where a file that is included twice
  /// is read twice and lies on disk once.
  Source& PushFile(const std::filesystem::path& path, const FileLocation& includedAt);

  /// The text that is read now is on top; there must be one for `Top` and `Pop`.
  bool IsEmpty() const { return stack_.empty(); }
  Source& Top() { return stack_.back(); }
  void Pop() { stack_.pop_back(); }

  /// Bytes of all text that was given so far.
  std::uintmax_t BytesRead() const { return bytesRead_; }

 private:
  void CheckLimits(const FileLocation& includedAt) const;

  TextLimits limits_;
  std::vector<Source> stack_;
  std::size_t fileCount_ = 0;
  std::uintmax_t bytesRead_ = 0, diskBytes_ = 0;
  std::unordered_set<std::string> onDisk_;  ///< Canonical paths of the files in `diskBytes_`.
};

}  // namespace dapple
