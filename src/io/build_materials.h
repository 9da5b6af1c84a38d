// Material statements as materials, with the defaults of the version of pbrt that knows the type.
#pragma once

#include <memory>
#include <optional>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "src/io/build_values.h"
#include "src/materials/material.h"

namespace dapple {

struct MaterialInput;

/// Builds the materials that shapes ask for, and those that mixes name, each once for all mixes.
class Materials {
 public:
  /// `values` must live as long.
  explicit Materials(Values& values);

  /// Where the description's material stands in the list that `Take` gives; -1 for an interface that light passes
  /// unchanged. Throws `Error` at the place of what is wrong; types that Dapple lacks give a warning and a stand-in.
  /// What is wrong may be mixes that name each other more than 64 deep, or so often that one look at the first may take
  /// more than 1024 materials.
  int IndexOf(int material);
  /// True for "none", "interface" and "".
  bool IsInterface(int material) const;
  /// The materials that were asked for.
  std::vector<std::unique_ptr<Material>> Take() { return std::move(built_); }
  /// Their names and places, for messages.
  std::vector<std::string> TakeNames() { return std::move(names_); }

 private:
  /// What one look at a material may take.
  struct Size {
    int materials = 1;  // it and all materials below it, one that is named twice twice
    int depth = 1;      // materials on the longest way down
  };
  /// A material that a mix names.
  struct Part {
    std::shared_ptr<const Material> material;  // null: an interface
    Size size;
  };
  /// A material that is being built, and its size so far.
  struct Unfinished {
    const MaterialDescription* description;
    Size size;
  };

  /// Null for an interface.
  std::unique_ptr<Material> Build(const MaterialDescription& material, Size* size);
  std::unique_ptr<Material> BuildMix(const MaterialInput& in);
  std::shared_ptr<const Material> PartOf(const std::string& name, const FileLocation& namedAt);
  const MaterialDescription& Named(const std::string& name, const FileLocation& namedAt) const;

  Values& values_;
  std::vector<std::optional<int>> indices_;
  std::vector<std::unique_ptr<Material>> built_;
  std::vector<std::string> names_;
  std::unordered_map<std::string_view, int> byName_;
  std::unordered_map<const MaterialDescription*, Part> parts_;
  std::vector<Unfinished> unfinished_;  // each names the next
};

}  // namespace dapple
