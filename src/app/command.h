// A subcommand of the program: it declares its options and leaves behind the work to do once they are parsed.
#pragma once

#include <functional>

#include <CLI/App.hpp>

namespace dapple {

/// Exit codes. A render that a signal ended early exits with 128 + the signal's number, its picture and its checkpoint
/// written; where nothing was, because no pass was done yet or a second signal came, with failure.
inline constexpr int kExitSuccess = 0;
inline constexpr int kExitFailure = 1;
inline constexpr int kExitUsage = 2;

/// The work of the subcommand that was called; returns the exit code. Throws `Error` for what the user can mend.
using Action = std::function<int()>;

/// Each adds its subcommand to the program; where it is the one called, parsing sets `*action`, which must outlive it.
void AddRenderCommand(CLI::App& program, Action* action);
void AddInfoCommand(CLI::App& program, Action* action);
void AddEmitCommand(CLI::App& program, Action* action);
void AddEnvmapCommand(CLI::App& program, Action* action);
void AddCompareCommand(CLI::App& program, Action* action);
void AddMergeCommand(CLI::App& program, Action* action);
void AddConvergeCommand(CLI::App& program, Action* action);

}  // namespace dapple
