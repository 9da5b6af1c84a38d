#include "tests/app/program.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <thread>

#include <fcntl.h>
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

// A pass has several chunks of light paths (512) and buckets of photons (2048). Of the two floors, which are one in
// place, no ray may see one today and the other tomorrow.
constexpr const char* kSharedWork = R"(LookAt 0 2 -6  0 0.5 0  0 1 0
Camera "perspective" "float fov" [40]
Film "rgb" "integer xresolution" [64] "integer yresolution" [48] "string filename" ["shared.exr"]
WorldBegin
LightSource "point" "rgb I" [30 30 30] "point3 from" [1 4 -1]
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [8 6 4]
  Shape "trianglemesh" "point3 P" [-2 4 0  -1 4 0  -1 4 1  -2 4 1] "integer indices" [0 1 2  0 2 3]
AttributeEnd
Material "diffuse" "rgb reflectance" [0.6 0.5 0.4]
Shape "trianglemesh" "point3 P" [-5 -1 -7  5 -1 -7  -5 5 -7  5 5 -7  -5 -1 5  5 -1 5  -5 5 5  5 5 5] "integer indices"
  [0 1 4 1 5 4  2 6 3 3 6 7  4 5 6 5 7 6  0 2 1 1 2 3  0 4 2 2 4 6  1 3 5 3 7 5]
Material "diffuse" "rgb reflectance" [0.1 0.2 0.7]
Shape "trianglemesh" "point3 P" [-5 -1 -7  5 -1 -7  -5 -1 5  5 -1 5] "integer indices" [0 1 2 1 3 2]
ObjectBegin "tent"
  Shape "trianglemesh" "point3 P" [-0.5 -1 -0.5  0.5 -1 -0.5  0 0.5 0  0 -1 0.5] "integer indices" [0 2 1  1 2 3  3 2 0]
ObjectEnd
AttributeBegin Translate -1.5 0 0 ObjectInstance "tent" AttributeEnd
AttributeBegin Translate 1.5 0 1 Rotate 30 0 1 0 ObjectInstance "tent" AttributeEnd
AttributeBegin Translate 1.5 0 1 Rotate 30 0 1 0 ObjectInstance "tent" AttributeEnd
Material "dielectric"
Shape "sphere" "float radius" 0.8
)";

/// Writes to a pipe until it holds no more; how much that was.
size_t FillPipe(int descriptor) {
  const int flags = fcntl(descriptor, F_GETFL);
  fcntl(descriptor, F_SETFL, flags | O_NONBLOCK);
  size_t filled = 0;
  while (write(descriptor, " ", 1) == 1) ++filled;
  fcntl(descriptor, F_SETFL, flags);
  return filled;
}

/// All that comes before the last writer leaves.
std::string ReadToEnd(int descriptor) {
  std::string text;
  std::array<char, 4096> block;
  for (ssize_t n; (n = read(descriptor, block.data(), block.size())) > 0;) text.append(block.data(), n);
  return text;
}

/// Whether the process has become the program, and has a handler for the signal by now; true too where it has ended.
bool Catches(pid_t process, int signal) {
  const std::string folder = "/proc/" + std::to_string(process);
  std::error_code failure;
  const bool isProgram = std::filesystem::equivalent(folder + "/exe", DAPPLE_PROGRAM, failure);
  std::ifstream status(folder + "/status");
  uint64_t caught = 0;
  for (std::string word; status >> word;) {
    if (word == "Z") return true;
    if (word == "SigCgt:") status >> std::hex >> caught;
  }
  return isProgram && (caught >> (signal - 1) & 1) != 0;
}

}  // namespace

testing::AssertionResult Contains(const std::string& text, const std::string& part) {
  if (text.find(part) != std::string::npos) return testing::AssertionSuccess();
  return testing::AssertionFailure() << '"' << part << "\" is not in:\n" << text;
}

testing::AssertionResult BeginsWith(const std::string& text, const std::string& beginning) {
  if (text.starts_with(beginning)) return testing::AssertionSuccess();
  return testing::AssertionFailure() << '"' << beginning << "\" does not begin:\n" << text;
}

std::string ShortRender(std::string_view integrator, int photons) {
  if (integrator == "path") return "";
  return "--no-guide --photons " + std::to_string(photons) + (integrator == "light_tracing" ? " " : " --radius 0.2 ");
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

int ProgramTest::Start(const std::string& arguments, const std::function<void()>& prepare) const {
  const std::string command = Command(arguments);
  const pid_t child = fork();
  if (child != 0) return child;
  prepare();
  execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
  _exit(127);
}

ProgramResult ProgramTest::Run(const std::string& arguments) const {
  return Run(arguments, [] {});
}

ProgramResult ProgramTest::Run(const std::string& arguments, const std::function<void()>& prepare) const {
  int status = 0;
  waitpid(Start(arguments, prepare), &status, 0);
  return Collect(status);
}

ProgramResult ProgramTest::RunAndSignal(const std::string& arguments, int signal, const std::string& awaited) const {
  const pid_t child = Start(arguments, [] {});
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

ProgramResult ProgramTest::RunAndSignalBeforeItSpeaks(const std::string& arguments,
                                                      const std::vector<int>& signals) const {
  int ends[2];
  if (pipe(ends) != 0) return {};
  const size_t filled = FillPipe(ends[1]);
  const pid_t child = Start(arguments + " >stdout.txt 2>&9 #", [&] {
    if (dup2(ends[1], 9) < 0) _exit(126);
    close(ends[0]);
    close(ends[1]);
  });
  close(ends[1]);
  const auto giveUp = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!Catches(child, signals.front()) && std::chrono::steady_clock::now() < giveUp)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  for (const int signal : signals) kill(child, signal);
  const std::string told = ReadToEnd(ends[0]);
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  ProgramResult result = Collect(status);
  result.err = told.substr(filled);
  return result;
}

bool ProgramTest::RunAndKill(const std::string& arguments, double seconds) const {
  const pid_t child = Start(arguments, [] {});
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
  kill(child, SIGKILL);
  int status = 0;
  waitpid(child, &status, 0);
  return WIFSIGNALED(status);
}

bool ProgramTest::RunAndKillWhen(const std::string& arguments,
                                 const std::function<bool(int process)>& isTheMoment) const {
  const pid_t child = Start(arguments, [] {});
  int status = 0;
  while (!isTheMoment(child))
    if (waitpid(child, &status, WNOHANG) == child) return false;
  kill(child, SIGKILL);
  waitpid(child, &status, 0);
  return WIFSIGNALED(status);
}

void ProgramTest::Write(const std::string& name, const std::string& content) const {
  std::ofstream(folder_ / name, std::ios::binary) << content;
}

std::string ProgramTest::Read(const std::string& name) const {
  std::ifstream file(folder_ / name, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void ProgramTest::WriteScene(const std::string& name) const { Write(name, kScene); }

void ProgramTest::WriteSceneOfSharedWork(const std::string& name) const { Write(name, kSharedWork); }

std::vector<std::string> ProgramTest::Files() const {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
    const std::string name = entry.path().filename().string();
    if (name != "stdout.txt" && name != "stderr.txt") names.push_back(name);
  }
  std::ranges::sort(names);
  return names;
}

}  // namespace dapple
