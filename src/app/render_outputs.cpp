#include "src/app/render_outputs.h"

#include "src/app/format.h"
#include "src/render/statistics.h"

namespace dapple {

void CheckRenderOutput(const std::string& path) {
  if (IsStateName(path)) return CheckFolder(path);
  CheckOutput(path);
}

void WriteRenderOutputs(const std::vector<std::string>& paths, const RenderOrigin& origin, const RenderRecord& record,
                        const Film& film) {
  std::optional<Image> picture;
  for (const std::string& path : paths) {
    if (IsStateName(path)) {
      WriteState(path, origin, film);
      continue;
    }
    if (!picture) picture = ToPicture(film, origin.exposure, origin.aovs);
    WriteOutput(path, *picture, ToMetadata(record));
  }
}

void WarnOfNonFinite(const Film& film) {
  if (film.NonFiniteCount() == 0) return;
  Tell(fmt::format("warning: {} left out: infinite, not a number, or too large: {}",
                   FormatNumberOf(film.NonFiniteCount(), "contribution was", "contributions were"),
                   DescribeNonFinite(film)));
}

}  // namespace dapple
