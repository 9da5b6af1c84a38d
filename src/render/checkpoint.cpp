#include "src/render/checkpoint.h"

#include <filesystem>
#include <limits>
#include <new>
#include <utility>

#include <fmt/format.h>

namespace dapple {

namespace {

/// All passes that a budget may lead to.
PassRange PassesOf(const RenderBudget& budget) {
  const int64_t first = budget.firstPass;
  return {first, budget.passes ? first + *budget.passes : std::numeric_limits<int64_t>::max()};
}

}  // namespace

Checkpoint::Checkpoint(const std::string& output, RenderOrigin origin, std::optional<double> interval,
                       OnSetAside onSetAside)
    : path_(PathFor(output)),
      olderPath_(OlderPathFor(output)),
      origin_(std::move(origin)),
      interval_(interval),
      onSetAside_(std::move(onSetAside)) {}

std::optional<Film> Checkpoint::Load(const RenderBudget& budget) {
  std::error_code failure;
  if (!std::filesystem::exists(path_, failure)) return std::nullopt;
  RenderState state = ReadState(path_);
  if (const std::string what = Differences(state.origin.identity, origin_.identity); !what.empty()) {
    throw Error(FileLocation(path_),
                fmt::format("it is of another render: {}; remove it, or render without --resume", what));
  }
  const std::vector<PassRange>& held = state.film.Passes().All();
  const PassRange asked = PassesOf(budget);
  if (!held.empty() && (held.front().begin < asked.begin || held.back().end > asked.end)) {
    throw Error(FileLocation(path_), fmt::format("it holds passes {}, more than the {} to {} that are asked for",
                                                 state.film.Passes().ToString(), asked.begin, asked.end - 1));
  }
  secondsBefore_ = state.origin.record.seconds.value_or(0);
  passesSaved_ = state.film.PassCount();
  isOurs_ = true;
  return std::move(state.film);
}

std::optional<Error> Checkpoint::Update(const RenderProgress& progress) {
  if (!interval_ || progress.seconds - lastSave_ < *interval_ || progress.film->PassCount() == passesSaved_)
    return std::nullopt;
  lastSave_ = progress.seconds;
  try {
    Save(*progress.film, progress.seconds);
  } catch (const Error& error) {
    return error;
  } catch (const std::bad_alloc&) {
    return Error(FileLocation(path_), "the memory does not suffice to write the state");
  }
  return std::nullopt;
}

void Checkpoint::Save(const Film& film, double seconds) {
  origin_.record.seconds = secondsBefore_ + seconds;
  SetOlderAside();
  WriteState(path_, origin_, film);
  passesSaved_ = film.PassCount();
}

void Checkpoint::SetOlderAside() {
  std::error_code failure;
  if (!isOurs_ && std::filesystem::is_regular_file(path_, failure)) {
    // Under both names until the new one takes its place; where a file has one name only it is renamed.
    if (std::filesystem::is_regular_file(olderPath_, failure)) std::filesystem::remove(olderPath_, failure);
    std::filesystem::create_hard_link(path_, olderPath_, failure);
    if (failure) std::filesystem::rename(path_, olderPath_, failure);
    if (failure)
      throw Error(FileLocation(path_), fmt::format("cannot rename it to '{}': {}", olderPath_, failure.message()));
    if (onSetAside_) onSetAside_(olderPath_);
  }
  isOurs_ = true;
}

}  // namespace dapple
