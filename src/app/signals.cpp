#include "src/app/signals.h"

#include <array>
#include <cerrno>
#include <string_view>

#include <signal.h>
#include <unistd.h>

#include "src/app/command.h"

namespace dapple {

namespace {

// A signal handler gets no argument of ours, so what it sets must be global; only this file sees it.
std::atomic<bool> stopFlag{false};
std::atomic<int> stopSignal{0};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<int>::is_always_lock_free);

constexpr std::array<int, 2> kSignals{SIGINT, SIGTERM};

void Handle(int signal) {
  constexpr std::string_view kMessage =
      "\nstopping after this pass, or before the first one; once more to quit at once\n";
  int none = 0;
  if (!stopSignal.compare_exchange_strong(none, signal)) _exit(kExitFailure);
  stopFlag = true;
  const int error = errno;
  // Nothing can be done here where the message cannot be written.
  [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, kMessage.data(), kMessage.size());
  errno = error;
}

}  // namespace

StopSignals::StopSignals() {
  stopFlag = false;
  stopSignal = 0;
  struct sigaction action {};
  action.sa_handler = Handle;
  action.sa_flags = SA_RESTART;
  for (const int s : kSignals) sigaction(s, &action, nullptr);
}

StopSignals::~StopSignals() {
  for (const int s : kSignals) ::signal(s, SIG_DFL);
}

const std::atomic<bool>& StopSignals::Flag() const { return stopFlag; }

int StopSignals::Signal() const { return stopSignal; }

}  // namespace dapple
