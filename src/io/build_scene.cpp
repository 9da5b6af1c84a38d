#include "src/io/build_scene.h"

#include <algorithm>

#include <fmt/format.h>

#include "src/io/build_camera.h"
#include "src/io/build_film.h"
#include "src/io/build_lights.h"
#include "src/io/build_materials.h"
#include "src/io/build_shapes.h"
#include "src/io/pbrt_parser.h"
#include "src/scene/alpha_filter.h"

namespace dapple {

namespace {

/// Puts shapes, lights and instances into `SceneParts`.
class Assembler {
 public:
  Assembler(const BuildContext& context, SceneParts* parts)
      : context_(context), values_(context), materials_(values_), parts_(parts) {}

  void AddLights() {
    for (const LightDescription& light : context_.description.lights)
      AddLight(light, [&] { return BuildLight(values_, light); });
  }

  void AddShapes() {
    for (const ShapeDescription& shape : context_.description.shapes)
      AddShape(shape, context_.renderFromWorld, UsableAreaLight(shape));
  }

  void AddInstances() {
    groups_.resize(context_.description.objects.size());
    for (const InstanceDescription& instance : context_.description.instances) AddInstance(instance);
  }

  void Finish() {
    parts_->materials = materials_.Take();
    parts_->materialNames = materials_.TakeNames();
    parts_->images = values_.Images();
  }

 private:
  struct Group {
    int index = -1;  // in the parts; -1: not built yet, or empty
    Transform objectFromGroup;
  };

  template <typename Build>
  void AddLight(const Entity& light, Build build) {
    parts_->lights.push_back(AtLocation(light.location, build));
    parts_->lightLocations.push_back(light.location);
  }
  void AddShape(const ShapeDescription& shape, const Transform& targetFromWorld, const Entity* areaLight);
  const Entity* UsableAreaLight(const ShapeDescription& shape) const;
  FloatTexturePtr FindAlpha(const ShapeDescription& shape, bool isLight);
  Group BuildGroup(const ObjectDefinition& object);
  void AddInstance(const InstanceDescription& instance);

  const BuildContext& context_;
  Values values_;
  Materials materials_;
  SceneParts* parts_;
  std::vector<std::optional<Group>> groups_;  // by index of the object definition
};

/// Null where the shape is no light, or one that pbrt ignores.
const Entity* Assembler::UsableAreaLight(const ShapeDescription& shape) const {
  if (shape.areaLight < 0) return nullptr;
  const Entity& light = context_.description.areaLights[static_cast<size_t>(shape.areaLight)];
  if (context_.IsV3() || !materials_.IsInterface(shape.material)) return &light;
  context_.diagnostics.Warn(shape.location,
                            "a shape with an interface material emits no light; its area light is ignored");
  return nullptr;
}

/// The texture that cuts holes; null where there are none.
FloatTexturePtr Assembler::FindAlpha(const ShapeDescription& shape, bool isLight) {
  if (shape.params.Has("shadowalpha"))
    context_.diagnostics.Warn(shape.params.LocationOf("shadowalpha", shape.location),
                              "parameter \"shadowalpha\" is not supported; shadows follow \"alpha\"");
  FloatTexturePtr alpha = values_.FindFloat(shape.params, "alpha");
  if (!alpha) return nullptr;
  if (context_.IsV3()) alpha = std::make_shared<BinaryAlpha>(alpha);
  if (!alpha->IsConstant()) return alpha;
  const float coverage = Coverage(*alpha, TextureContext());
  if (coverage == 1) return nullptr;
  if (isLight && coverage == 0) {
    context_.diagnostics.Warn(shape.params.LocationOf("alpha", shape.location),
                              "an area light that cannot be seen is not supported; it will be seen");
    return nullptr;
  }
  return alpha;
}

void Assembler::AddShape(const ShapeDescription& shape, const Transform& targetFromWorld, const Entity* areaLight) {
  const int material = materials_.IndexOf(shape.material);
  if (material < 0 && !areaLight) {
    shape.params.IgnoreAll();
    return;
  }
  const FloatTexturePtr alpha = FindAlpha(shape, areaLight != nullptr);
  const std::shared_ptr<const HitFilter> filter = alpha ? std::make_shared<AlphaFilter>(alpha) : nullptr;
  for (std::unique_ptr<Shape>& built : BuildShapes(context_, shape, targetFromWorld)) {
    ScenePrimitive primitive;
    primitive.shape = std::move(built);
    primitive.material = material;
    primitive.alpha = filter;
    if (areaLight) {
      primitive.light = static_cast<int>(parts_->lights.size());
      AddLight(*areaLight, [&] { return BuildAreaLight(values_, *areaLight, *primitive.shape, alpha); });
    }
    parts_->primitives.push_back(std::move(primitive));
  }
}

/// A point of the shape, in the space it is defined for, that is cheap to tell.
Vec3d PointOf(const ShapeDescription& shape) {
  for (const Parameter& parameter : shape.params.All())
    if (parameter.name == "P" && parameter.type == ParameterType::Point3)
      return shape.worldFromShape.Point({parameter.numbers[0], parameter.numbers[1], parameter.numbers[2]});
  return shape.worldFromShape.Point(Vec3d(0));
}

/// An object's shapes become floats in a space of the group's own, whose origin lies at the object: it may be defined
/// far from the origin of its space.
Assembler::Group Assembler::BuildGroup(const ObjectDefinition& object) {
  Group group;
  if (object.shapes.empty()) return group;
  const Vec3d origin = PointOf(object.shapes.front());
  group.objectFromGroup = Transform::Translate(origin);
  const auto first = static_cast<int>(parts_->primitives.size());
  for (const ShapeDescription& shape : object.shapes) {
    if (shape.areaLight >= 0)
      context_.diagnostics.Warn(shape.location,
                                "area lights in object instances are not supported; the shape emits none");
    AddShape(shape, Transform::Translate(-origin), nullptr);
  }
  GeometryGroup members;
  for (int i = first; i < static_cast<int>(parts_->primitives.size()); ++i) members.shapes.push_back(i);
  if (members.shapes.empty()) return group;
  group.index = static_cast<int>(parts_->groups.size());
  parts_->groups.push_back(std::move(members));
  return group;
}

void Assembler::AddInstance(const InstanceDescription& instance) {
  if (instance.worldFromInstance.IsSingular()) {
    context_.diagnostics.Warn(instance.location, "the instance is left out: its transform has no inverse");
    return;
  }
  std::optional<Group>& group = groups_[static_cast<size_t>(instance.object)];
  if (!group) group = BuildGroup(context_.description.objects[static_cast<size_t>(instance.object)]);
  if (group->index < 0) return;
  const Transform groupToRender = context_.renderFromWorld * instance.worldFromInstance * group->objectFromGroup;
  parts_->instances.push_back({group->index, groupToRender, instance.location});
}

void WarnOfBlackImage(const SceneDescription& description, const SceneParts& parts, Diagnostics& diagnostics) {
  const FileLocation file(description.file.string());
  if (parts.lights.empty()) diagnostics.Warn(file, "the scene has no light; its image is black");
  // An infinite light is seen by itself.
  const bool showsLight = std::any_of(description.lights.begin(), description.lights.end(), IsInfinite);
  if (parts.primitives.empty() && !showsLight)
    diagnostics.Warn(file, "the scene has no shape to be seen; its image is black");
}

}  // namespace

SceneParts BuildSceneParts(const SceneDescription& description, const BuildOptions& options, Diagnostics& diagnostics) {
  const BuildContext context{description, options, diagnostics, RenderFromWorld(description)};
  SceneParts parts;
  parts.renderToWorld = context.renderFromWorld.Inverse();
  parts.settings = BuildSettings(context, options);
  parts.camera = BuildCamera(context, parts.settings.resolution);
  Assembler assembler(context, &parts);
  assembler.AddLights();
  assembler.AddShapes();
  assembler.AddInstances();
  assembler.Finish();
  WarnOfBlackImage(description, parts, diagnostics);
  return parts;
}

std::unique_ptr<Scene> BuildScene(const SceneDescription& description, const BuildOptions& options,
                                  Diagnostics& diagnostics) {
  return std::make_unique<Scene>(BuildSceneParts(description, options, diagnostics));
}

std::unique_ptr<Scene> LoadScene(const std::filesystem::path& path, const BuildOptions& options,
                                 Diagnostics& diagnostics) {
  ParseOptions parseOptions;
  parseOptions.pbrtVersion = options.pbrtVersion;
  return BuildScene(ParsePbrtFile(path, parseOptions, diagnostics), options, diagnostics);
}

}  // namespace dapple
