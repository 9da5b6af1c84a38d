#include "src/io/build_lights.h"

#include <fmt/format.h>

#include "lights/area_light.h"
#include "lights/distant_light.h"
#include "lights/environment_light.h"
#include "lights/equal_area_mapping.h"
#include "lights/goniometric_light.h"
#include "lights/point_light.h"
#include "lights/projection_light.h"
#include "lights/spot_light.h"
#include "src/base/numerics.h"
#include "src/io/value_bounds.h"

namespace dapple {

namespace {

/// The factor of a light's colour.
Color GetScale(const Values& values, const Entity& light) {
  if (values.Context().IsV3()) return values.GetConstantColor(light.params, "scale", Color(1), RgbUse::kEmission);
  const double scale = light.params.GetFloat("scale", 1);
  if (scale < 0)
    throw Error(light.params.LocationOf("scale", light.location),
                fmt::format("parameter \"scale\" is {}, expected 0 or more", scale));
  return Color(static_cast<float>(scale));
}

/// `name`, the light's colour, with its scale.
Color GetEmission(const Values& values, const Entity& light, std::string_view name) {
  return GetScale(values, light) * values.GetConstantColor(light.params, name, Color(1), RgbUse::kEmission);
}

/// The factor by which a photometric target of pbrt-v4 ("power", "illuminance") scales a light that would reach
/// `reached` with luminance one. 1 where there is no such target.
float TargetFactor(const BuildContext& context, const Entity& light, std::string_view name, double reached) {
  if (context.IsV3()) return 1;
  const double target = light.params.GetFloat(name, -1);
  return target > 0 && reached > 0 ? static_cast<float>(target / reached) : 1;
}

/// `emission`, which a light is made with; an Error where it is beyond the range of numbers. (A power that is beyond it
/// is cut there: such a light is drawn, and what it gives is too much for the film.)
Color InRange(const Entity& light, const Color& emission) {
  if (emission.IsFinite()) return emission;
  throw Error(light.location, fmt::format("light \"{}\" sends ({}, {}, {}), expected finite numbers: its colour, scale "
                                          "or power is too large",
                                          light.type, emission.r, emission.g, emission.b));
}

void CheckDirection(const LightDescription& light, const Vec3d& direction) {
  if (LengthSquared(direction) > 0) return;
  throw Error(light.params.LocationOf("to", light.location),
              fmt::format("light \"{}\" has no direction, expected \"from\" and \"to\" to differ", light.type));
}

std::unique_ptr<Light> BuildPoint(const Values& values, const LightDescription& light) {
  const BuildContext& context = values.Context();
  const Vec3d from = light.params.GetPoint3("from", Vec3d(0));
  // pbrt-v3 adds "from" behind the transform, pbrt-v4 transforms it.
  const Vec3d world = context.IsV3() ? light.worldFromLight.Point(Vec3d(0)) + from : light.worldFromLight.Point(from);
  const Color I = GetEmission(values, light, "I") * TargetFactor(context, light, "power", 4 * kPiD);
  return std::make_unique<PointLight>(ToFloat(context.renderFromWorld.Point(world)), InRange(light, I));
}

std::unique_ptr<Light> BuildSpot(const Values& values, const LightDescription& light) {
  const BuildContext& context = values.Context();
  const Vec3d from = light.params.GetPoint3("from", Vec3d(0)), to = light.params.GetPoint3("to", {0, 0, 1});
  const Transform renderFromLight = context.renderFromWorld * light.worldFromLight;
  const Vec3d axis = renderFromLight.Vector(to - from);
  CheckDirection(light, axis);
  const double cone = light.params.GetFloat("coneangle", 30), delta = light.params.GetFloat("conedeltaangle", 5);
  const double cosEnd = std::cos(Radians(cone)), cosStart = std::cos(Radians(cone - delta));
  const double reached = 2 * kPiD * ((1 - cosStart) + (cosStart - cosEnd) / 2);
  const Color I = GetEmission(values, light, "I") * TargetFactor(context, light, "power", reached);
  return std::make_unique<SpotLight>(ToFloat(renderFromLight.Point(from)), ToFloat(Normalize(axis)), InRange(light, I),
                                     cone, cone - delta, context.IsV3() ? SpotFalloff::PbrtV3 : SpotFalloff::PbrtV4);
}

std::unique_ptr<Light> BuildDistant(const Values& values, const LightDescription& light) {
  const Vec3d from = light.params.GetPoint3("from", Vec3d(0)), to = light.params.GetPoint3("to", {0, 0, 1});
  const Vec3d travel = light.worldFromLight.Vector(to - from);
  CheckDirection(light, travel);
  const Color L = GetEmission(values, light, "L") * TargetFactor(values.Context(), light, "illuminance", 1);
  return std::make_unique<DistantLight>(ToFloat(Normalize(travel)), InRange(light, L));
}

/// The illuminance, with luminance weights, of the map's hemisphere z > 0 on the plane z = 0, as pbrt-v4 reckons it:
/// half of what it is (each texel covers 4 pi / n there, not 2 pi / n). Scenes are made with pbrt's images in view.
double PbrtUpperIlluminance(const Image& map) {
  double sum = 0;
  for (int y = 0; y < map.Height(); ++y)
    for (int x = 0; x < map.Width(); ++x) {
      const Vec3d w = EqualAreaSquareToSphere({(x + 0.5) / map.Width(), (y + 0.5) / map.Height()});
      if (w.z > 0) sum += static_cast<double>(map.ColorAt(x, y).Luminance()) * w.z;
    }
  return sum * 2 * kPiD / (static_cast<double>(map.Width()) * map.Height());
}

/// One white pixel where the light has no image.
Image WhitePixel() { return {1, 1, {"Y"}, {1.f}}; }

/// The image that a light shines by, fit for it; square in pbrt-v4 where it is of the sphere. White where `fileName` is
/// null, and where `factor`, by which it is multiplied, is black: then no file is opened.
Image ReadEmission(Values& values, const Parameter* fileNameOrNull, const Color& factor, bool isOfSphere) {
  if (!fileNameOrNull || factor.IsBlack()) return WhitePixel();
  const Parameter& fileName = *fileNameOrNull;
  const BuildContext& context = values.Context();
  // Not through the cache, whose repair would put out an infinitely bright sun.
  const Image file = values.ReadImageOnce(fileName, ColorEncoding::SRgb());
  if (isOfSphere && !context.IsV3() && file.Width() != file.Height())
    throw Error(fileName.location,
                fmt::format("environment map \"{}\" is of {} x {} pixels, expected a square one: pbrt-v4 maps are "
                            "equal-area (octahedral), and \"imgtool makeequiarea\" makes them from latitude-longitude",
                            fileName.strings[0], file.Width(), file.Height()));
  int64_t repaired = 0;
  Image image = EnvironmentMap::Repair(file, &repaired);
  if (repaired > 0)
    context.diagnostics.Warn(fileName.location,
                             fmt::format("{} pixels of \"{}\" are no radiance (negative, infinite or "
                                         "not a number) and were mended",
                                         repaired, fileName.strings[0]));
  return image;
}

EnvironmentMapping MappingOf(const BuildContext& context) {
  return context.IsV3() ? EnvironmentMapping::LatLong : EnvironmentMapping::EqualArea;
}

/// Next-event samples of an infinite light, as pbrt-v3 spells them.
int GetSampleCount(const LightDescription& light) {
  const char* const name = light.params.Has("samples") ? "samples" : "nsamples";
  CheckBounds(light.params, name, {.least = 1, .most = kMostLightSamples});
  return light.params.GetInt(name, 1);
}

/// How an infinite light is sampled: mostly Dapple's own parameters.
EnvironmentOptions GetEnvironmentOptions(const BuildContext& context, const LightDescription& light) {
  EnvironmentOptions options;
  options.samples = GetSampleCount(light);
  if (context.options.lightSamples) options.samples = *context.options.lightSamples;
  const std::string emission = light.params.GetString("emission", "importance");
  if (emission == "uniform") {
    options.emission = EnvironmentEmission::Uniform;
  } else if (emission != "importance") {
    FailUnknownName(light.params.LocationOf("emission", light.location), "emission", emission,
                    {"importance", "uniform"});
  }
  const std::string sampling = light.params.GetString("sampling", kDefaultEnvironmentSampling);
  static const std::pair<const char*, EnvironmentSampling> kSamplings[] = {
      {"uniform", EnvironmentSampling::Uniform},         {"cosine", EnvironmentSampling::Cosine},
      {"importance", EnvironmentSampling::Importance},   {"irradiance", EnvironmentSampling::Irradiance},
      {"compensated", EnvironmentSampling::Compensated}, {"structured", EnvironmentSampling::Structured},
      {"product", EnvironmentSampling::Product}};
  std::vector<std::string> names;
  for (const auto& [name, value] : kSamplings) {
    names.emplace_back(name);
    if (sampling == name) options.sampling = value;
  }
  if (std::find(names.begin(), names.end(), sampling) == names.end())
    FailUnknownName(light.params.LocationOf("sampling", light.location), "sampling", sampling, names);
  // The map's own table, which it emits from, serves what little is asked then.
  if (!context.options.drawsTowardLights) options.sampling = EnvironmentSampling::Importance;
  return options;
}

std::unique_ptr<Light> BuildEnvironmentMap(Values& values, const LightDescription& light, const Parameter& fileName,
                                           const EnvironmentOptions& options) {
  const BuildContext& context = values.Context();
  const bool isV3 = context.IsV3();
  Color scale = isV3 ? GetEmission(values, light, "L") : GetScale(values, light);
  const Image map = ReadEmission(values, &fileName, scale, true);
  if (!isV3 && light.params.Has("illuminance"))
    scale *= TargetFactor(context, light, "illuminance", PbrtUpperIlluminance(map));
  return std::make_unique<EnvironmentLight>(map, context.renderFromWorld * light.worldFromLight, InRange(light, scale),
                                            MappingOf(context), options);
}

std::unique_ptr<Light> BuildInfinite(Values& values, const LightDescription& light) {
  const BuildContext& context = values.Context();
  if (const Parameter* portal = light.params.Find("portal"))
    context.diagnostics.Warn(portal->location, "a portal is not supported; the light shines from everywhere");
  const EnvironmentOptions options = GetEnvironmentOptions(context, light);
  const Parameter* fileName = light.params.Find(context.IsV3() ? "mapname" : "filename");
  if (fileName) {
    if (!context.IsV3() && light.params.Has("L"))
      throw Error(fileName->location, "both \"L\" and \"filename\" are given, expected one of them");
    return BuildEnvironmentMap(values, light, *fileName, options);
  }
  const Color L = InRange(light, GetEmission(values, light, "L") * TargetFactor(context, light, "illuminance", kPiD));
  // The same from everywhere: both ways to emit are one. How directions are drawn counts only where any are.
  if (!context.options.drawsTowardLights || !light.params.Has("sampling")) {
    auto uniform = std::make_unique<UniformEnvironmentLight>(L);
    uniform->SetSampleCount(options.samples);
    return uniform;
  }
  return std::make_unique<EnvironmentLight>(WhitePixel(), Transform(), L, MappingOf(context), options);
}

/// `make(factor)` builds a light by an image; the factor is such that pbrt-v4's "power" is reached.
template <typename Make>
std::unique_ptr<Light> BuildToPower(const BuildContext& context, const LightDescription& light, const Color& factor,
                                    Make make) {
  double reached = 0;
  if (!context.IsV3() && light.params.Has("power")) reached = static_cast<double>(make(Color(1))->Power().Luminance());
  return make(InRange(light, factor * TargetFactor(context, light, "power", reached)));
}

/// In pbrt-v4 the image of a goniometric light has no colours.
Image AverageOfColors(const Image& image) {
  Image gray(image.Width(), image.Height(), {"Y"});
  for (int y = 0; y < image.Height(); ++y)
    for (int x = 0; x < image.Width(); ++x) gray.At(x, y, 0) = image.ColorAt(x, y).Average();
  return gray;
}

std::unique_ptr<Light> BuildGoniometric(Values& values, const LightDescription& light) {
  const BuildContext& context = values.Context();
  const Parameter* fileName = light.params.Find(context.IsV3() ? "mapname" : "filename");
  const Color factor = GetEmission(values, light, "I");
  Image image = ReadEmission(values, fileName, factor, true);
  if (!context.IsV3()) image = AverageOfColors(image);
  // The map's z, around which its angles run, is the light's y.
  const Transform lightFromMap = Transform::FromRows({1, 0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 1});
  const Transform renderFromLight = context.renderFromWorld * light.worldFromLight;
  const Vec3 position = ToFloat(renderFromLight.Point(Vec3d(0)));
  return BuildToPower(context, light, factor, [&](const Color& scale) {
    return std::make_unique<GoniometricLight>(position, renderFromLight * lightFromMap, image, MappingOf(context),
                                              scale);
  });
}

std::unique_ptr<Light> BuildProjection(Values& values, const LightDescription& light) {
  const BuildContext& context = values.Context();
  const bool isV3 = context.IsV3();
  const Parameter* fileName = light.params.Find(isV3 ? "mapname" : "filename");
  if (!fileName && !isV3)
    throw Error(light.location, "light \"projection\" has no image, expected \"filename\" to name one");
  const Color factor = isV3 ? GetEmission(values, light, "I") : GetScale(values, light);
  const Image image = ReadEmission(values, fileName, factor, false);
  const double fov = light.params.GetFloat("fov", isV3 ? 45 : 90);
  // pbrt-v3 has the top of the image at -y.
  const Transform lightFromMap = Transform::Scale({1, isV3 ? -1. : 1., 1});
  const Transform renderFromLight = context.renderFromWorld * light.worldFromLight;
  const Vec3 position = ToFloat(renderFromLight.Point(Vec3d(0)));
  return BuildToPower(context, light, factor, [&](const Color& scale) {
    return AtLocation(light.params.LocationOf("fov", light.location), [&] {
      return std::make_unique<ProjectionLight>(position, renderFromLight * lightFromMap, image, fov, scale);
    });
  });
}

std::unique_ptr<Light> BuildKnownLight(Values& values, const LightDescription& light) {
  if (light.type == "point") return BuildPoint(values, light);
  if (light.type == "spot") return BuildSpot(values, light);
  if (light.type == "distant") return BuildDistant(values, light);
  if (IsInfinite(light)) return BuildInfinite(values, light);
  if (light.type == "projection") return BuildProjection(values, light);
  if (light.type == "goniometric") return BuildGoniometric(values, light);
  FailUnknownName(light.location, "light", light.type,
                  {"point", "spot", "distant", "infinite", "projection", "goniometric"});
}

/// Image emission of pbrt-v4's area lights: over the shape's (u, v).
ColorTexturePtr BuildEmissionImage(Values& values, const Parameter& fileName, const Color& scale, double* luminance) {
  const std::shared_ptr<const Image> image = values.GetImage(fileName, ColorEncoding::SRgb());
  double sum = 0;
  for (int y = 0; y < image->Height(); ++y)
    for (int x = 0; x < image->Width(); ++x) sum += static_cast<double>(image->ColorAt(x, y).Luminance());
  *luminance = sum / (static_cast<double>(image->Width()) * image->Height());
  ImageTextureOptions options;
  options.wrap = WrapMode::kClamp;
  options.scale = scale.r;
  return std::make_shared<ImageColorTexture>(image, std::make_shared<UvMapping>(), options, fileName.location);
}

struct ShapeArea {
  double area = 0;
  int primitives = 0;  // of some area
};

ShapeArea AreaOf(const Shape& shape) {
  ShapeArea result;
  for (int i = 0; i < shape.PrimitiveCount(); ++i) {
    const double area = shape.PrimitiveArea(i);
    result.area += area;
    result.primitives += area > 0 ? 1 : 0;
  }
  return result;
}

}  // namespace

std::unique_ptr<Light> BuildLight(Values& values, const LightDescription& light) {
  std::unique_ptr<Light> result = BuildKnownLight(values, light);
  light.params.ReportUnused(values.Context().diagnostics, {"nsamples", "samples"});
  return result;
}

std::unique_ptr<Light> BuildAreaLight(Values& values, const Entity& light, const Shape& shape, FloatTexturePtr alpha) {
  const BuildContext& context = values.Context();
  if (light.type != "diffuse" && light.type != "area")
    FailUnknownName(light.location, "area light", light.type, {"diffuse", "area"});
  const bool twoSided = light.params.GetBool("twosided", false);
  const ShapeArea extent = AreaOf(shape);
  const double reachedEach = kPiD * (twoSided ? 2 : 1) * extent.area / std::max(1, extent.primitives);
  const Parameter* fileName = context.IsV3() ? nullptr : light.params.Find("filename");
  if (fileName && light.params.Has("L"))
    throw Error(fileName->location, "both \"L\" and \"filename\" are given, expected one of them");
  ColorTexturePtr radiance;
  if (fileName && !GetScale(values, light).IsBlack()) {
    double luminance = 0;
    BuildEmissionImage(values, *fileName, Color(1), &luminance);
    const Color scale =
        InRange(light, GetScale(values, light) * TargetFactor(context, light, "power", luminance * reachedEach));
    radiance = BuildEmissionImage(values, *fileName, scale, &luminance);
  } else {
    const Color L = GetEmission(values, light, "L") * TargetFactor(context, light, "power", reachedEach);
    radiance = std::make_shared<ConstantTexture<Color>>(InRange(light, L));
  }
  light.params.ReportUnused(context.diagnostics, {"nsamples", "samples"});
  return std::make_unique<AreaLight>(&shape, std::move(radiance), twoSided, std::move(alpha));
}

}  // namespace dapple
