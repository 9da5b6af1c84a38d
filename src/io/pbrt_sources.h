// The stack of files that a scene is read from: the main file and, on top of it, what it includes.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "src/base/error.h"
#include "src/io/pbrt_lexer.h"

namespace dapple {

class PbrtSources {
 public:
  /// A text that is being read.
  struct Source {
    std::unique_ptr<const std::string> text;
    std::filesystem::path canonicalPath;  ///< Empty: text from memory.
    std::unique_ptr<PbrtLexer> lexer;
    bool isImport = false;
    std::size_t blockCount = 0;  ///< Blocks that were open where the file was imported.
    FileLocation includedAt;
  };

  /// Text from memory; `name` stands in messages.
  void PushText(std::string text, const std::string& name);
  /// A file, decompressed where needed. Throws Error at `includedAt` where it cannot be read, is being read already, or
  /// lies deeper than 64 files, or is the 100,001st: files that include each other twice, 64 deep, would never end.
  Source& PushFile(const std::filesystem::path& path, const FileLocation& includedAt);

  /// The text that is read now is on top; there must be one for `Top` and `Pop`.
  bool IsEmpty() const { return stack_.empty(); }
  Source& Top() { return stack_.back(); }
  void Pop() { stack_.pop_back(); }

 private:
  std::vector<Source> stack_;
  std::size_t fileCount_ = 0;
};

}  // namespace dapple
