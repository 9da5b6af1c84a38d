// What goes wrong outside the program: full disks, folders that nothing may be written to, files that vanish, readers
// that leave. Each is told in a line; no half file stands under a final name, and what was there before stays.
#include <algorithm>
#include <filesystem>
#include <string>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/app/program.h"
#include "tests/support/sanitizers.h"

namespace dapple {
namespace {

using Failure = ProgramTest;

/// No file may grow beyond so many bytes: as a disk that is full then.
std::function<void()> FilesUpTo(rlim_t bytes) {
  return [bytes] {
    const rlimit limit{bytes, bytes};
    setrlimit(RLIMIT_FSIZE, &limit);
  };
}

/// What no write permission keeps from writing must not be: as another user, where the tests run as root.
void BecomeNobody() {
  constexpr id_t kNobody = 65534;
  if (geteuid() == 0 && (setgid(kNobody) != 0 || setuid(kNobody) != 0)) _exit(126);
}

TEST_F(Failure, AFullDiskLeavesNoHalfPicture) {
  WriteScene("tiny.pbrt");
  const std::vector<std::string> before = Files();
  for (const std::string name : {"a.exr", "a.png", "a.dapple"}) {
    const ProgramResult result = Run("tiny.pbrt --quiet --integrator path --passes 1 -o " + name, FilesUpTo(300));
    EXPECT_EQ(result.exitCode, 1);
    EXPECT_EQ(result.err, name + ": error: cannot write the file: File too large\n" + name +
                              ".checkpoint: error: cannot write the file: File too large\n")
        << "nor can the state be kept";
    EXPECT_EQ(Files(), before) << "nothing is left, no temporary file either";
  }
}

/// What is written to `name` meets a full disk.
void MakeFull(const std::string& path) { std::filesystem::create_symlink("/dev/full", path); }

const std::string kFull = ": error: cannot write the file: No space left on device\n";

// Hours of work do not hang on the first of their files.
TEST_F(Failure, AnOutputThatCannotBeWrittenCostsNoOtherAndThePassesAreKept) {
  WriteScene("tiny.pbrt");
  const std::string command = "tiny.pbrt --quiet --integrator path --passes 3 ";
  ASSERT_EQ(Run(command + "-o whole.exr").exitCode, 0);
  MakeFull(Path("full.exr"));
  MakeFull(Path("full.json"));
  const ProgramResult result = Run(command + "-o full.exr -o b.exr --stats s.json");
  EXPECT_EQ(result.exitCode, 1);
  EXPECT_EQ(result.err, "full.exr" + kFull +
                            "kept: 3 passes; to go on, give the same command with --resume (it reads "
                            "full.exr.checkpoint)\n");
  EXPECT_TRUE(Read("b.exr") == Read("whole.exr"));
  EXPECT_TRUE(Contains(Read("s.json"), "\"passes\": 3"));
  std::filesystem::remove(Path("full.exr"));
  std::filesystem::remove(Path("b.exr"));
  const ProgramResult statistics = Run(command + "-o full.exr -o b.exr --stats full.json --resume");
  EXPECT_EQ(statistics.exitCode, 1);
  EXPECT_EQ(statistics.err, "full.json" + kFull);
  EXPECT_TRUE(Read("full.exr") == Read("whole.exr"));
  EXPECT_TRUE(Read("b.exr") == Read("whole.exr"));
}

TEST_F(Failure, AnOutputOfAMergeThatCannotBeWrittenCostsNoOther) {
  WriteScene("tiny.pbrt");
  const std::string command = "tiny.pbrt --quiet --integrator path --passes ";
  for (const char* passes : {"2 -o whole.exr", "0:1", "1:2"}) ASSERT_EQ(Run(command + passes).exitCode, 0);
  MakeFull(Path("full.exr"));
  const ProgramResult result = Run("merge tiny.0-1.dapple tiny.1-2.dapple -o full.exr -o b.exr");
  EXPECT_EQ(result.exitCode, 1);
  EXPECT_EQ(result.err, "full.exr" + kFull);
  EXPECT_TRUE(BeginsWith(result.out, "b.exr\npasses    0 to 1 of 2 files\n"));
  EXPECT_TRUE(Read("b.exr") == Read("whole.exr"));
}

// The code that promises a picture and a checkpoint is that of a render that has some.
TEST_F(Failure, ASignalBeforeTheFirstPassLeavesNothingAndIsNoSuccess) {
  WriteScene("tiny.pbrt");
  // The reader has something to say of it.
  Write("warns.pbrt", Read("tiny.pbrt") + "Shape \"curve\"\n");
  const std::vector<std::string> before = Files();
  for (const int signal : {SIGINT, SIGTERM}) {
    const ProgramResult result = RunAndSignalBeforeItSpeaks("warns.pbrt -o a.exr --checkpoint 60", {signal});
    EXPECT_EQ(result.exitCode, 1);
    EXPECT_TRUE(Contains(result.err, "\nstopped before the first pass was done; nothing is written\n"));
    EXPECT_EQ(Files(), before);
  }
}

// What it waits for need not end: here it is someone who reads the error stream.
TEST_F(Failure, ASecondSignalEndsTheProgramAtOnce) {
  WriteScene("tiny.pbrt");
  Write("warns.pbrt", Read("tiny.pbrt") + "Shape \"curve\"\n");
  const ProgramResult result = RunAndSignalBeforeItSpeaks("warns.pbrt -o a.exr", {SIGTERM, SIGINT});
  EXPECT_EQ(result.exitCode, 1);
  EXPECT_FALSE(Contains(result.err, "stopped before"));
}

TEST_F(Failure, WhatIsNoFileNeedsNoFolderThatTakesFiles) {
  WriteScene("tiny.pbrt");
  ASSERT_EQ(mkdir(Path("open").c_str(), 0777), 0);
  chmod(Path("open").c_str(), 0777);
  // As another user the streams' files can be written only where they are there.
  for (const char* stream : {"stdout.txt", "stderr.txt"}) Write(stream, "");
  for (const char* stream : {"stdout.txt", "stderr.txt"}) chmod(Path(stream).c_str(), 0666);
  if (Run("--version", BecomeNobody).exitCode != 0) GTEST_SKIP() << "no other user can run the program here";
  const ProgramResult result =
      Run("tiny.pbrt --quiet --integrator path --passes 1 -o open/a.exr --stats /dev/null", BecomeNobody);
  EXPECT_EQ(result.exitCode, 0) << result.err;
  ASSERT_EQ(mkfifo(Path("locked").c_str(), 0400), 0);
  EXPECT_EQ(Run("tiny.pbrt -o open/a.exr --stats locked", BecomeNobody).err,
            "locked: error: this is no file, and not writable\n");
}

// That picture and checkpoint are there is what the code promises; how to go on is told whatever else fails.
TEST_F(Failure, WhatCannotBeToldChangesNothingOfWhatASignalLeaves) {
  WriteScene("tiny.pbrt");
  MakeFull(Path("full.json"));
  const ProgramResult result =
      RunAndSignal("tiny.pbrt --integrator path --time 600 -o a.exr --stats full.json >/dev/full 2>stderr.txt #",
                   SIGTERM, " %: 1 pass, ");
  EXPECT_EQ(result.exitCode, 128 + SIGTERM);
  EXPECT_TRUE(Contains(result.err, "to go on, give the same command with --resume (it reads a.exr.checkpoint)\n"));
  EXPECT_TRUE(Contains(result.err, "full.json" + kFull));
  EXPECT_TRUE(Contains(result.err, "error: cannot write to the standard output: "));
  EXPECT_TRUE(Exists("a.exr") && Exists("a.exr.checkpoint"));
}

TEST_F(Failure, AFullDiskLeavesTheOldPicture) {
  WriteScene("tiny.pbrt");
  ASSERT_EQ(Run("tiny.pbrt --quiet --integrator path --passes 1 -o a.exr").exitCode, 0);
  const std::string old = Read("a.exr");
  EXPECT_EQ(Run("tiny.pbrt --quiet --integrator path --passes 2 -o a.exr", FilesUpTo(100)).exitCode, 1);
  EXPECT_TRUE(Read("a.exr") == old);
}

TEST_F(Failure, AFullDiskLeavesTheOldCheckpointAndTheRenderGoesOn) {
  WriteScene("tiny.pbrt");
  const std::string command = "tiny.pbrt --quiet --integrator path -o a.exr --checkpoint 0.0001 ";
  ASSERT_EQ(Run(command + "--passes 6").exitCode, 0);
  const std::string whole = Read("a.exr");
  ASSERT_EQ(Run(command + "--passes 2").exitCode, 0);
  const std::string checkpoint = Read("a.exr.checkpoint");
  // The state takes 96 bytes a pixel, the picture 12 at most.
  const ProgramResult full = Run(command + "--passes 6 --resume", FilesUpTo(24 * 16 * 24));
  EXPECT_EQ(full.exitCode, 1);
  EXPECT_TRUE(BeginsWith(full.err, "warning: no checkpoint was written, the one before it stays: a.exr.checkpoint: "));
  EXPECT_TRUE(Contains(full.err, "\na.exr.checkpoint: error: cannot write the file: File too large\n"));
  EXPECT_TRUE(Read("a.exr") == whole) << "the picture needs no checkpoint";
  EXPECT_TRUE(Read("a.exr.checkpoint") == checkpoint);
  EXPECT_EQ(Files(), (std::vector<std::string>{"a.exr", "a.exr.checkpoint", "a.exr.checkpoint.old", "tiny.pbrt"}));
  ASSERT_EQ(Run(command + "--passes 6 --resume").exitCode, 0);
  EXPECT_TRUE(Read("a.exr") == whole);
}

TEST_F(Failure, AFolderThatMayNotBeWrittenToIsToldBeforeTheRender) {
  WriteScene("tiny.pbrt");
  ASSERT_EQ(mkdir(Path("locked").c_str(), 0555), 0);
  // As another user the streams' files can be written only where they are there.
  for (const char* stream : {"stdout.txt", "stderr.txt"}) Write(stream, "");
  for (const char* stream : {"stdout.txt", "stderr.txt"}) chmod(Path(stream).c_str(), 0666);
  if (Run("--version", BecomeNobody).exitCode != 0) GTEST_SKIP() << "no other user can run the program here";
  const ProgramResult result = Run("no-scene.pbrt -o locked/a.exr", BecomeNobody);
  EXPECT_EQ(result.exitCode, 1);
  EXPECT_EQ(result.err, "locked/a.exr: error: the folder 'locked' is not writable\n");
}

TEST_F(Failure, AFolderThatVanishesIsToldAndTheCheckpointOfBeforeIsNotLost) {
  WriteScene("tiny.pbrt");
  std::filesystem::create_directory(Path("folder"));
  const std::string command = "tiny.pbrt --integrator path --passes 4 -o folder/a.exr";
  ASSERT_EQ(Run(command + " --checkpoint 60").exitCode, 0);
  std::filesystem::rename(Path("folder"), Path("moved"));
  const ProgramResult result = Run(command + " --resume");
  EXPECT_EQ(result.exitCode, 1);
  EXPECT_TRUE(BeginsWith(result.err, "folder/a.exr: error: the folder 'folder' does not exist"));
  EXPECT_TRUE(Exists("moved/a.exr.checkpoint"));
}

TEST_F(Failure, ATextureThatVanishesIsToldWhereItIsNamed) {
  WriteScene("tiny.pbrt");
  Write("textured.pbrt", Read("tiny.pbrt") +
                             "Texture \"map\" \"spectrum\" \"imagemap\" \"string filename\" \"map.exr\"\n"
                             "Material \"diffuse\" \"texture reflectance\" \"map\"\nShape \"sphere\"\n");
  ASSERT_EQ(Run("tiny.pbrt --quiet --integrator path --passes 1 -o map.exr").exitCode, 0);
  const std::string command = "textured.pbrt --quiet --integrator path --passes 2 -o a.exr --checkpoint 60";
  ASSERT_EQ(Run(command).exitCode, 0);
  const std::string checkpoint = Read("a.exr.checkpoint"), picture = Read("a.exr");
  std::filesystem::rename(Path("map.exr"), Path("other.exr"));
  const ProgramResult gone = Run(command + " --resume");
  EXPECT_EQ(gone.exitCode, 1);
  EXPECT_TRUE(BeginsWith(gone.err, "textured.pbrt:12:37: error: "));
  EXPECT_TRUE(Contains(gone.err, "image file \"map.exr\" not found"));
  EXPECT_TRUE(Read("a.exr.checkpoint") == checkpoint && Read("a.exr") == picture);
  // Another image in its place is another scene.
  ASSERT_EQ(Run("tiny.pbrt --quiet --integrator path --passes 1 --seed 1 -o map.exr").exitCode, 0);
  EXPECT_TRUE(Contains(Run(command + " --resume").err, "it is of another render: the scene's content"));
  std::filesystem::rename(Path("other.exr"), Path("map.exr"));
  EXPECT_EQ(Run(command + " --resume").exitCode, 0);
}

/// Descriptor 9 becomes a pipe that nobody reads. (In a command, "#" hides the redirections that follow it.)
void OpenBrokenPipe() {
  int ends[2];
  if (pipe(ends) != 0 || dup2(ends[1], 9) < 0) _exit(126);
  close(ends[0]);
}

TEST_F(Failure, APictureForAReaderThatLeavesIsAnError) {
  WriteScene("tiny.pbrt");
  // A pipe by name whose reader goes when the first bytes are there; the picture is more than a pipe holds.
  ASSERT_EQ(mkfifo(Path("pipe.exr").c_str(), 0600), 0);
  const pid_t reader = fork();
  if (reader == 0) {
    char byte;
    const int descriptor = open(Path("pipe.exr").c_str(), O_RDONLY);
    _exit(read(descriptor, &byte, 1) == 1 ? 0 : 1);
  }
  const ProgramResult result = Run("tiny.pbrt --quiet --integrator path --passes 1 --resolution 320x240 -o pipe.exr");
  kill(reader, SIGKILL);  // where the program never came to write
  waitpid(reader, nullptr, 0);
  EXPECT_EQ(result.exitCode, 1);
  EXPECT_TRUE(BeginsWith(result.err, "pipe.exr: error: cannot write the file: Broken pipe\nkept: 1 pass; "));
}

TEST_F(Failure, ARenderIsNotLostForWantOfAListener) {
  WriteScene("tiny.pbrt");
  const ProgramResult deaf = Run("tiny.pbrt --integrator path --passes 50 -o a.exr >stdout.txt 2>&9 #", OpenBrokenPipe);
  ASSERT_EQ(deaf.exitCode, 0);
  ASSERT_TRUE(Exists("a.exr"));
  ASSERT_EQ(Run("tiny.pbrt --quiet --integrator path --passes 50 -o b.exr").exitCode, 0);
  EXPECT_TRUE(Read("a.exr") == Read("b.exr"));
}

TEST_F(Failure, AStudyIsNotLostForWantOfAListener) {
  WriteScene("tiny.pbrt");
  Write("warns.pbrt", Read("tiny.pbrt") + "Shape \"curve\"\n");
  const std::string rest = " --integrators path --time 0.02 --seeds 1 --reference-time 0.05 -o out";
  for (const char* options : {"", " --quiet"}) {
    const ProgramResult deaf = Run("converge warns.pbrt" + rest + options + " >stdout.txt 2>&9 #", OpenBrokenPipe);
    ASSERT_EQ(deaf.exitCode, 0);
    EXPECT_TRUE(std::filesystem::remove(Path("out/index.html")));
  }
}

TEST_F(Failure, WhatCannotBePrintedIsAnError) {
  WriteScene("tiny.pbrt");
  for (const char* command : {"info tiny.pbrt", "tiny.pbrt --integrator path --passes 1"}) {
    const ProgramResult pipe = Run(std::string(command) + " >&9 2>stderr.txt #", OpenBrokenPipe);
    EXPECT_EQ(pipe.exitCode, 1);
    EXPECT_TRUE(Contains(pipe.err, "error: cannot write to the standard output: Broken pipe\n"));
    const ProgramResult full = Run(std::string(command) + " >/dev/full 2>stderr.txt #");
    EXPECT_EQ(full.exitCode, 1);
    EXPECT_TRUE(Contains(full.err, "error: cannot write to the standard output: No space left on device\n"));
  }
  EXPECT_TRUE(Exists("tiny.exr"));
}

TEST_F(Failure, ARenderThatDoesNotFitSaysSoBeforeItStarts) {
  WriteScene("tiny.pbrt");
  const ProgramResult small = Run("tiny.pbrt --integrator path --memory 1M -o a.exr");
  EXPECT_EQ(small.exitCode, 1);
  EXPECT_TRUE(BeginsWith(small.err, "error: the render takes about "));
  EXPECT_TRUE(Contains(small.err, ", more than 1 MB: the scene "));
  EXPECT_FALSE(Exists("a.exr"));
  // As many photons as are said to fit do fit.
  const std::string command =
      "tiny.pbrt --integrator sppm --no-guide --radius 0.2 --passes 1 --memory 160M -o a.exr --photons ";
  const ProgramResult large = Run(command + "100000000");
  EXPECT_EQ(large.exitCode, 1);
  const size_t place = large.err.find("; --photons ");
  ASSERT_NE(place, std::string::npos) << large.err;
  const std::string fitting = large.err.substr(place + 12, large.err.find(" fits") - place - 12);
  EXPECT_GT(std::stoi(fitting), 100000);
  const ProgramResult result = Run(command + fitting);
  EXPECT_EQ(result.exitCode, 0) << result.err;
  // Sanitizers have memory of their own.
  const bool isAbove = Contains(result.err, "warning: ");
  EXPECT_TRUE(!isAbove || testing_support::kIsSanitized) << "the peak stays below the limit";
  EXPECT_EQ(Run(command + std::to_string(2 * std::stoi(fitting))).exitCode, 1);
}

// The state is read before there is a film to put it in.
TEST_F(Failure, ARenderThatGoesOnTakesNoMoreThanWasReckoned) {
  if (testing_support::kIsSanitized) GTEST_SKIP() << "sanitizers have memory of their own";
  WriteScene("tiny.pbrt");
  const std::string command =
      "tiny.pbrt --quiet --threads 2 --integrator path --resolution 1000x800 --passes 1 -o a.exr ";
  ASSERT_EQ(Run(command + "--checkpoint 60").exitCode, 0);
  const std::string needs = Run(command + "--resume --memory 1M").err, beginning = "error: the render takes about ";
  ASSERT_TRUE(BeginsWith(needs, beginning));
  const std::string megabytes = needs.substr(beginning.size(), needs.find(" MB") - beginning.size());
  const ProgramResult result = Run(command + "--resume --memory " + std::to_string(std::stoi(megabytes) + 8) + "M");
  EXPECT_EQ(result.exitCode, 0);
  EXPECT_EQ(result.err, "") << "the peak stays below the limit";
}

}  // namespace
}  // namespace dapple
