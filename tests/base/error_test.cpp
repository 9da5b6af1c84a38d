#include "src/base/error.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace dapple {
namespace {

TEST(FileLocation, ReadsAsEditorsExpect) {
  EXPECT_EQ(FileLocation(std::make_shared<const std::string>("scene.pbrt"), 12, 8).ToString(), "scene.pbrt:12:8");
  EXPECT_EQ(FileLocation("scene.pbrt").ToString(), "scene.pbrt");
  EXPECT_EQ(FileLocation().ToString(), "");
}

TEST(Error, SaysPlaceAndMessage) {
  const FileLocation location(std::make_shared<const std::string>("a.pbrt"), 3, 4);
  const Error error(location, "expected a number");
  EXPECT_STREQ(error.what(), "a.pbrt:3:4: error: expected a number");
  EXPECT_EQ(error.Location().line, 3);
  EXPECT_STREQ(Error("no scene: expected a file name").what(), "error: no scene: expected a file name");
  EXPECT_THROW(throw Error("x"), std::runtime_error);
}

// Messages hold what users wrote: braces and percent signs are no format.
TEST(Error, TextIsTakenAsItIs) {
  EXPECT_STREQ(Error(FileLocation("{}%s"), "{0} %d {").what(), "{}%s: error: {0} %d {");
}

TEST(Diagnostics, PassesEachWarningOnOnce) {
  std::vector<std::string> lines;
  Diagnostics diagnostics([&](const std::string& line) { lines.push_back(line); });
  const auto file = std::make_shared<const std::string>("a.pbrt");
  diagnostics.Warn({file, 1, 2}, "unknown parameter \"x\"");
  diagnostics.Warn({file, 1, 2}, "unknown parameter \"x\"");
  diagnostics.Warn({file, 2, 2}, "unknown parameter \"x\"");
  diagnostics.Warn({}, "general");
  EXPECT_EQ(lines, (std::vector<std::string>{"a.pbrt:1:2: warning: unknown parameter \"x\"",
                                             "a.pbrt:2:2: warning: unknown parameter \"x\"", "warning: general"}));
  EXPECT_EQ(diagnostics.WarningCount(), 3);
}

}  // namespace
}  // namespace dapple
