#include "src/render/render_identity.h"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include "src/render/shared_libraries.h"
#include "src/render/version.h"

namespace dapple {

namespace {

constexpr std::string_view kLibraries = "shared libraries";
constexpr std::string_view kExtensions = "processor extensions";

/// Where both builds are portable this is of no account.
bool IsOfMachine(const std::string& name) { return name == "build" || name == "processor" || name == kExtensions; }

std::vector<std::string> Items(std::string_view list) {
  constexpr std::string_view kComma = ", ";
  std::vector<std::string> items;
  while (!list.empty()) {
    const size_t end = std::min(list.find(kComma), list.size());
    items.emplace_back(list.substr(0, end));
    list.remove_prefix(std::min(end + kComma.size(), list.size()));
  }
  return items;
}

/// The items of the first list that are not in the second.
std::vector<std::string> Beyond(const std::string& list, const std::string& other) {
  std::vector<std::string> items = Items(list);
  const std::vector<std::string> others = Items(other);
  std::erase_if(items, [&](const std::string& item) { return std::ranges::find(others, item) != others.end(); });
  return items;
}

/// The names, without the ids, of those that only one of both has.
std::string DifferenceOfLibraries(const std::string& value, const std::string& expected) {
  std::vector<std::string> names = Beyond(value, expected);
  std::ranges::copy(Beyond(expected, value), std::back_inserter(names));
  for (std::string& name : names) name.resize(std::min(name.find(' '), name.size()));
  std::ranges::sort(names);
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return fmt::format("the installed {} {}", kLibraries, fmt::join(names, ", "));
}

std::string DifferenceOfExtensions(const std::string& value, const std::string& expected) {
  const std::vector<std::string> more = Beyond(value, expected), less = Beyond(expected, value);
  std::string text = "a processor";
  if (!more.empty()) text += fmt::format(" with {}", fmt::join(more, ", "));
  if (!less.empty()) text += fmt::format("{} without {}", more.empty() ? "" : " and", fmt::join(less, ", "));
  return text;
}

/// One difference. A hash says nothing to people, but that it differs.
std::string Difference(const std::string& name, const std::string& value, const std::string& expected) {
  if (name == "scene") return "the scene's content";
  if (name == "sources") return "the sources that the program was built of";
  if (name == "build") return "the build of the program";
  if (name == kLibraries) return DifferenceOfLibraries(value, expected);
  if (name == kExtensions) return DifferenceOfExtensions(value, expected);
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
                                                 {"sources", SourceHash()},
                                                 {"compiler", Compiler()},
                                                 {std::string(kLibraries), SharedLibraries()},
                                                 {"build", BuildId()},
                                                 {"processor", ProcessorName()},
                                                 {std::string(kExtensions), ProcessorExtensions()}});
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
