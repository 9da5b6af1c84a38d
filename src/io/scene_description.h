// What a pbrt scene file says, as plain data: every statement with its parameters (not yet interpreted), its transform
// and its place in the file. The reader (pbrt_parser.h) fills it, `BuildScene` turns it into a Scene.
//
// References between entities are indices, resolved with the scope rules of the format. Transforms are double
// precision.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "src/base/error.h"
#include "src/base/transform.h"
#include "src/io/parameters.h"

namespace dapple {

/// One statement: `Film "rgb" "integer xresolution" 100`. Default-constructed: the file has none of it.
struct Entity {
  std::string type;  ///< "rgb"; may be "" where the file says so (Material "").
  ParameterList params;
  FileLocation location;  ///< Of the directive; no file: not given.

  /// The file has such a statement.
  bool IsGiven() const { return location.file != nullptr; }
};

struct CameraDescription : Entity {
  Transform cameraFromWorld;
};

struct MaterialDescription : Entity {
  std::string name;  ///< Of MakeNamedMaterial; "" for Material. `type` is then that of the parameter "type".
};

struct TextureDescription : Entity {
  std::string name;
  bool isSpectrum = false;  ///< "spectrum" or "color"; else "float".
  Transform worldFromTexture;
};

struct LightDescription : Entity {
  Transform worldFromLight;
};

struct ShapeDescription : Entity {
  /// To the world, or, in an object definition, to the object's space.
  Transform worldFromShape;
  bool reverseOrientation = false;
  int material = 0;  ///< Index into `SceneDescription::materials`.
  /// Index into `SceneDescription::areaLights`, or -1. May be set within an object definition too.
  int areaLight = -1;
};

struct ObjectDefinition {
  std::string name;
  std::vector<ShapeDescription> shapes;
  FileLocation location;
};

/// Shows object `object` with worldFromInstance * (the shape's own transform).
struct InstanceDescription {
  int object = 0;  ///< Index into `SceneDescription::objects`.
  Transform worldFromInstance;
  FileLocation location;
};

struct SceneDescription {
  int version = 4;                               ///< 3 or 4: defaults and some meanings differ.
  std::string versionReason;                     ///< Why, for people: 'film "rgb" (scene.pbrt:2:1)', "asked for".
  std::filesystem::path file, folder;            ///< Of the main scene; `folder` is where file names are searched.
  std::vector<std::filesystem::path> textFiles;  ///< That were read: the main one and those it includes.

  CameraDescription camera;
  Entity film, sampler, integrator, pixelFilter, accelerator;
  ParameterList options;  ///< Of v4's Option statements.

  /// [0] is the material of a shape before any Material statement: "diffuse", no parameters, no location.
  std::vector<MaterialDescription> materials;
  std::vector<TextureDescription> textures;
  std::vector<LightDescription> lights;
  std::vector<Entity> areaLights;
  std::vector<ShapeDescription> shapes;
  std::vector<ObjectDefinition> objects;
  std::vector<InstanceDescription> instances;

  /// For each name that MakeNamedMaterial gave, the index of the last material of that name, which a "mix" means by it.
  /// The names are views of the description's.
  std::unordered_map<std::string_view, int> MaterialsByName() const;
  /// Where a file named in a parameter lies: absolute names as they are, others relative to the main scene's folder, or
  /// else to the folder of the file that names it. Where neither exists, the first, for the message.
  std::filesystem::path ResolvePath(const std::string& name, const FileLocation& namedAt) const;
};

/// The integrator that the file asks for, by Dapple's name where it has one; may be empty.
inline std::string IntegratorNameOf(const SceneDescription& description) {
  return description.integrator.type == "volpath" ? "path" : description.integrator.type;
}

/// What "sampling" is for an infinite light with an image where the file does not say.
inline constexpr const char* kDefaultEnvironmentSampling = "importance";

/// True for lights from everywhere.
inline bool IsInfinite(const LightDescription& light) { return light.type == "infinite" || light.type == "exinfinite"; }

/// True for lights that shine by an image.
bool HasImage(const LightDescription& light);

/// Sets a parameter of every infinite light, at the light's place; returns how many there are.
int SetOnInfiniteLights(SceneDescription* description, const Parameter& parameter);

/// Sets a parameter of the infinite lights that have an image and not that parameter.
void SetDefaultOnEnvironmentMaps(SceneDescription* description, const Parameter& parameter);

}  // namespace dapple
