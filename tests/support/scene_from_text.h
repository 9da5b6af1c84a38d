// A scene from pbrt text in a test; any warning fails the test.
#pragma once

#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "src/io/build_scene.h"
#include "src/io/pbrt_parser.h"

namespace dapple::testing_support {

inline std::unique_ptr<Scene> SceneFromText(const std::string& text, int pbrtVersion = 3) {
  Diagnostics diagnostics([](const std::string& line) { ADD_FAILURE() << line; });
  return BuildScene(ParsePbrtString(text, "test.pbrt", ".", {pbrtVersion}, diagnostics), {}, diagnostics);
}

}  // namespace dapple::testing_support
