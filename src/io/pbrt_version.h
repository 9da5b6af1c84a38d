// Finds out which version of the pbrt format a file is in, 3 or 4, from the words it uses.
//
// Each word that only one version knows speaks for it, once and with a weight; the heavier side wins, a tie is
// version 4. A WorldEnd weighs less than any such name: it may be left behind in a file that was made into version 4.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "src/base/error.h"
#include "src/io/parameters.h"

namespace dapple {

/// What a word names: the same word may be a directive and a material.
enum class WordKind {
  Directive,
  ParameterType,
  Camera,
  Film,
  Sampler,
  Integrator,
  Accelerator,
  PixelFilter,
  Material,
  Texture,
  TextureValue,
  Light,
  Shape,
  BoolSpelling,     ///< "quoted", "bare"
  BlackbodyForm,    ///< "scaled", "plain"
  FilterParameter,  ///< This and the next kinds: names of parameters.
  IntegratorParameter,
  LightParameter,
  MaterialParameter,
  ShapeParameter,
  TextureParameter,
  Ending  ///< "WorldBegin without WorldEnd"
};

class PbrtVersionVotes {
 public:
  /// Weighs a word of the file; words that both versions know weigh nothing.
  void Saw(WordKind kind, std::string_view word, const FileLocation& location);
  /// Weighs the names of parameters of one statement.
  void SawParameters(WordKind kind, const ParameterList& parameters);

  /// 3 or 4: of the heavier side.
  int Version() const;
  /// The weightiest words for `version`, for people; "nothing in the file tells ..." where there are none.
  std::string Reason(int version) const;
  /// Warns where the file, read as `version`, holds a name or directive that the other version alone has: at WorldEnd,
  /// or else at the weightiest one. Types of parameters ("point") are read alike, and give no warning.
  void WarnOfContradiction(int version, Diagnostics& diagnostics) const;

 private:
  struct Vote {
    int version, weight;
    WordKind kind;
    std::string text;
    FileLocation location;
  };
  /// The weightiest first.
  std::vector<Vote> VotesFor(int version) const;

  std::vector<Vote> votes_;
  std::vector<bool> seen_;
};

}  // namespace dapple
