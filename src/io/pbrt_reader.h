// The reader behind pbrt_parser.h: follows the statements of a scene and records them in a SceneDescription.
//
// Give it text once (`ReadFile` or `ReadText`), ask its votes for the version, then `Finish`.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "src/io/pbrt_sources.h"
#include "src/io/pbrt_state.h"
#include "src/io/pbrt_version.h"
#include "src/io/scene_description.h"

namespace dapple {

class PbrtReader {
 public:
  /// `assumedVersion` tells what TransformBegin means. Included files are searched in `folder`.
  PbrtReader(int assumedVersion, const std::filesystem::path& folder, Diagnostics& diagnostics);

  /// Reads a file (plain or gzipped), or text in memory, with all that it includes. Throws Error at the place of what
  /// is wrong.
  void ReadFile(const std::filesystem::path& path);
  void ReadText(std::string_view text, const std::string& name);

  /// What the words that were read say about the version.
  const PbrtVersionVotes& Votes() const { return votes_; }
  /// Whether what was read could mean something else in another version than the assumed one.
  bool DependsOnVersion() const { return sawTransformBlock_; }
  /// The scene, references resolved. Throws Error where a name is not defined or the file ends too early for `version`.
  SceneDescription Finish(int version);

 private:
  using Statement = void (PbrtReader::*)();
  /// Which part of a file a statement belongs to: before WorldBegin, behind it, or both.
  enum class Part { Any, Options, World };
  struct Directive {
    Statement read;
    Part part;
  };
  struct PendingName {
    std::string name;
    FileLocation location;
  };
  struct PendingInstance {
    std::size_t instance;
    std::string name;
  };
  static const std::unordered_map<std::string_view, Directive>& Directives();

  // The stream of statements.
  void Run();
  void RunStatement(const Token& token);
  void LeaveSource();
  [[noreturn]] void FailUnknownDirective(const Token& token);
  void CheckPart(std::string_view name, Part part) const;

  // Arguments of the statement at `here_`.
  PbrtLexer& Lexer() { return *sources_.Top().lexer; }
  /// A string; `what` says in a message what was expected.
  std::string ReadName(std::string_view what);
  double ReadNumber(std::size_t count);
  void ReadCloseBracket(std::size_t count);
  template <std::size_t count>
  std::array<double, count> ReadNumbers();
  ParameterList ReadParameters();
  ParameterList ReadParameters(AttributeTarget defaults);
  /// As `ParameterList::AddDefaults`. Throws Error where all that is inherited takes too much memory.
  void AddDefaults(const ParameterList& defaults, ParameterList* parameters);
  /// Throws Error where the parameters that `statements` set are too many in all.
  void CheckCount(const ParameterList& parameters, std::string_view statements) const;
  template <typename Description = Entity>
  Description ReadEntity(std::string_view what, WordKind kind);

  // Statements: pbrt_reader_transforms.cpp.
  void Identity();
  void Translate();
  void Scale();
  void Rotate();
  void LookAt();
  void SetTransform();
  void ConcatTransform();
  void CoordinateSystem();
  void CoordSysTransform();
  void ActiveTransform();
  void TransformTimes();

  // Statements: pbrt_reader.cpp.
  /// The file whose text comes next.
  PbrtSources::Source& PushFile(const std::filesystem::path& path);
  void Include();
  void Import();
  void WorldBegin();
  void WorldEnd();
  void AttributeBegin();
  void AttributeEnd();
  void TransformBegin();
  void TransformEnd();
  void ObjectBegin();
  void ObjectEnd();
  void ObjectInstance();

  // Statements: pbrt_reader_entities.cpp.
  void Attribute();
  void Option();
  void ColorSpace();
  void Camera();
  void Film();
  void Sampler();
  void Integrator();
  void Accelerator();
  void PixelFilter();
  void Material();
  void MakeNamedMaterial();
  void NamedMaterial();
  void Texture();
  void LightSource();
  void AreaLightSource();
  void Shape();
  void ReverseOrientation();
  void MediumInterface();
  void MakeNamedMedium();

  void WarnOfMedia();
  /// Warns and gives false where the current transform has no inverse.
  bool HasInverse(std::string_view what);
  void ResolveTextures(ParameterList& parameters) const;

  // At the end.
  void ResolvePending();
  int MaterialBehind(int material) const;
  [[noreturn]] void FailUnknownObject(const std::string& name, const FileLocation& location) const;

  PbrtVersionVotes votes_;
  Diagnostics* diagnostics_;
  SceneDescription scene_;
  PbrtState state_;
  PbrtSources sources_;
  FileLocation here_;           ///< Of the statement being read.
  std::string_view directive_;  ///< Its word.
  bool isWorld_ = false, hasEnded_ = false, sawTransformBlock_ = false, mediaWarned_ = false;
  FileLocation worldBegin_;
  int object_ = -1;  ///< The object definition being read, or -1.
  std::unordered_map<std::string, Transform> coordinateSystems_;
  std::unordered_map<std::string, int> objects_;
  std::vector<PendingName> pendingMaterials_;
  std::vector<PendingInstance> pendingInstances_;
  std::size_t inheritedBytes_ = 0;  ///< Of the parameters that `AddDefaults` was given.
};

template <std::size_t count>
std::array<double, count> PbrtReader::ReadNumbers() {
  std::array<double, count> numbers = {};
  const bool isBracketed = Lexer().Peek().kind == TokenKind::OpenBracket;
  if (isBracketed) Lexer().Next();
  for (double& number : numbers) number = ReadNumber(count);
  if (isBracketed) ReadCloseBracket(count);
  return numbers;
}

}  // namespace dapple
