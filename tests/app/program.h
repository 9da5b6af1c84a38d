// Runs the `dapple` program as its users do, in a folder of the test's own.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace dapple {

struct ProgramResult {
  int exitCode = -1;
  std::string out, err;
};

testing::AssertionResult Contains(const std::string& text, const std::string& part);
testing::AssertionResult BeginsWith(const std::string& text, const std::string& beginning);

/// Options, each with a space behind it, of a short render without pilots: those that the integrator takes.
std::string ShortRender(std::string_view integrator, int photons);

class ProgramTest : public testing::Test {
 protected:
  ProgramTest();
  ~ProgramTest() override;

  /// Runs `dapple ARGUMENTS` (as a shell reads them) in the folder.
  ProgramResult Run(const std::string& arguments) const;
  /// The same, with `prepare` called in the process before it becomes the program: for limits, closed pipes and so on.
  ProgramResult Run(const std::string& arguments, const std::function<void()>& prepare) const;
  /// Starts it, sends it the signal once `awaited` stands on its error stream (or it has ended, or 60 s are over), and
  /// waits for its end.
  ProgramResult RunAndSignal(const std::string& arguments, int signal, const std::string& awaited) const;
  /// Starts it, sends it the signals as soon as it is ready for them (or 60 s are over), and waits for its end. It must
  /// have something to say before it has done what they are to fall into: its error stream takes nothing before they
  /// are sent.
  ProgramResult RunAndSignalBeforeItSpeaks(const std::string& arguments, const std::vector<int>& signals) const;
  /// Starts it and kills it (SIGKILL) after so many seconds; false where it had ended before.
  bool RunAndKill(const std::string& arguments, double seconds) const;
  /// Kills it at the first moment that is found to be the one; false where it had ended before.
  bool RunAndKillWhen(const std::string& arguments, const std::function<bool(int process)>& isTheMoment) const;

  std::string Path(const std::string& name) const { return (folder_ / name).string(); }
  bool Exists(const std::string& name) const { return std::filesystem::exists(folder_ / name); }
  void Write(const std::string& name, const std::string& content) const;
  std::string Read(const std::string& name) const;
  /// A small scene that has what each integrator needs: a point light, a glass sphere, a diffuse floor.
  void WriteScene(const std::string& name) const;
  /// A scene with enough of everything that threads share the work of: tiles of pixels, light paths, photons; light
  /// through glass, off a mesh, off instances, and off triangles that lie in the same place twice.
  void WriteSceneOfSharedWork(const std::string& name) const;
  /// The names of all files in the folder but those of the output streams, in rising order.
  std::vector<std::string> Files() const;

 private:
  std::string Command(const std::string& arguments) const;
  /// The process that runs it.
  int Start(const std::string& arguments, const std::function<void()>& prepare) const;
  ProgramResult Collect(int status) const;

  std::filesystem::path folder_;
};

}  // namespace dapple
