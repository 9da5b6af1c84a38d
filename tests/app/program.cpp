#include "tests/app/program.h"

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <thread>

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

namespace dapple {

namespace {

constexpr const char* kScene = R"(LookAt 0 2 -6  0 0.5 0  0 1 0
Camera "perspective" "float fov" [40]
Film "rgb" "integer xresolution" [24] "integer yresolution" [16] "string filename" ["somewhere/tiny.exr"]
PixelFilter "gaussian"
Sampler "zsobol" "integer pixelsamples" [4]
WorldBegin
LightSource "point" "rgb I" [30 30 30] "point3 from" [1 4 -1]
Material "diffuse" "rgb reflectance" [0.6 0.5 0.4]
Shape "bilinearmesh" "point3 P" [-5 -1 -5  5 -1 -5  -5 -1 5  5 -1 5]
Material "dielectric"
Shape "sphere" "float radius" [1]
)";

}  // namespace

testing::AssertionResult Contains(const std::string& text, const std::string& part) {
  if (text.find(part) != std::string::npos) return testing::AssertionSuccess();
  return testing::AssertionFailure() << '"' << part << "\" is not in:\n" << text;
}

testing::AssertionResult BeginsWith(const std::string& text, const std::string& beginning) {
  if (text.starts_with(beginning)) return testing::AssertionSuccess();
  return testing::AssertionFailure() << '"' << beginning << "\" does not begin:\n" << text;
}

ProgramTest::ProgramTest() {
  const testing::TestInfo* const test = testing::UnitTest::GetInstance()->current_test_info();
  folder_ = std::filesystem::path(testing::TempDir()) /
            (std::string("dapple_") + test->name() + "_" + std::to_string(getpid()));
  std::filesystem::create_directories(folder_);
}

ProgramTest::~ProgramTest() {
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

std::string ProgramTest::Command(const std::string& arguments) const {
  return "cd '" + folder_.string() + "' && exec '" DAPPLE_PROGRAM "' " + arguments + " >stdout.txt 2>stderr.txt";
}

ProgramResult ProgramTest::Collect(int status) const {
  ProgramResult result;
  result.exitCode = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  result.out = Read("stdout.txt");
  result.err = Read("stderr.txt");
  return result;
}

ProgramResult ProgramTest::Run(const std::string& arguments) const {
  return Collect(std::system(Command(arguments).c_str()));
}

ProgramResult ProgramTest::RunAndSignal(const std::string& arguments, int signal, const std::string& awaited) const {
  const std::string command = Command(arguments);
  const pid_t child = fork();
  if (child == 0) {
    execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
    _exit(127);
  }
  const auto giveUp = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  int status = 0;
  while (Read("stderr.txt").find(awaited) == std::string::npos && std::chrono::steady_clock::now() < giveUp) {
    if (waitpid(child, &status, WNOHANG) == child) return Collect(status);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  kill(child, signal);
  waitpid(child, &status, 0);
  return Collect(status);
}

void ProgramTest::Write(const std::string& name, const std::string& content) const {
  std::ofstream(folder_ / name, std::ios::binary) << content;
}

std::string ProgramTest::Read(const std::string& name) const {
  std::ifstream file(folder_ / name, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void ProgramTest::WriteScene(const std::string& name) const { Write(name, kScene); }

}  // namespace dapple
