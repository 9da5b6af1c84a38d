#include "src/io/pbrt_sources.h"

#include <fmt/format.h>

#include "src/io/text_file.h"

namespace dapple {

namespace {

constexpr std::size_t kDeepest = 64, kMostFiles = 100'000;

PbrtSources::Source MakeSource(std::string text, const std::string& name) {
  // The heap keeps the text in place while the stack of sources grows.
  PbrtSources::Source source;
  source.text = std::make_unique<const std::string>(std::move(text));
  source.lexer = std::make_unique<PbrtLexer>(*source.text, std::make_shared<const std::string>(name));
  return source;
}

}  // namespace

void PbrtSources::PushText(std::string text, const std::string& name) {
  stack_.push_back(MakeSource(std::move(text), name));
}

PbrtSources::Source& PbrtSources::PushFile(const std::filesystem::path& path, const FileLocation& includedAt) {
  std::error_code failure;
  const std::filesystem::path canonical = std::filesystem::weakly_canonical(path, failure);
  for (const Source& source : stack_)
    if (!canonical.empty() && source.canonicalPath == canonical)
      throw Error(includedAt, fmt::format("{} includes itself", path.string()));
  if (stack_.size() >= kDeepest) throw Error(includedAt, fmt::format("files are included more than {} deep", kDeepest));
  if (++fileCount_ > kMostFiles) throw Error(includedAt, fmt::format("more than {} files are included", kMostFiles));
  stack_.push_back(MakeSource(ReadTextFile(path, includedAt), path.string()));
  stack_.back().canonicalPath = canonical;
  stack_.back().includedAt = includedAt;
  return stack_.back();
}

}  // namespace dapple
