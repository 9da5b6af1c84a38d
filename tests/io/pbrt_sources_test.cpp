// Files that are small and name each other so that what is read of them is large.
#include "src/io/pbrt_sources.h"

#include "tests/io/reader_test_support.h"

namespace dapple {
namespace {

const FileLocation kHere(std::make_shared<const std::string>("a.pbrt"), 3, 1);

/// How often the file can be read, each time to its end, and the message of the next time.
std::pair<int, std::string> ReadUntilError(PbrtSources* sources, const std::filesystem::path& path) {
  for (int count = 0; count < 1000; ++count) {
    const std::string message = MessageOf([&] {
      sources->PushFile(path, kHere);
      sources->Pop();
    });
    if (message != "no error") return {count, message};
  }
  return {1000, ""};
}

TEST(PbrtSources, AFileThatIsIncludedOftenIsReadUpToItsShareOfTheDisk) {
  const TestFolder folder;
  PbrtSources sources({.readAnyway = 1 << 20, .mostOfDisk = 10});
  const auto small = folder.Write("small.pbrt", std::string(1 << 16, ' '));
  EXPECT_EQ(ReadUntilError(&sources, small),
            std::make_pair(16 + 10, std::string("a.pbrt:3:1: error: the text of all files that are included takes more "
                                                "than 1 MB and 10 times what lies on disk")));
  // Another file adds its own share; a part of it is taken by the last one of the first.
  const auto other = folder.Write("other.pbrt", std::string(1 << 16, ' '));
  EXPECT_EQ(ReadUntilError(&sources, other).first, 10 - 1);
}

TEST(PbrtSources, TextInMemoryCountsAsIfItLayOnDisk) {
  const TestFolder folder;
  PbrtSources sources({.readAnyway = 0, .mostOfDisk = 10});
  sources.PushText(std::string(1 << 16, ' '), "a.pbrt");
  EXPECT_EQ(sources.BytesRead(), 1u << 16);
  EXPECT_EQ(ReadUntilError(&sources, folder.Write("small.pbrt", std::string(1 << 16, ' '))).first, 19);
}

TEST(PbrtSources, FilesThatAreOpenTogetherShareWhatTheyMayInflateTo) {
  const TestFolder folder;
  const std::string blanks = Gzip(std::string(1 << 20, ' '));
  ASSERT_LT(blanks.size(), (1u << 20) / 100);
  const auto first = folder.Write("first.pbrt.gz", blanks), second = folder.Write("second.pbrt.gz", blanks);
  PbrtSources sources({.openAnyway = 1 << 20, .mostOfDisk = 10});
  sources.PushFile(first, kHere);
  sources.Pop();
  sources.PushFile(second, kHere);
  EXPECT_EQ(
      MessageOf([&] { sources.PushFile(first, kHere); }),
      "a.pbrt:3:1: error: the text of all files that are included within each other here takes more than 1 MB and "
      "10 times what lies on disk");
}

}  // namespace
}  // namespace dapple
