#include "src/app/render_outputs.h"

#include <algorithm>

#include "src/app/format.h"
#include "src/render/statistics.h"

namespace dapple {

bool HoldsLayers(const std::string& path) { return LowerCaseExtension(path) == ".exr"; }

std::string CheckPictureName(const std::string& path) {
  if (HoldsLayers(path) || LowerCaseExtension(path) == ".png") return "";
  return fmt::format("expected a file name that ends in .exr or .png, not '{}'", path);
}

std::string CheckResultName(const std::string& path) {
  if (IsStateName(path) || CheckPictureName(path).empty()) return "";
  return fmt::format("expected a file name that ends in .exr, .png or .dapple, not '{}'", path);
}

void CheckRenderOutput(const std::string& path) {
  if (IsStateName(path)) return CheckFolder(path);
  CheckOutput(path);
}

WrittenOutputs WriteRenderOutputs(const std::vector<std::string>& paths, const RenderOrigin& origin,
                                  const RenderRecord& record, const Film& film) {
  WrittenOutputs written;
  std::optional<Image> picture;
  const auto write = [&](const std::string& path) {
    if (IsStateName(path)) return WriteState(path, origin, film);
    if (!picture) picture = ToPicture(film, origin.exposure, origin.aovs);
    WriteOutput(path, *picture, ToMetadata(record));
  };
  for (const std::string& path : paths) {
    try {
      write(path);
      written.paths.push_back(path);
    } catch (const std::exception& error) {
      written.errors.push_back(ErrorLine(error, FileLocation(path)));
    }
  }
  return written;
}

void WarnOfNonFinite(const Film& film) {
  if (film.NonFiniteCount() == 0) return;
  Tell(fmt::format("warning: {} left out: infinite, not a number, or too large: {}",
                   FormatNumberOf(film.NonFiniteCount(), "contribution was", "contributions were"),
                   DescribeNonFinite(film)));
}

void WarnOfVariance(const std::vector<std::string>& paths, const AovSet& aovs, const Film& film) {
  if (!aovs.variance || film.PassCount() > 1 || std::ranges::none_of(paths, HoldsLayers)) return;
  Tell("warning: the layer of variance is 0 all over: one pass does not tell it, two do");
}

}  // namespace dapple
