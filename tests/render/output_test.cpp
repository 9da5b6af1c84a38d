#include "src/render/output.h"

#include <filesystem>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>

#include "src/base/error.h"
#include "src/render/version.h"
#include "tests/image/temporary_folder.h"

namespace dapple {
namespace {

class Output : public testing::Test {
 protected:
  std::string TempPath(const std::string& name) const { return folder_.Path(name); }

  TemporaryFolder folder_;
};

std::string ReadBytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

Image SmallImage() {
  Image image = Image::Rgb(3, 2);
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 3; ++x) image.SetColor(x, y, Color(0.1f * static_cast<float>(x), 0.5f, 3.25f));
  return image;
}

RenderRecord SmallRecord() {
  RenderRecord record;
  record.scene = "ring.pbrt";
  record.integrator = "sppm";
  record.seed = 7;
  record.passes = 16;
  return record;
}

/// The text of the error that `action` throws.
template <typename F>
std::string MessageOf(F action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST_F(Output, AFileThatCannotBeMadeIsToldByTheCheck) {
  // Longer than any that a folder holds.
  const std::string path = TempPath(std::string(250, 'a') + ".exr");
  EXPECT_EQ(MessageOf([&] { CheckOutput(path); }), path + ": error: cannot write the file: File name too long");
  // Root has the rights to write there, and still nothing can be made.
  EXPECT_NE(MessageOf([] { CheckOutput("/proc/x.exr"); }), "no error");
  const std::string fine = TempPath("fine.exr");
  EXPECT_EQ(MessageOf([&] { CheckOutput(fine); }), "no error");
  EXPECT_FALSE(std::filesystem::exists(fine)) << "it only looks";
}

TEST_F(Output, ExrKeepsPixelsAndRecord) {
  const std::string path = TempPath("image.exr");
  const Image image = SmallImage();
  WriteOutput(path, image, ToMetadata(SmallRecord()));
  const Image read = ReadImage(path);
  EXPECT_TRUE(std::ranges::equal(read.Values(), image.Values()));
  const ImageMetadata metadata = ReadExrMetadata(path);
  EXPECT_EQ(std::get<std::string>(metadata.at("scene")), "ring.pbrt");
  EXPECT_EQ(std::get<std::string>(metadata.at("integrator")), "sppm");
  EXPECT_EQ(std::get<int>(metadata.at("seed")), 7);
  EXPECT_EQ(std::get<int>(metadata.at("passes")), 16);
  EXPECT_EQ(std::get<std::string>(metadata.at("version")), Version());
  EXPECT_EQ(std::get<std::string>(metadata.at("instructionSet")), InstructionSet());
  EXPECT_FALSE(metadata.contains("seconds")) << "a measurement would make each file another";
  EXPECT_FALSE(metadata.contains("clamp"));
}

TEST_F(Output, SecondsAreRecordedWhereTheyAreGiven) {
  const std::string path = TempPath("image.exr");
  RenderRecord record = SmallRecord();
  record.seconds = 12.5;
  WriteOutput(path, SmallImage(), ToMetadata(record));
  EXPECT_EQ(std::get<double>(ReadExrMetadata(path).at("seconds")), 12.5);
}

TEST_F(Output, TheSameImageGivesTheSameFile) {
  for (const char* name : {"image.exr", "image.png"}) {
    const std::string a = TempPath(std::string("a_") + name), b = TempPath(std::string("b_") + name);
    WriteOutput(a, SmallImage(), ToMetadata(SmallRecord()));
    WriteOutput(b, SmallImage(), ToMetadata(SmallRecord()));
    EXPECT_FALSE(ReadBytes(a).empty());
    EXPECT_EQ(ReadBytes(a), ReadBytes(b));
  }
}

TEST_F(Output, PngIsChosenByTheExtensionInAnyCase) {
  const std::string path = TempPath("IMAGE.PNG");
  WriteOutput(path, SmallImage(), {});
  EXPECT_EQ(ReadBytes(path).substr(1, 3), "PNG");
}

TEST_F(Output, RefusesWhatCannotBeWrittenBeforeTheWork) {
  EXPECT_NO_THROW(CheckOutput(TempPath("image.exr")));
  EXPECT_NO_THROW(CheckOutput("image.png")) << "the current folder";
  const std::string tiff = TempPath("image.tiff");
  EXPECT_EQ(MessageOf([&] { CheckOutput(tiff); }),
            tiff + ": error: expected a file name that ends in .exr or .png, not in '.tiff'");
  EXPECT_NE(MessageOf([] { CheckOutput("image"); }), "no error");
  const std::string missing = TempPath("no/such/folder/image.exr");
  EXPECT_NE(MessageOf([&] { CheckOutput(missing); }).find("does not exist"), std::string::npos);
  const std::string folder = TempPath("folder.exr");
  std::filesystem::create_directory(folder);
  EXPECT_NE(MessageOf([&] { CheckOutput(folder); }).find("is a folder"), std::string::npos);
}

}  // namespace
}  // namespace dapple
