// The layers of the design, held by a test: no file includes a layer above its own.
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace dapple {
namespace {

namespace fs = std::filesystem;

// Each layer with those directly below it, as CMakeLists.txt links them.
const std::map<std::string, std::vector<std::string>>& DirectlyBelow() {
  static const std::map<std::string, std::vector<std::string>> below{
      {"src/base", {}},
      {"src/sampling", {"src/base"}},
      {"src/image", {"src/sampling"}},
      {"src/geometry", {"src/sampling"}},
      {"src/materials", {"src/geometry", "src/image"}},
      {"lights", {"src/materials"}},
      {"src/scene", {"lights"}},
      {"src/photons", {"src/scene"}},
      {"src/io", {"src/scene"}},
      {"integrators", {"src/photons"}},
      {"src/render", {"integrators"}},
      {"src/app", {"src/render", "src/io"}},
  };
  return below;
}

/// The layer itself and all that lie below it.
std::set<std::string> Reachable(const std::string& layer) {
  std::set<std::string> reachable{layer};
  for (const std::string& below : DirectlyBelow().at(layer)) reachable.merge(Reachable(below));
  return reachable;
}

std::string LayerOf(const std::string& includePath) { return fs::path(includePath).parent_path().generic_string(); }

/// The project's files that `file` includes, as written.
std::vector<std::string> Includes(const fs::path& file) {
  static const std::regex kInclude("^\\s*#\\s*include\\s*\"([^\"]+)\"");
  std::vector<std::string> includes;
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    std::smatch match;
    if (std::regex_search(line, match, kInclude)) includes.push_back(match[1]);
  }
  return includes;
}

TEST(Layers, NoFileIncludesALayerAboveItsOwn) {
  const fs::path root = DAPPLE_SOURCE_DIR;
  int files = 0, includes = 0;
  for (const auto& [layer, below] : DirectlyBelow()) {
    const std::set<std::string> allowed = Reachable(layer);
    for (const auto& entry : fs::directory_iterator(root / layer)) {
      if (!entry.is_regular_file()) continue;
      ++files;
      for (const std::string& include : Includes(entry.path())) {
        ++includes;
        EXPECT_TRUE(allowed.contains(LayerOf(include))) << entry.path() << " includes \"" << include << '"';
        EXPECT_TRUE(fs::exists(root / include)) << entry.path() << " includes \"" << include << '"';
      }
    }
  }
  EXPECT_GT(files, 50);
  EXPECT_GT(includes, 100) << "the test must see what it judges";
}

TEST(Layers, EachFolderOfSourcesIsALayer) {
  const fs::path root = DAPPLE_SOURCE_DIR;
  for (const auto& entry : fs::recursive_directory_iterator(root / "src")) {
    const std::string extension = entry.path().extension();
    if (!entry.is_regular_file() || (extension != ".cpp" && extension != ".h")) continue;  // other files are data
    const std::string folder = fs::relative(entry.path().parent_path(), root).generic_string();
    EXPECT_TRUE(DirectlyBelow().contains(folder)) << entry.path();
  }
}

}  // namespace
}  // namespace dapple
