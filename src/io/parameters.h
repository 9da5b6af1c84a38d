// The parameters of one pbrt statement ("float radius" [2], ...): typed values by name, each with its place.
//
// Ask with the Get functions; a parameter of the name but of another type or count is an Error at its place. The list
// remembers what it was asked for, so after reading an entity, `ReportUnused` warns of misspelled parameters and
// can name the nearest known one. Values that need more context (colours, spectra, textures) come raw, by `Find`.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "src/base/error.h"
#include "src/base/vec.h"

namespace dapple {

enum class ParameterType : std::uint8_t {
  Integer,
  Float,
  Point2,
  Vector2,
  Point3,
  Vector3,
  Normal,
  Rgb,
  Xyz,
  Spectrum,
  Blackbody,
  String,
  Texture,
  Bool
};

/// The RGB space that a v4 file has chosen (`ColorSpace`) where the parameter stands; v3 files are always Srgb.
enum class RgbSpace : std::uint8_t { Srgb, DciP3, Rec2020, Aces2065_1 };

/// One parameter as written. At least one value is there, and the numbers are a whole multiple of the type's
/// components (2, 3, or 2 for a spectrum's wavelength-value pairs); all numbers are finite.
struct Parameter {
  ParameterType type = ParameterType::Float;
  RgbSpace rgbSpace = RgbSpace::Srgb;
  /// From an `Attribute` statement (v4), which speaks to many entities: unused ones of these are no mistake.
  bool isInherited = false;
  /// Texture parameters: index into `SceneDescription::textures` of the float and of the spectrum texture of this name
  /// that is in scope here; -1 where there is none.
  int floatTexture = -1, spectrumTexture = -1;
  std::string name;
  /// Every type with numbers but Integer. Blackbody: v3 (kelvin, scale) pairs, v4 kelvin.
  std::vector<double> numbers;
  std::vector<int> integers;         ///< Integer; Bool as 0 or 1.
  std::vector<std::string> strings;  ///< String; Texture's name; Spectrum by name or file (then `numbers` is empty).
  FileLocation location;             ///< Of the opening quote of "type name".

  mutable bool lookedUp = false;

  /// How many values of its type there are (points, colours, strings, ...); of a spectrum: pairs or names.
  int Count() const;
};

/// What a copy of the parameter takes in memory, about.
std::size_t MemoryBytes(const Parameter& parameter);

/// "point3", "rgb", ...: the type's name as pbrt-v4 writes it.
std::string_view TypeName(ParameterType type);

/// Numbers that one value of the type has: 1, 2 or 3; 0 for strings, textures and bools.
int ComponentCount(ParameterType type);

class ParameterList {
 public:
  /// Where a parameter of this name is already there, the new one replaces it.
  void Add(Parameter parameter);
  /// Adds what is not there yet, as inherited (the defaults that v4's `Attribute` sets).
  void AddDefaults(const ParameterList& defaults);

  /// All parameters in the file's order; neither counts as a look-up.
  bool IsEmpty() const { return parameters_.empty(); }
  const std::vector<Parameter>& All() const { return parameters_; }
  std::vector<Parameter>& All() { return parameters_; }

  /// The parameter, of whatever type, or null. Counts as a look-up.
  const Parameter* Find(std::string_view name) const;
  /// As `Find`, but an Error where the type is not `type` ('parameter "radius" is "string", expected "float"').
  const Parameter* Find(std::string_view name, ParameterType type) const;
  /// True where the parameter is there, of whatever type. Counts as a look-up.
  bool Has(std::string_view name) const { return Find(name) != nullptr; }

  // One value. Errors: wrong type, more than one value.
  double GetFloat(std::string_view name, double fallback) const;
  int GetInt(std::string_view name, int fallback) const;
  bool GetBool(std::string_view name, bool fallback) const;
  std::string GetString(std::string_view name, const std::string& fallback) const;
  Vec3d GetPoint3(std::string_view name, const Vec3d& fallback) const;
  Vec3d GetVector3(std::string_view name, const Vec3d& fallback) const;

  // All values; empty where the parameter is absent. `expectedCount` >= 0: an Error where another number is
  // given. A number beyond the range of the result is an Error too.
  std::vector<double> GetFloatArray(std::string_view name, int expectedCount = -1) const;
  std::vector<int> GetIntArray(std::string_view name, int expectedCount = -1) const;
  std::vector<std::string> GetStringArray(std::string_view name, int expectedCount = -1) const;
  /// Also takes "float uv", as v3 writes it; then an odd number of floats is an Error.
  std::vector<Vec2> GetPoint2Array(std::string_view name, int expectedCount = -1) const;
  std::vector<Vec3d> GetPoint3Array(std::string_view name, int expectedCount = -1) const;
  std::vector<Vec3> GetVector3Array(std::string_view name, int expectedCount = -1) const;
  std::vector<Vec3> GetNormalArray(std::string_view name, int expectedCount = -1) const;

  /// Place of the parameter, or `fallback` where it is absent. No look-up.
  FileLocation LocationOf(std::string_view name, const FileLocation& fallback) const;

  /// Warns of each parameter that nobody looked up ('unknown parameter "raduis"; did you mean "radius"?'); the names
  /// that were looked up are the known ones, `otherKnownNames` adds to them (and those do not count as unknown).
  void ReportUnused(Diagnostics& diagnostics, const std::vector<std::string>& otherKnownNames = {}) const;
  /// Counts as a look-up of every parameter: for an entity that is skipped as a whole.
  void IgnoreAll() const;

 private:
  const Parameter* FindCounted(std::string_view name, ParameterType type, int expectedCount) const;

  std::vector<Parameter> parameters_;
  mutable std::vector<std::string> askedNames_;
};

}  // namespace dapple
