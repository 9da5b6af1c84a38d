#include "src/scene/scene.h"

#include <algorithm>
#include <cassert>

#include <fmt/format.h>

#include "src/geometry/outline.h"

namespace dapple {

namespace {

/// A sphere around the box, in double so that huge boxes keep their corners inside.
SceneExtent ExtentOf(const Bounds3& bounds) {
  if (bounds.isEmpty()) return {};
  const Vec3d low = ToDouble(bounds.min), high = ToDouble(bounds.max);
  SceneExtent extent;
  extent.center = ToFloat((low + high) / 2);
  const double reach = std::max(Distance(ToDouble(extent.center), low), Distance(ToDouble(extent.center), high));
  // A scene of a single point still needs a disk to emit from.
  const double least = std::max(1e-6 * std::max(MaxAbsComponent(low), MaxAbsComponent(high)), 1e-18);
  extent.radius = static_cast<float>(std::max(reach * (1 + 1e-6), least));
  return extent;
}

void AddMaterial(const MaterialFacts& material, SceneFacts* facts) {
  facts->hasSpecular |= material.hasSpecular;
  facts->hasNonSpecular |= material.hasNonSpecular;
  facts->hasTransmission |= material.hasTransmission;
  if (material.hasNonSpecular) facts->minRoughness = std::min(facts->minRoughness, material.minRoughness);
}

void AddGeometry(const std::vector<ScenePrimitive>& primitives, const std::vector<std::unique_ptr<Material>>& materials,
                 SceneFacts* facts) {
  std::vector<bool> isUsed(materials.size());
  for (const ScenePrimitive& primitive : primitives) {
    ++facts->shapes;
    facts->primitives += primitive.shape->PrimitiveCount();
    if (primitive.material >= 0) isUsed[static_cast<size_t>(primitive.material)] = true;
  }
  for (size_t i = 0; i < materials.size(); ++i)
    if (isUsed[i]) AddMaterial(materials[i]->Facts(), facts);
}

void AddLights(const std::vector<std::unique_ptr<Light>>& lights, const Vec3& center, SceneFacts* facts) {
  facts->lights = static_cast<int>(lights.size());
  double totalPower = 0;
  for (const auto& light : lights) totalPower += static_cast<double>(light->Power().Average());
  for (const auto& light : lights) {
    facts->hasDeltaLight |= light->IsDelta();
    facts->hasInfiniteLight |= light->IsInfinite();
    if (light->IsDelta()) continue;
    facts->hasAreaLight |= !light->IsInfinite();
    const double share = LightShare(*light, center);
    facts->largestLightShare = std::max(facts->largestLightShare, share);
    const bool carriesPower = static_cast<double>(light->Power().Average()) >= 0.01 * totalPower;
    if (carriesPower) facts->smallestLightShare = std::min(facts->smallestLightShare, share);
  }
}

/// Of a light whose flux is not a number nobody can say how much of it is to be drawn.
void CheckPower(const Light& light, const FileLocation& location) {
  const Color power = light.Power();
  if (power.IsFinite()) return;
  throw Error(location, fmt::format("light \"{}\" has the power ({}, {}, {}), expected finite numbers", light.Name(),
                                    power.r, power.g, power.b));
}

}  // namespace

Scene::Scene(SceneParts parts)
    : primitives_(std::move(parts.primitives)),
      materials_(std::move(parts.materials)),
      materialNames_(std::move(parts.materialNames)),
      lights_(std::move(parts.lights)),
      camera_(std::move(parts.camera)),
      settings_(std::move(parts.settings)),
      renderToWorld_(parts.renderToWorld) {
  facts_.instances = static_cast<int>(parts.instances.size());
  const std::vector<GeometryEntry> entries = GeometryEntries();
  accelerator_ = std::make_unique<Accelerator>(entries, parts.groups, parts.instances);
  extent_ = ExtentOf(accelerator_->Bounds());
  const bool needsOutline =
      std::any_of(lights_.begin(), lights_.end(), [](const auto& light) { return light->ComesFromOutside(); });
  std::optional<Outline> outline;
  if (needsOutline) outline.emplace(entries, parts.groups, parts.instances);
  PrepareLights({extent_.center, extent_.radius, outline ? &*outline : nullptr}, parts.lightLocations);
  resources_.images = parts.images;
  resources_.geometryBytes = accelerator_->MemoryBytes();
  for (const ScenePrimitive& primitive : primitives_) resources_.geometryBytes += primitive.shape->MemoryBytes();
  AddGeometry(primitives_, materials_, &facts_);
  AddLights(lights_, extent_.center, &facts_);
}

Scene::~Scene() = default;

std::vector<GeometryEntry> Scene::GeometryEntries() const {
  std::vector<GeometryEntry> entries;
  entries.reserve(primitives_.size());
  for (const ScenePrimitive& primitive : primitives_) {
    assert(primitive.shape && primitive.material < static_cast<int>(materials_.size()) &&
           primitive.light < static_cast<int>(lights_.size()));
    // A glowing interface is seen, but light passes it.
    entries.push_back({primitive.shape.get(), primitive.alpha.get(), primitive.material >= 0});
  }
  return entries;
}

void Scene::PrepareLights(const SceneExtent& extent, const std::vector<FileLocation>& locations) {
  const auto countTables = [this](const Light& light) {
    (light.IsInfinite() ? resources_.environmentTables : resources_.lightTables) += light.Tables();
  };
  std::vector<std::unique_ptr<Light>> emitting;
  std::vector<int> newIndex(lights_.size(), -1);
  for (size_t i = 0; i < lights_.size(); ++i) {
    lights_[i]->Prepare(extent);
    CheckPower(*lights_[i], i < locations.size() ? locations[i] : FileLocation());
    if (!(lights_[i]->Power().MaxComponent() > 0)) {
      countTables(*lights_[i]);
      ++facts_.blackLights;
      continue;
    }
    newIndex[i] = static_cast<int>(emitting.size());
    emitting.push_back(std::move(lights_[i]));
  }
  lights_ = std::move(emitting);
  for (ScenePrimitive& primitive : primitives_)
    if (primitive.light >= 0) primitive.light = newIndex[static_cast<size_t>(primitive.light)];
  for (size_t i = 0; i < lights_.size(); ++i) {
    if (lights_[i]->IsInfinite()) infiniteLights_.push_back(static_cast<int>(i));
    if (lights_[i]->WantsReceiver()) lightsThatWantReceivers_.push_back(lights_[i].get());
  }
  picker_ = std::make_unique<LightPicker>(lights_);
  resources_.choiceTables = picker_->Tables();
  const LightContext middle(extent.center);
  for (size_t i = 0; i < lights_.size(); ++i) {
    if (lights_.size() > 1) lights_[i]->PrepareChoice(picker_->ProbabilityFor(middle, static_cast<int>(i)));
    countTables(*lights_[i]);
  }
}

Ray Scene::ShadowRay(const SurfaceInteraction& from, const LiSample& to) const {
  return SpawnRayTo(from, to.p, to.pError, to.n);
}

std::string Scene::MaterialName(int index) const {
  const auto i = static_cast<size_t>(index);
  return i < materialNames_.size() ? materialNames_[i] : std::to_string(index);
}

const Material* Scene::MaterialAt(const SurfaceInteraction& hit) const {
  const int material = primitives_[static_cast<size_t>(hit.shape)].material;
  return material >= 0 ? materials_[static_cast<size_t>(material)].get() : nullptr;
}

}  // namespace dapple
