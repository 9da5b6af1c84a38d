#include "tests/lights/light_cases.h"

#include "lights/area_light.h"
#include "lights/distant_light.h"
#include "lights/environment_light.h"
#include "lights/goniometric_light.h"
#include "lights/point_light.h"
#include "lights/projection_light.h"
#include "lights/spot_light.h"
#include "src/geometry/bilinear_mesh.h"
#include "src/geometry/cylinder.h"
#include "src/geometry/disk.h"
#include "src/geometry/sphere.h"
#include "src/geometry/triangle_mesh.h"
#include "src/materials/image_texture.h"

namespace dapple {

namespace {

// Four unlike triangles, three of them around a corner that sticks out.
std::unique_ptr<Shape> Tent() {
  return std::make_unique<TriangleMesh>(
      std::vector<Vec3>{{0, 0, 2.f}, {1, 0, 1.5f}, {0, 1, 1.5f}, {-1, -1, 1.5f}, {-1.5f, 1, 1.25f}},
      std::vector<Vec3>{}, std::vector<Vec2>{}, std::vector<int>{0, 1, 2, 0, 2, 3, 0, 3, 1, 2, 4, 3});
}

class StripedTexture final : public ColorTexture {
 public:
  Color Evaluate(const TextureContext& at) const override {
    return std::fmod(at.uv.x, 0.5f) < 0.25f ? Color(4, 2, 1) : Color(0, 0, at.uv.y);
  }
};

Transform SomeRotation() { return Transform::Rotate(40, {1, 2, 3}) * Transform::Scale({1, -1, 1}); }

void AddImagePointLights(std::vector<LightCase>* cases) {
  const Vec3 position(1, 0, 2);
  const auto add = [&](const std::string& name, std::unique_ptr<Light> light) {
    cases->push_back({name, nullptr, std::move(light)});
  };
  const auto projection = [&](const std::string& name, const Image& image, double fov) {
    // Looks down on the scene, a little aslant.
    const Transform down = Transform::Rotate(170, {1, 0.2, 0}) * Transform::Scale({2, -2, 2});
    add("projection " + name, std::make_unique<ProjectionLight>(position, down, image, fov, Color(1, 0.5f, 2)));
  };
  projection("narrow", RandomEnvironment(12, 9, 4), 5);
  projection("wide", RandomEnvironment(16, 9, 5), 60);
  projection("upright of few pixels", RandomEnvironment(2, 3, 6), 120);
  projection("of one pixel", Image(1, 1, {"Y"}, {2.f}), 150);
  const auto goniometric = [&](const std::string& name, const Image& image, EnvironmentMapping mapping) {
    add("goniometric " + name,
        std::make_unique<GoniometricLight>(position, SomeRotation(), image, mapping, Color(1, 0.5f, 2)));
  };
  goniometric("lat-long", RandomEnvironment(16, 8, 7), EnvironmentMapping::LatLong);
  goniometric("equal-area", RandomEnvironment(8, 8, 8), EnvironmentMapping::EqualArea);
  goniometric("of one pixel", Image(1, 1, {"Y"}, {2.f}), EnvironmentMapping::EqualArea);
}

void AddAreaLights(std::vector<LightCase>* cases) {
  const auto add = [&](const std::string& name, std::unique_ptr<Shape> shape, bool twoSided,
                       ColorTexturePtr texture = nullptr) {
    if (!texture) texture = std::make_shared<ConstantTexture<Color>>(Color(3, 2, 1));
    auto light = std::make_unique<AreaLight>(shape.get(), std::move(texture), twoSided);
    cases->push_back({name, std::move(shape), std::move(light)});
  };
  const auto stripes = std::make_shared<StripedTexture>();
  const auto image = std::make_shared<ImageColorTexture>(std::make_shared<Image>(RandomEnvironment(8, 5, 9)),
                                                         std::make_shared<UvMapping>());
  const Transform place = Transform::Translate({0.5, 0.25, 2}) * Transform::Rotate(150, {1, 0.2, 0});
  add("sphere", std::make_unique<Sphere>(place, false, 0.5), false);
  add("sphere inside out", std::make_unique<Sphere>(place, true, 3), false);
  add("sphere, small and two-sided", std::make_unique<Sphere>(place, false, 0.01), true);
  const auto ellipsoid = [&](const Vec3d& axes) {
    return std::make_unique<Sphere>(place * Transform::Scale(axes), false, 0.75);
  };
  add("ellipsoid", ellipsoid({1, 0.5, 0.25}), false);
  add("ellipsoid, long", ellipsoid({0.25, 0.25, 1}), false);
  add("ellipsoid, flat and two-sided", ellipsoid({1, 1, 0.3}), true);
  add("disk", std::make_unique<Disk>(place, false, 0, 0.75, 0.25, 270), false);
  add("disk two-sided", std::make_unique<Disk>(place, false, 0, 0.75, 0, 360), true);
  add("disk, small", std::make_unique<Disk>(place, true, 0.1, 0.05, 0, 360), false);
  add("cylinder", std::make_unique<Cylinder>(place, false, 0.25, -0.5, 0.75, 360), true);
  add("cylinder, half and flat", std::make_unique<Cylinder>(place, false, 0.75, 0, 0.125, 180), false);
  add("cylinder, tilted",
      std::make_unique<Cylinder>(place * Transform::Rotate(70, {1, 0, 0}), true, 0.15, -0.5, 0.5, 360), true);
  add("triangles", Tent(), false);
  add("triangles two-sided", Tent(), true);
  add("triangle, alone and textured",
      std::make_unique<TriangleMesh>(std::vector<Vec3>{{0, 0, 2.25f}, {0.25f, 1, 2.5f}, {1, 0.25f, 2}},
                                     std::vector<Vec3>{}, std::vector<Vec2>{}, std::vector<int>{0, 1, 2}),
      true, stripes);
  add("triangles textured by an image", Tent(), false, image);
  add("sphere textured by an image", std::make_unique<Sphere>(place, false, 0.5), false, image);
  add("disk textured by an image", std::make_unique<Disk>(place, false, 0, 0.75, 0.25, 270), true, image);
  add("cylinder textured by an image", std::make_unique<Cylinder>(place, false, 0.25, -0.5, 0.75, 360), false, image);
  const std::vector<Vec3> corners = {{0, 0, 2}, {1, 0, 2}, {0, 1, 2}, {1.5f, 1.25f, 2}};
  const auto patch = [&] {
    return std::make_unique<BilinearMesh>(corners, std::vector<Vec3>{}, std::vector<Vec2>{},
                                          std::vector<int>{0, 1, 2, 3}, true);
  };
  add("bilinear", patch(), false);
  add("bilinear two-sided", patch(), true);
  add("bilinear textured", patch(), true, stripes);
}

}  // namespace

Image RandomEnvironment(int width, int height, unsigned seed) {
  RandomNumbers random(seed);
  Image image = Image::Rgb(width, height);
  const auto value = [&] { return static_cast<float>(std::max(0.0, random.Get1D() - 0.25)); };
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) image.SetColor(x, y, {value(), value(), value()});
  }
  image.SetColor(width / 3, height / 3, Color(20, 30, 40));
  return image;
}

std::optional<SurfaceInteraction> FirstHit(const Shape& shape, const Ray& ray) {
  std::optional<PrimitiveHit> first;
  for (int i = 0; i < shape.PrimitiveCount(); ++i) {
    std::optional<PrimitiveHit> hit = shape.Intersect(ray, i);
    if (hit && (!first || hit->t < first->t)) {
      first = hit;
      first->primitive = i;
    }
  }
  if (!first) return std::nullopt;
  SurfaceInteraction interaction = shape.Interact(ray, *first);
  interaction.primitive = first->primitive;
  return interaction;
}

std::vector<LightCase> AllLights() {
  std::vector<LightCase> cases;
  const auto add = [&](const std::string& name, std::unique_ptr<Light> light) {
    cases.push_back({name, nullptr, std::move(light)});
  };
  add("point", std::make_unique<PointLight>(Vec3(1, 0, 2), Color(3, 2, 1)));
  add("point, far out", std::make_unique<PointLight>(Vec3(-2, 2, 3), Color(0, 500, 2)));
  add("point, near and faint", std::make_unique<PointLight>(Vec3(0.2f, 0, 0.5f), Color(1e-6f)));
  for (const SpotFalloff falloff : {SpotFalloff::PbrtV3, SpotFalloff::PbrtV4}) {
    const std::string version = falloff == SpotFalloff::PbrtV3 ? " v3" : " v4";
    for (const Vec2d& angles : {Vec2d(0.01, 0.005), Vec2d(30, 25), Vec2d(30, 0), Vec2d(30, 30), Vec2d(120, 80),
                                Vec2d(180, 0), Vec2d(180, 180)}) {
      add("spot " + std::to_string(angles.x) + " " + std::to_string(angles.y) + version,
          std::make_unique<SpotLight>(Vec3(1, 0, 2), Vec3(-0.2f, 0.1f, -2), Color(3, 2, 1), angles.x, angles.y,
                                      falloff));
    }
  }
  add("distant", std::make_unique<DistantLight>(Vec3(1, 2, -4), Color(3, 2, 1)));
  add("distant, along an axis", std::make_unique<DistantLight>(Vec3(0, 0, -1), Color(1e-4f)));
  add("distant, from below", std::make_unique<DistantLight>(Vec3(-3, 1, 0.5f), Color(0, 1e5f, 2)));
  add("uniform environment", std::make_unique<UniformEnvironmentLight>(Color(3, 2, 1)));
  add("uniform environment, faint", std::make_unique<UniformEnvironmentLight>(Color(1e-6f)));
  add("uniform environment, of a colour", std::make_unique<UniformEnvironmentLight>(Color(0, 1e5f, 2)));
  using Mapping = EnvironmentMapping;
  add("lat-long environment", std::make_unique<EnvironmentLight>(RandomEnvironment(16, 8, 1), SomeRotation(),
                                                                 Color(1, 0.5f, 2), Mapping::LatLong));
  add("lat-long environment, uniform emission",
      std::make_unique<EnvironmentLight>(RandomEnvironment(16, 8, 1), SomeRotation(), Color(1, 0.5f, 2),
                                         Mapping::LatLong, EnvironmentOptions{EnvironmentEmission::Uniform}));
  add("lat-long environment of one pixel",
      std::make_unique<EnvironmentLight>(RandomEnvironment(1, 1, 2), SomeRotation(), Color(1), Mapping::LatLong));
  add("equal-area environment",
      std::make_unique<EnvironmentLight>(RandomEnvironment(8, 8, 3), SomeRotation(), Color(1), Mapping::EqualArea));
  add("equal-area environment, uniform emission",
      std::make_unique<EnvironmentLight>(RandomEnvironment(8, 8, 3), SomeRotation(), Color(1), Mapping::EqualArea,
                                         EnvironmentOptions{EnvironmentEmission::Uniform}));
  AddImagePointLights(&cases);
  AddAreaLights(&cases);
  for (LightCase& c : cases) c.light->Prepare(kTestExtent);
  return cases;
}

}  // namespace dapple
