// The state of a render kept beside its output, so that a render that was ended, by whatever, goes on where it was.
//
//   Checkpoint checkpoint("picture.exr", origin, 60);
//   if (std::optional<Film> saved = checkpoint.Load(budget)) film = std::move(*saved);
//   hooks.onProgress = [&](const RenderProgress& progress) { checkpoint.Update(progress); };
//   Render(...);
//   checkpoint.Save(film, result.seconds);
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "src/render/driver.h"
#include "src/render/render_state.h"

namespace dapple {

class Checkpoint {
 public:
  /// "picture.exr" has "picture.exr.checkpoint".
  static std::string PathFor(const std::string& output) { return output + ".checkpoint"; }
  /// And "picture.exr.checkpoint.old", where one that is of no use to this render is set aside.
  static std::string OlderPathFor(const std::string& output) { return PathFor(output) + ".old"; }

  /// Told the name that a checkpoint has now that was set aside.
  using OnSetAside = std::function<void(const std::string& older)>;

  /// `interval`: seconds between two saves by `Update`; absent: it never saves. Touches no file.
  Checkpoint(const std::string& output, RenderOrigin origin, std::optional<double> interval,
             OnSetAside onSetAside = {});

  /// The film that was saved; nothing where there is no file. Throws `Error` where it is damaged, is of another render
  /// (saying what differs), or holds passes that are not of the budget.
  std::optional<Film> Load(const RenderBudget& budget);

  /// Saves where the interval has passed since the last save (or the beginning) and a pass was done since. Where that
  /// fails, for want of memory too, the render goes on and the file of before stays: the error is returned, for a
  /// warning.
  std::optional<Error> Update(const RenderProgress& progress);

  /// Saves. `seconds`: those of this render so far. A checkpoint that is there and neither came from this object nor
  /// was loaded by it, the work of another render, is renamed first, in place of an older one of that name. Throws
  /// `Error`; the file of before then stays.
  void Save(const Film& film, double seconds);

  const std::string& Path() const { return path_; }
  /// Seconds of the renders before this one that led to the film of `Load`.
  double SecondsBefore() const { return secondsBefore_; }
  /// How many passes the file holds that was loaded or saved last; 0 where none was.
  int64_t PassesSaved() const { return passesSaved_; }

 private:
  void SetOlderAside();

  std::string path_, olderPath_;
  RenderOrigin origin_;
  std::optional<double> interval_;
  OnSetAside onSetAside_;
  bool isOurs_ = false;  ///< the file at `path_`, if there is one
  double secondsBefore_ = 0;
  double lastSave_ = 0;
  int64_t passesSaved_ = 0;
};

}  // namespace dapple
