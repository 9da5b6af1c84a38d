// A scene, ready to trace: immutable and shared by all threads.
//
// Built from plain parts (see `SceneParts`), by a reader or by hand in a test. All of it is in render space: the world
// moved by `renderToWorld` so that what the camera sees is near the origin.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "lights/light.h"
#include "lights/light_picker.h"
#include "src/geometry/accelerator.h"
#include "src/materials/material.h"
#include "src/scene/camera.h"
#include "src/scene/render_settings.h"
#include "src/scene/scene_facts.h"
#include "src/scene/scene_resources.h"

namespace dapple {

/// One shape with what it is made of. Indices are into the lists of `SceneParts`; -1: none.
struct ScenePrimitive {
  std::unique_ptr<Shape> shape;
  int material = -1;  ///< -1: an interface that light passes unchanged
  int light = -1;     ///< area light of this shape
  std::shared_ptr<const HitFilter> alpha;
};

/// What a scene is made of, in render space. The camera must be there.
struct SceneParts {
  std::vector<ScenePrimitive> primitives;
  std::vector<GeometryGroup> groups;
  std::vector<GeometryInstance> instances;
  std::vector<std::unique_ptr<Material>> materials;
  std::vector<std::string> materialNames;  ///< for messages: one a material, or none at all
  std::vector<std::unique_ptr<Light>> lights;
  std::vector<FileLocation> lightLocations;  ///< for messages: one a light, or none at all
  std::unique_ptr<Camera> camera;
  RenderSettings settings;
  Transform renderToWorld;
  ImageUse images;  ///< that were opened for the parts
};

/// Tracing is safe from any number of threads.
class Scene {
 public:
  /// Prepares the lights, drops those that emit nothing (so indices into `Lights()` may differ from the parts'), and
  /// builds the accelerator. Throws `Error` where the geometry cannot be traced, or the power of a light is infinite or
  /// not a number.
  explicit Scene(SceneParts parts);
  ~Scene();

  /// The nearest surface along the ray.
  std::optional<SurfaceInteraction> Intersect(const Ray& ray) const { return accelerator_->Intersect(ray); }
  /// True where nothing stands along the ray up to its end.
  bool Unoccluded(const Ray& ray) const { return !accelerator_->Occluded(ray); }
  /// The ray that joins a surface to sampled light, for `Unoccluded`.
  Ray ShadowRay(const SurfaceInteraction& from, const LiSample& to) const;

  /// Null: an interface that light passes unchanged.
  const Material* MaterialAt(const SurfaceInteraction& hit) const;
  /// For messages: "\"glass\" (scene.pbrt:12:1)", or its number.
  std::string MaterialName(int index) const;
  /// The place in `Lights()` of the light that this surface is; -1 where it emits nothing.
  int AreaLightAt(const SurfaceInteraction& hit) const { return primitives_[static_cast<size_t>(hit.shape)].light; }

  /// Those that emit anything, prepared.
  const std::vector<std::unique_ptr<Light>>& Lights() const { return lights_; }
  /// The places in `Lights()` of those that rays find by leaving the scene.
  const std::vector<int>& InfiniteLights() const { return infiniteLights_; }
  /// Those that want to know how a receiver scatters (`Light::WantsReceiver`): seldom any.
  const std::vector<const Light*>& LightsThatWantReceivers() const { return lightsThatWantReceivers_; }
  /// Chooses among `Lights()`, by their places there.
  const LightPicker& Picker() const { return *picker_; }
  const Camera& GetCamera() const { return *camera_; }
  /// Shapes in the order of `SurfaceInteraction::shape`.
  const std::vector<ScenePrimitive>& Primitives() const { return primitives_; }
  /// What the scene says about its rendering, and what it has.
  const RenderSettings& Settings() const { return settings_; }
  const SceneFacts& Facts() const { return facts_; }
  /// What it had to build for that; of the lights, those that emit nothing too.
  const SceneResources& Resources() const { return resources_; }
  /// A sphere around all that can be hit.
  const SceneExtent& Extent() const { return extent_; }
  /// From render space to the file's world.
  const Transform& RenderToWorld() const { return renderToWorld_; }

 private:
  std::vector<GeometryEntry> GeometryEntries() const;
  void PrepareLights(const SceneExtent& extent, const std::vector<FileLocation>& locations);

  std::vector<ScenePrimitive> primitives_;
  std::vector<std::unique_ptr<Material>> materials_;
  std::vector<std::string> materialNames_;
  std::vector<std::unique_ptr<Light>> lights_;
  std::vector<int> infiniteLights_;
  std::vector<const Light*> lightsThatWantReceivers_;
  std::unique_ptr<Camera> camera_;
  RenderSettings settings_;
  Transform renderToWorld_;
  std::unique_ptr<Accelerator> accelerator_;
  std::unique_ptr<LightPicker> picker_;
  SceneExtent extent_;
  SceneFacts facts_;
  SceneResources resources_;
};

}  // namespace dapple
