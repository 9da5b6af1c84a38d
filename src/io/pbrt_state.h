// What pbrt statements change for those that follow (transform, material, attributes, ...), with the blocks that save
// and restore it.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "src/base/error.h"
#include "src/base/transform.h"
#include "src/io/parameters.h"

namespace dapple {

/// Names of one kind of thing (float textures, materials, ...). v3 forgets at AttributeEnd what was named within the
/// block, v4 keeps every name: so a name means its definition in scope, and where there is none, its last definition
/// anywhere.
class ScopedNames {
 public:
  /// From now on the name means `index` (>= 0).
  void Define(const std::string& name, int index);
  /// Index of the definition, or -1.
  int Find(const std::string& name) const;
  /// Whether a definition is in scope.
  bool IsInScope(const std::string& name) const { return inScope_.contains(name); }
  /// Every name that was ever defined.
  std::vector<std::string> All() const;

  /// `Rollback(Mark())` takes the scope back to where it was at Mark.
  std::size_t Mark() const { return undo_.size(); }
  void Rollback(std::size_t mark);

 private:
  struct Undo {
    std::string name;
    int index;  ///< -1: was not there.
  };
  std::unordered_map<std::string, int> inScope_, last_;
  std::vector<Undo> undo_;
};

/// Whose parameters an `Attribute` statement (v4) sets.
enum class AttributeTarget { Shape, Light, Material, Medium, Texture };
constexpr int kAttributeTargetCount = 5;

struct GraphicsState {
  Transform transform;
  bool startTimeActive = true, endTimeActive = true;
  bool reverseOrientation = false;
  int material = 0;    ///< Index; negative: ~index into the parser's list of names to be found at the end.
  int areaLight = -1;  ///< Index.
  RgbSpace rgbSpace = RgbSpace::Srgb;
  std::array<std::shared_ptr<const ParameterList>, kAttributeTargetCount> attributes;
};

enum class BlockKind { Attribute, Transform, Object, Import };

class PbrtState {
 public:
  /// `transformBlocksSaveAll`: in v4 TransformBegin is another name of AttributeBegin.
  PbrtState(bool transformBlocksSaveAll, Diagnostics& diagnostics)
      : transformBlocksSaveAll_(transformBlocksSaveAll), diagnostics_(diagnostics) {}

  /// The state at this place of the file.
  GraphicsState& Now() { return now_; }
  const GraphicsState& Now() const { return now_; }

  ScopedNames floatTextures, spectrumTextures, materials;

  /// Multiplies onto the current transform, or sets it. Where only the end time is active the transform stays, with one
  /// warning: motion is not supported. Throws Error where the result is not finite.
  void Concatenate(const Transform& transform, const FileLocation& location);
  void SetTransform(const Transform& transform, const FileLocation& location);

  /// Opens a block, at `location`. Throws Error where 10,000 are open.
  void Begin(BlockKind kind, const FileLocation& location);
  /// Throws Error where the innermost open block is of another kind. A Transform block of v3 restores the transform,
  /// the others restore all.
  void End(BlockKind kind, const FileLocation& location);
  /// How many blocks are open.
  std::size_t BlockCount() const { return blocks_.size(); }
  /// One message for each block that is still open beyond the first `count`: "AttributeBegin without AttributeEnd", the
  /// innermost last.
  struct OpenBlock {
    std::string message;
    FileLocation location;
  };
  std::vector<OpenBlock> OpenBlocks(std::size_t count = 0) const;

 private:
  struct Block {
    BlockKind kind = BlockKind::Attribute;
    GraphicsState saved;
    std::size_t floatTextureMark = 0, spectrumTextureMark = 0, materialMark = 0;
    FileLocation location;
  };

  bool transformBlocksSaveAll_;
  Diagnostics& diagnostics_;
  GraphicsState now_;
  std::vector<Block> blocks_;
  bool motionWarned_ = false;
};

}  // namespace dapple
