// Material statements as materials, with the defaults of the version of pbrt that knows the type.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "src/io/build_values.h"
#include "src/materials/material.h"

namespace dapple {

/// Builds the materials that shapes ask for, each once.
class Materials {
 public:
  /// `values` must live as long.
  explicit Materials(Values& values);

  /// Where the description's material stands in the list that `Take` gives; -1 for an interface that light passes
  /// unchanged. Throws `Error` at the place of what is wrong; types that Dapple lacks give a warning and a stand-in.
  int IndexOf(int material);
  /// True for "none", "interface" and "".
  bool IsInterface(int material) const;
  /// The materials that were asked for.
  std::vector<std::unique_ptr<Material>> Take() { return std::move(built_); }
  /// Their names and places, for messages.
  std::vector<std::string> TakeNames() { return std::move(names_); }

 private:
  Values& values_;
  std::vector<std::optional<int>> indices_;
  std::vector<std::unique_ptr<Material>> built_;
  std::vector<std::string> names_;
};

}  // namespace dapple
