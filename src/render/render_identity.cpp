#include "src/render/render_identity.h"

#include <fmt/format.h>

#include "src/render/version.h"

namespace dapple {

namespace {

/// Where both builds are portable this is of no account.
bool IsOfMachine(const std::string& name) { return name == "build" || name == "processor"; }

/// One difference. A hash says nothing to people, but that it differs.
std::string Difference(const std::string& name, const std::string& value, const std::string& expected) {
  if (name == "scene") return "the scene's content";
  if (name == "build") return "the build of the program";
  return fmt::format("{} {}, not {}", name, value.empty() ? "untold" : value, expected.empty() ? "told" : expected);
}

}  // namespace

std::string RenderIdentity::ValueOf(const std::string& name) const {
  for (const auto& [fieldName, value] : fields)
    if (fieldName == name) return value;
  return "";
}

RenderIdentity MakeIdentity(const SceneIdentity& scene, const Film& film, const AovSet& aovs,
                            const std::string& integrator, const IntegratorOptions& options, int seed) {
  const Vec2i& resolution = film.FullResolution();
  const PixelBounds& crop = film.Crop();
  RenderIdentity identity{{
      {"scene", scene.hash},
      {"resolution", fmt::format("{}x{}", resolution.x, resolution.y)},
      {"crop", fmt::format("{},{},{},{}", crop.min.x, crop.max.x, crop.min.y, crop.max.y)},
      {"clamp", film.Clamp() ? fmt::format("{}", *film.Clamp()) : "none"},
      {"aov", ToString(aovs)},
      {"estimate of bias", film.TracksBlur() ? "on" : "off"},
      {"integrator", integrator},
      {"seed", fmt::format("{}", seed)},
      {"environment sampling", scene.environmentSampling},
  }};
  for (auto& option : DescribeOptions(options)) identity.fields.push_back(std::move(option));
  identity.fields.insert(identity.fields.end(), {{"version", Version()},
                                                 {"instruction set", InstructionSet()},
                                                 {"build", BuildId()},
                                                 {"processor", ProcessorName()}});
  return identity;
}

std::string Differences(const RenderIdentity& other, const RenderIdentity& expected) {
  constexpr const char* kSet = "instruction set";
  const bool arePortable = IsPortable(other.ValueOf(kSet)) && IsPortable(expected.ValueOf(kSet));
  std::string text;
  const auto compare = [&](const std::string& name) {
    const std::string value = other.ValueOf(name), wanted = expected.ValueOf(name);
    if (value == wanted || (arePortable && IsOfMachine(name))) return;
    text += (text.empty() ? "" : "; ") + Difference(name, value, wanted);
  };
  for (const auto& [name, value] : expected.fields) compare(name);
  for (const auto& [name, value] : other.fields)
    if (expected.ValueOf(name).empty()) compare(name);
  return text;
}

}  // namespace dapple
