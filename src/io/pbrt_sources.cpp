#include "src/io/pbrt_sources.h"

#include <fmt/format.h>

#include "src/io/text_file.h"

namespace dapple {

namespace {

constexpr std::size_t kDeepest = 64, kMostFiles = 100'000;

PbrtSources::Source MakeSource(std::string text, const std::string& name) {
  // The heap keeps the text in place while the stack of sources grows.
  PbrtSources::Source source;
  source.diskBytes = text.size();
  source.text = std::make_unique<const std::string>(std::move(text));
  source.lexer = std::make_unique<PbrtLexer>(*source.text, std::make_shared<const std::string>(name));
  return source;
}

}  // namespace

void PbrtSources::PushText(std::string text, const std::string& name) {
  bytesRead_ += text.size();
  diskBytes_ += text.size();
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
  Source& source = stack_.back();
  source.canonicalPath = canonical;
  source.includedAt = includedAt;
  const std::uintmax_t size = std::filesystem::file_size(path, failure);
  source.diskBytes = failure ? 0 : size;
  bytesRead_ += source.text->size();
  if (onDisk_.insert(canonical.string()).second) diskBytes_ += source.diskBytes;
  CheckLimits(includedAt);
  return source;
}

void PbrtSources::CheckLimits(const FileLocation& includedAt) const {
  std::uintmax_t open = 0, openOnDisk = 0;
  for (const Source& source : stack_) {
    open += source.text->size();
    openOnDisk += source.diskBytes;
  }
  const auto check = [&](std::uintmax_t text, std::uintmax_t onDisk, std::uintmax_t anyway, std::string_view which) {
    if (text > anyway + limits_.mostOfDisk * onDisk)
      throw Error(includedAt, fmt::format("the text of all files that {} takes more than {} MB and {} times what lies "
                                          "on disk",
                                          which, anyway >> 20, limits_.mostOfDisk));
  };
  check(open, openOnDisk, limits_.openAnyway, "are included within each other here");
  check(bytesRead_, diskBytes_, limits_.readAnyway, "are included");
}

}  // namespace dapple
