// Scenes that no one should have written: each is refused with its place, or rendered with a warning; within a bound on
// time and memory, and without a file that was not asked for.
#include <cstdlib>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <sys/resource.h>

#include "tests/app/program.h"
#include "tests/support/sanitizers.h"

namespace dapple {
namespace {

using testing_support::kIsSanitized;

/// Half a minute of processor time and 2 GB of addresses; beyond that the program ends by a signal, or says that the
/// memory does not suffice.
void Bound() {
  const rlimit seconds{30, 30}, bytes{rlim_t{2} << 30, rlim_t{2} << 30};
  setrlimit(RLIMIT_CPU, &seconds);
  if (!kIsSanitized) setrlimit(RLIMIT_AS, &bytes);
}

class BadInput : public ProgramTest {
 protected:
  /// The error of a render of `scene`; checks that it is one, and that nothing was written.
  std::string ErrorOf(const std::string& scene) {
    Write("bad.pbrt", scene);
    return ErrorOfFile();
  }

  std::string ErrorOfFile() {
    const std::vector<std::string> before = Files();
    const ProgramResult result = Run("bad.pbrt --quiet --passes 1 --threads 2", Bound);
    EXPECT_EQ(result.exitCode, 1) << result.err;
    EXPECT_EQ(Files(), before);
    return result.err;
  }

  /// In a scene that is otherwise whole.
  std::string WorldError(const std::string& statements) { return ErrorOf(kWorld + statements); }

  /// The warnings of a render of one pass by camera paths, which succeeds.
  std::string WarningsOf(const std::string& scene) {
    Write("slow.pbrt", scene);
    const ProgramResult result = Run("slow.pbrt --quiet --integrator path --passes 1 --threads 2", Bound);
    EXPECT_EQ(result.exitCode, 0) << result.err;
    return result.err;
  }

  static constexpr const char* kWorld =
      "Film \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" 4\nWorldBegin\nLightSource \"point\"\n";
};

TEST_F(BadInput, IncludesThatNeverEnd) {
  Write("a.pbrt", "Include \"bad.pbrt\"");
  EXPECT_TRUE(BeginsWith(ErrorOf("Include \"a.pbrt\""), "a.pbrt:1:1: error: bad.pbrt includes itself"));
  for (int i = 0; i < 100; ++i)
    Write("deep" + std::to_string(i) + ".pbrt", "Include \"deep" + std::to_string(i + 1) + ".pbrt\"");
  EXPECT_TRUE(
      BeginsWith(ErrorOf("Include \"deep0.pbrt\""), "deep62.pbrt:1:1: error: files are included more than 64 deep"));
}

TEST_F(BadInput, HundredMegabytesOfBrackets) {
  const std::string brackets(100'000'000, '[');
  EXPECT_TRUE(BeginsWith(ErrorOf(brackets), "bad.pbrt:1:1: error: expected a directive, found "));
  EXPECT_TRUE(
      BeginsWith(ErrorOf("WorldBegin Shape \"sphere\" \"float radius\" " + brackets), "bad.pbrt:1:43: error: "));
  EXPECT_TRUE(BeginsWith(ErrorOf("WorldBegin Shape \"sphere\" \"" + brackets), "bad.pbrt:1:27: error: "));
}

TEST_F(BadInput, HundredMegabytesOfBlocks) {
  std::string blocks = "WorldBegin\n";
  while (blocks.size() < 100'000'000) blocks += "AttributeBegin\n";
  EXPECT_TRUE(BeginsWith(ErrorOf(blocks), "bad.pbrt:10002:1: error: blocks are more than 10000 deep"));
}

/// `count` lines; each is what `line(i)` gives.
template <typename Line>
std::string Lines(int count, const Line& line) {
  std::string lines;
  for (int i = 1; i <= count; ++i) lines += line(std::to_string(i), std::to_string(i - 1)) + "\n";
  return lines;
}

// Each level asks the one below, twice where it can.
TEST_F(BadInput, TexturesThatNameTextures) {
  const std::string first = "Texture \"t0\" \"spectrum\" \"checkerboard\"\n";
  const auto shown = [](int last) {
    return "Material \"diffuse\" \"texture reflectance\" \"t" + std::to_string(last) + "\" Shape \"sphere\"";
  };
  const std::string scales = Lines(200, [](const std::string& name, const std::string& below) {
    return "Texture \"t" + name + "\" \"spectrum\" \"scale\" \"texture tex\" \"t" + below + "\"";
  });
  EXPECT_EQ(WarningsOf(kWorld + first + scales + shown(200)), "");
  const std::string mixes = Lines(40, [](const std::string& name, const std::string& below) {
    return "Texture \"t" + name + "\" \"spectrum\" \"mix\" \"texture tex1\" \"t" + below + "\" \"texture tex2\" \"t" +
           below + "\"";
  });
  // "t15" takes 2^16 - 1 evaluations.
  EXPECT_TRUE(BeginsWith(WorldError(first + mixes + shown(40)),
                         "bad.pbrt:20:53: error: textures name each other so often that one look at this one may take "
                         "more than 65536 evaluations"));
  const std::string boards = Lines(100'000, [](const std::string& name, const std::string& below) {
    return "Texture \"t" + name + "\" \"spectrum\" \"checkerboard\" \"texture tex1\" \"t" + below + "\"";
  });
  EXPECT_TRUE(BeginsWith(WorldError(first + boards + shown(100'000)),
                         "bad.pbrt:99749:44: error: textures name each other more than 256 deep"));
}

TEST_F(BadInput, MixesThatNameMixes) {
  const std::string first = "MakeNamedMaterial \"m0\" \"string type\" \"diffuse\"\n";
  const auto mixes = [](int count, bool isTwice) {
    return Lines(count, [&](const std::string& name, const std::string& below) {
      return "MakeNamedMaterial \"m" + name +
             "\" \"string type\" \"mix\" \"float amount\" 0 \"string materials\" [\"m" + below + "\" \"" +
             (isTwice ? "m" + below : "m0") + "\"]";
    });
  };
  const auto shown = [](int last) { return "NamedMaterial \"m" + std::to_string(last) + "\" Shape \"sphere\""; };
  EXPECT_TRUE(BeginsWith(WorldError(first + mixes(40, true) + shown(40)),
                         "bad.pbrt:14:62: error: a mix of more than 1024 materials"));
  EXPECT_TRUE(BeginsWith(WorldError(first + mixes(100'000, false) + shown(100'000)),
                         "bad.pbrt:99941:65: error: mixes name each other more than 64 deep"));
}

TEST_F(BadInput, AttributesThatAreInheritedByAll) {
  const auto attribute = [](const std::string& name, const std::string&) {
    return "Attribute \"shape\" \"float a" + name + "\" 1";
  };
  const auto shape = [](const std::string&, const std::string&) { return std::string("Shape \"sphere\""); };
  EXPECT_TRUE(BeginsWith(WorldError(Lines(10'000, attribute) + Lines(10'000, shape)),
                         "bad.pbrt:260:1: error: Attribute statements set more than 256 parameters"));
  std::string numbers;
  for (int i = 0; i < 500'000; ++i) numbers += " 1";
  EXPECT_TRUE(Contains(WorldError("Attribute \"shape\" \"float a\" [" + numbers + " ]\n" + Lines(10'000, shape)),
                       ":1: error: what Attribute statements set takes more than 256 MB and 64 times the text"));
  EXPECT_TRUE(BeginsWith(ErrorOf(Lines(100'000, [](const std::string& name,
                                                   const std::string&) { return "Option \"float a" + name + "\" 1"; })),
                         "bad.pbrt:257:1: error: Option statements set more than 256 parameters"));
}

TEST_F(BadInput, InstancesBeforeTheirObjects) {
  const std::string instances =
      Lines(100'000, [](const std::string& name, const std::string&) { return "ObjectInstance \"o" + name + "\""; });
  const std::string objects = Lines(
      99'999, [](const std::string& name, const std::string&) { return "ObjectBegin \"o" + name + "\" ObjectEnd"; });
  EXPECT_TRUE(BeginsWith(WorldError(instances + objects), "bad.pbrt:100003:1: error: no object is named \"o100000\""));
}

// Of light that nothing absorbs, and of shadow rays.
TEST_F(BadInput, WorkWithoutEnd) {
  for (const std::string white : {"\"diffuse\" \"rgb reflectance\" [1 1 1]", "\"dielectric\""}) {
    const std::string warnings =
        WarningsOf("Integrator \"path\" \"integer maxdepth\" 2147483647\n" + std::string(kWorld) + "Material " + white +
                   " Shape \"sphere\" \"float radius\" 20");
    EXPECT_TRUE(Contains(warnings,
                         "slow.pbrt:1:19: warning: parameter \"maxdepth\" is 2147483647, expected at most "
                         "1024; 1024 is used"));
  }
  EXPECT_TRUE(BeginsWith(WorldError("LightSource \"infinite\" \"integer samples\" 2147483647"),
                         "bad.pbrt:4:24: error: parameter \"samples\" is 2147483647, expected 1 to 65536"));
}

TEST_F(BadInput, NumbersThatAreNone) {
  for (const char* number : {"1e999", "-1e999", "nan", "inf", "-inf", "1e", "0x10", "1.2.3", "--1"}) {
    EXPECT_TRUE(BeginsWith(WorldError("Shape \"sphere\" \"float radius\" [ " + std::string(number) + " ]"),
                           "bad.pbrt:4:33: error: "))
        << number;
    EXPECT_TRUE(BeginsWith(WorldError("Translate 0 0 " + std::string(number)), "bad.pbrt:4:15: error: ")) << number;
  }
  // Finite as written, but beyond what the renderer counts with.
  EXPECT_TRUE(BeginsWith(WorldError("Shape \"sphere\" \"float radius\" 1e300"), "bad.pbrt:4:1: error: "));
  EXPECT_TRUE(BeginsWith(WorldError("Scale 1e200 1 1 Scale 1e200 1 1"), "bad.pbrt:4:17: error: "));
}

TEST_F(BadInput, IndicesOutOfRange) {
  for (const char* index : {"3", "-1", "2147483647", "-2147483648"}) {
    EXPECT_TRUE(BeginsWith(WorldError("Shape \"trianglemesh\" \"integer indices\" [0 1 " + std::string(index) +
                                      "] \"point P\" [0 0 0 1 0 0 0 1 0]"),
                           "bad.pbrt:4:22: error: index " + std::string(index)));
    Write("a.ply",
          "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
          "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 " +
              std::string(index) + "\n");
    EXPECT_TRUE(BeginsWith(WorldError("Shape \"plymesh\" \"string filename\" \"a.ply\""), "a.ply:13:7: error: face 0"));
  }
  EXPECT_TRUE(BeginsWith(WorldError("Shape \"trianglemesh\" \"integer indices\" [0 1 2147483648] \"point P\" [0 0 0]"),
                         "bad.pbrt:4:"));
}

TEST_F(BadInput, ImagesOfNoPixelAndOfTooMany) {
  using namespace std::string_literals;
  const auto error = [&](const std::string& name, const std::string& bytes) {
    Write(name, bytes);
    return WorldError("Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"" + name +
                      "\"\nMaterial \"diffuse\" \"texture reflectance\" \"t\"\nShape \"sphere\"");
  };
  const std::string place = "bad.pbrt:4:35: error: image file \"";
  for (const std::string& size : {"0 0"s, "0 4"s, "-1 4"s, "2147483648 1"s, "65536 65536"s, "1e9 1"s, "nan 1"s})
    EXPECT_TRUE(BeginsWith(error("a.pfm", "PF\n" + size + "\n-1\n" + std::string(64, '\0')), place + "a.pfm\""))
        << size;
  for (const std::string& size : {"-Y 0 +X 0"s, "-Y -4 +X 4"s, "-Y 65536 +X 65536"s, "-Y 2147483648 +X 1"s})
    EXPECT_TRUE(BeginsWith(error("a.hdr", "#?RADIANCE\n\n" + size + "\n" + std::string(64, '\1')), place + "a.hdr\""))
        << size;
  const auto png = [](const std::string& width, const std::string& height) {
    return "\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR"s + width + height + "\x08\2\0\0\0\0\0\0\0\0\0\0\0IEND\0\0\0\0"s;
  };
  const std::string none("\0\0\0\0", 4), one("\0\0\0\1", 4), many("\0\1\0\0", 4), most("\x7f\xff\xff\xff", 4);
  for (const std::string& bytes : {png(none, one), png(one, none), png(many, many), png(most, most)})
    EXPECT_TRUE(BeginsWith(error("a.png", bytes), place + "a.png\""));
}

TEST_F(BadInput, ResolutionsOfNothingAndOfTooMuch) {
  const auto error = [&](const std::string& x, const std::string& y) {
    return ErrorOf("Film \"rgb\" \"integer xresolution\" " + x + " \"integer yresolution\" " + y +
                   "\nWorldBegin LightSource \"point\" Shape \"sphere\"");
  };
  for (const char* size : {"0", "-1", "65537", "2147483647", "2147483648", "4294967296", "1e30", "1.5"}) {
    EXPECT_TRUE(BeginsWith(error(size, "4"), "bad.pbrt:1:")) << size;
    EXPECT_TRUE(BeginsWith(error("4", size), "bad.pbrt:1:")) << size;
  }
  EXPECT_TRUE(BeginsWith(error("65536", "65536"),
                         "bad.pbrt:1:12: error: a picture of 65536 x 65536 pixels, expected at most 268435456 in all"));
  EXPECT_TRUE(BeginsWith(error("30000", "60000"),
                         "bad.pbrt:1:40: error: a picture of 30000 x 60000 pixels, expected at most 268435456 in all"))
      << "the larger side";
}

TEST_F(BadInput, InstancesTooFlatToBeTraced) {
  const std::string far = "Shape \"sphere\" Translate 1e17 0 0 Shape \"sphere\"\n";
  const std::string object = "ObjectBegin \"a\" Shape \"sphere\" ObjectEnd\n";
  const std::string error = WorldError(far + object + "  ObjectInstance \"a\"");
  EXPECT_TRUE(BeginsWith(error, "bad.pbrt:6:3: error: the instance is too flat in a scene that reaches ")) << error;
}

// A light of which nobody can say how much it sends is not taken for a black one.
TEST_F(BadInput, LightsBeyondAllNumbers) {
  const std::string dark =
      "Film \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" 4\nWorldBegin\nShape \"sphere\"\n";
  for (const std::string light :
       {"LightSource \"point\" \"rgb I\" [1e300 0 0]", "LightSource \"point\" \"rgb I\" [0 1 0] \"float scale\" 1e300",
        "LightSource \"point\" \"float power\" 1e300", "LightSource \"spot\" \"rgb I\" [1e30 0 0] \"float scale\" 1e30",
        "LightSource \"distant\" \"rgb L\" [1e300 1e300 1e300]", "LightSource \"infinite\" \"rgb L\" [1e300 0 1]",
        "LightSource \"infinite\" \"rgb L\" [1e300 0 1] \"string sampling\" \"cosine\"",
        "AreaLightSource \"diffuse\" \"rgb L\" [0 0 1e300] Shape \"disk\"",
        "AreaLightSource \"diffuse\" \"float power\" 1e300 Shape \"disk\""}) {
    const std::string error = ErrorOf(dark + light);
    EXPECT_TRUE(BeginsWith(error, "bad.pbrt:4:1: error: light \"")) << light;
    EXPECT_TRUE(Contains(error, "expected finite numbers")) << light;
  }
}

TEST_F(BadInput, AGzipFileThatFillsTheMemory) {
  // Made of 1,032 zeros a byte; 128 MB of them.
  ASSERT_EQ(std::system(("head -c 134217728 /dev/zero | gzip > '" + Path("a.pbrt.gz") + "'").c_str()), 0);
  EXPECT_TRUE(BeginsWith(ErrorOf("Include \"a.pbrt.gz\""), "a.pbrt.gz: error: the gzip data inflates to more than "));
}

TEST_F(BadInput, WhatIsNoFileIsNotRead) {
  for (const char* name : {"/dev/zero", "/dev/stdin", "/", "."}) {
    const std::string file = std::string(" \"") + name + "\"";
    EXPECT_TRUE(BeginsWith(WorldError("Include" + file), "bad.pbrt:4:1: error: "));
    EXPECT_TRUE(BeginsWith(WorldError("Shape \"plymesh\" \"string filename\"" + file), "bad.pbrt:4:17: error: "));
    EXPECT_TRUE(
        BeginsWith(WorldError("LightSource \"infinite\" \"string filename\"" + file), "bad.pbrt:4:24: error: "));
    EXPECT_TRUE(BeginsWith(WorldError("Material \"conductor\" \"spectrum eta\"" + file + "\nShape \"sphere\""),
                           "bad.pbrt:4:22: error: "));
  }
}

// This one, as many that the system makes while they are read, is of no size and cannot be read from its beginning.
TEST_F(BadInput, WhatIsNotUsedIsNotOpened) {
  const std::string texture = "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"/proc/self/mem\"\n";
  EXPECT_EQ(WarningsOf(kWorld + texture + "Shape \"sphere\""), "");
  EXPECT_TRUE(BeginsWith(WorldError(texture + "Material \"diffuse\" \"texture reflectance\" \"t\" Shape \"sphere\""),
                         "bad.pbrt:4:35: error: "));
}

// A mesh of a quarter million triangles, with memory that runs out in the reader, when Embree starts and while it
// builds.
TEST_F(BadInput, ASceneThatTheMemoryDoesNotHold) {
  if (kIsSanitized) GTEST_SKIP() << "the sanitizers' own memory cannot be bounded";
  Write("a.pbrt",
        "WorldBegin LightSource \"point\" Shape \"loopsubdiv\" \"integer levels\" 8\n"
        "\"integer indices\" [0 1 2 0 3 1 0 2 3 1 3 2] \"point3 P\" [0 0 0 1 0 0 0 1 0 0 0 1]");
  int errorsOfEmbree = 0;
  for (rlim_t megabytes = 100; megabytes < 2000; megabytes += 50) {
    const ProgramResult result = Run("info a.pbrt --threads 2", [megabytes] {
      const rlimit bytes{megabytes << 20, megabytes << 20};
      setrlimit(RLIMIT_AS, &bytes);
    });
    if (result.exitCode == 0) break;
    EXPECT_EQ(result.exitCode, 1) << megabytes << " MB: " << result.err;
    const bool isOfEmbree = result.err.starts_with("a.pbrt: error: Embree ");
    EXPECT_TRUE(isOfEmbree || result.err == "a.pbrt: error: the memory does not suffice for the scene\n")
        << megabytes << " MB: " << result.err;
    errorsOfEmbree += isOfEmbree ? 1 : 0;
  }
  EXPECT_GE(errorsOfEmbree, 1);
}

// The name that a scene gives its picture is not a way out of the folder.
TEST_F(BadInput, NothingIsWrittenOutsideTheFolder) {
  namespace fs = std::filesystem;
  fs::create_directories(Path("outside/folder"));
  fs::create_directories(Path("inside"));
  for (const std::string& name :
       {Path("outside/evil.exr"), Path("outside/folder"), Path("evil"), std::string("../outside/evil.exr"),
        std::string("../evil.png"), std::string(".."), std::string("../outside/folder/."), std::string("/"),
        std::string("\\\\..\\\\evil")}) {
    Write("inside/a.pbrt", "Film \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" 4 \"string filename\" \"" +
                               name + "\"\nWorldBegin LightSource \"point\" Shape \"sphere\"");
    const std::string command = "cd '" + Path("inside") +
                                "' && '" DAPPLE_PROGRAM
                                "' a.pbrt --quiet --passes 2 --checkpoint 0.0001 --snapshots 1 --stats s.json";
    EXPECT_EQ(std::system(command.c_str()), 0) << name;
    size_t written = 0;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(Path(""))) {
      if (!entry.is_regular_file()) continue;
      EXPECT_EQ(entry.path().parent_path().filename(), "inside") << name << " led to " << entry.path();
      ++written;
    }
    EXPECT_GE(written, 5u) << "scene, picture, checkpoint, snapshot and statistics";
  }
}

}  // namespace
}  // namespace dapple
