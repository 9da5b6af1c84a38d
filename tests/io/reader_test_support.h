// Shared by the tests of the scene readers: files in a folder of the test's own, messages of errors, warnings in a
// list.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <zlib.h>

#include "src/base/error.h"
#include "tests/image/temporary_folder.h"

namespace dapple {

/// `what()` of the Error that `action` throws, or "no error".
template <typename Action>
std::string MessageOf(const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

/// Collects warnings.
struct WarningList {
  std::vector<std::string> lines;
  Diagnostics diagnostics{[this](const std::string& line) { lines.push_back(line); }};
};

/// An empty folder that goes away with the object.
class TestFolder {
 public:
  std::filesystem::path Path() const { return std::filesystem::path(folder_.Path("file")).parent_path(); }

  /// Writes a file (its folders too) and gives its path.
  std::filesystem::path Write(const std::string& name, const std::string& bytes) const {
    std::filesystem::create_directories(std::filesystem::path(folder_.Path(name)).parent_path());
    return folder_.Write(name, bytes);
  }

 private:
  TemporaryFolder folder_;
};

/// One gzip member.
inline std::string Gzip(const std::string& bytes) {
  z_stream stream = {};
  deflateInit2(&stream, Z_BEST_SPEED, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY);
  std::string result(deflateBound(&stream, bytes.size()) + 64, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(result.data());
  stream.avail_out = static_cast<uInt>(result.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  result.resize(stream.total_out);
  deflateEnd(&stream);
  return result;
}

}  // namespace dapple
