// The `dapple` program: finds the subcommand, runs it, and turns what goes wrong into one line and an exit code.
#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "src/app/command.h"
#include "src/app/format.h"
#include "src/render/version.h"

namespace dapple {

namespace {

constexpr const char* kFooter =
    "\n`dapple SCENE` is short for `dapple render SCENE`.\n"
    "Exit codes: 0 success, 1 failure (a line on the error stream says what), 2 wrong usage,\n"
    "128 + N where signal N ended a render early, its picture and its checkpoint written (1 where\n"
    "it came before the first pass was done: then nothing is).";

/// The arguments, without the program's name, with "render" put in front where no subcommand is named.
std::vector<std::string> Arguments(CLI::App& program, int argc, char** argv) {
  std::vector<std::string> arguments(argv + 1, argv + argc);
  std::vector<std::string> known{"-h", "--help", "--version"};
  for (const CLI::App* subcommand : program.get_subcommands({})) known.push_back(subcommand->get_name());
  const bool isNamed = !arguments.empty() && std::find(known.begin(), known.end(), arguments[0]) != known.end();
  if (!arguments.empty() && !isNamed) arguments.insert(arguments.begin(), "render");
  return arguments;
}

int Parse(CLI::App& program, std::vector<std::string> arguments) {
  std::reverse(arguments.begin(), arguments.end());  // CLI11 takes them last first
  try {
    program.parse(std::move(arguments));
  } catch (const CLI::ParseError& error) {
    return program.exit(error) == 0 ? kExitSuccess : kExitUsage;
  }
  return -1;
}

int Run(int argc, char** argv) {
  CLI::App program("Dapple renders light from the light's side: photon mapping of pbrt scenes.", "dapple");
  program.set_version_flag(
      "--version", fmt::format("dapple {}, {}, sources {}, {}", Version(), InstructionSet(), SourceHash(), Compiler()));
  program.require_subcommand(1);
  program.footer(kFooter);
  program.failure_message([](const CLI::App* app, const CLI::Error& error) {
    const CLI::App* const used = app->get_subcommands().empty() ? app : app->get_subcommands().front();
    const std::string name = used == app ? "dapple" : "dapple " + used->get_name();
    return fmt::format("error: {}\nSee `{} --help`.\n", error.what(), name);
  });
  Action action;
  AddRenderCommand(program, &action);
  AddMergeCommand(program, &action);
  AddInfoCommand(program, &action);
  AddEmitCommand(program, &action);
  AddEnvmapCommand(program, &action);
  AddCompareCommand(program, &action);
  AddConvergeCommand(program, &action);
  if (const int code = Parse(program, Arguments(program, argc, argv)); code >= 0) return code;
  return action();
}

/// What was printed may have gone nowhere: a full disk, a pipe that nobody reads.
int CheckPrinted(int exitCode) {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return exitCode;
  Tell(fmt::format("error: cannot write to the standard output: {}", std::strerror(errno)));
  return exitCode == kExitSuccess ? kExitFailure : exitCode;
}

}  // namespace

}  // namespace dapple

int main(int argc, char** argv) {
  // A broken pipe and a limit on the size of files are errors of the write, not the end of the program.
  for (const int signal : {SIGPIPE, SIGXFSZ}) std::signal(signal, SIG_IGN);
  try {
    return dapple::CheckPrinted(dapple::Run(argc, argv));
  } catch (const std::exception& error) {
    dapple::Tell(dapple::ErrorLine(error));
  }
  return dapple::kExitFailure;
}
