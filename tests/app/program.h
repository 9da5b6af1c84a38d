// Runs the `dapple` program as its users do, in a folder of the test's own.
#pragma once

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

namespace dapple {

struct ProgramResult {
  int exitCode = -1;
  std::string out, err;
};

testing::AssertionResult Contains(const std::string& text, const std::string& part);
testing::AssertionResult BeginsWith(const std::string& text, const std::string& beginning);

class ProgramTest : public testing::Test {
 protected:
  ProgramTest();
  ~ProgramTest() override;

  /// Runs `dapple ARGUMENTS` (as a shell reads them) in the folder.
  ProgramResult Run(const std::string& arguments) const;
  /// Starts it, sends it the signal once `awaited` stands on its error stream (or it has ended, or 60 s are over), and
  /// waits for its end.
  ProgramResult RunAndSignal(const std::string& arguments, int signal, const std::string& awaited) const;

  std::string Path(const std::string& name) const { return (folder_ / name).string(); }
  bool Exists(const std::string& name) const { return std::filesystem::exists(folder_ / name); }
  void Write(const std::string& name, const std::string& content) const;
  std::string Read(const std::string& name) const;
  /// A small scene that has what each integrator needs: a point light, a glass sphere, a diffuse floor.
  void WriteScene(const std::string& name) const;

 private:
  std::string Command(const std::string& arguments) const;
  ProgramResult Collect(int status) const;

  std::filesystem::path folder_;
};

}  // namespace dapple
