#include "src/io/build_camera.h"

#include <algorithm>

#include <fmt/format.h>

#include "src/scene/orthographic_camera.h"
#include "src/scene/perspective_camera.h"
#include "src/scene/spherical_camera.h"

namespace dapple {

namespace {

/// The depths, in the camera's space, of a point of each shape that tells cheaply where it is.
std::vector<double> ShapeDepths(const SceneDescription& description) {
  std::vector<double> depths;
  for (const ShapeDescription& shape : description.shapes) {
    Vec3d p(0);
    if (shape.type == "plymesh") continue;
    const auto& all = shape.params.All();
    const auto P = std::find_if(all.begin(), all.end(), [](const Parameter& parameter) {
      return parameter.name == "P" && parameter.type == ParameterType::Point3;
    });
    if (P != all.end()) p = {P->numbers[0], P->numbers[1], P->numbers[2]};
    depths.push_back(description.camera.cameraFromWorld.Point(shape.worldFromShape.Point(p)).z);
  }
  return depths;
}

ScreenWindow GetScreenWindow(const CameraDescription& camera, const Vec2i& resolution) {
  const ParameterList& params = camera.params;
  const double aspect = params.GetFloat("frameaspectratio", static_cast<double>(resolution.x) / resolution.y);
  if (!(aspect > 0))
    throw Error(params.LocationOf("frameaspectratio", camera.location),
                fmt::format("parameter \"frameaspectratio\" is {}, expected more than 0", aspect));
  ScreenWindow window = ScreenWindow::FromAspect(aspect);
  const std::vector<double> values = params.GetFloatArray("screenwindow");
  if (values.empty()) return window;
  if (values.size() != 4 || values[0] == values[1] || values[2] == values[3])
    throw Error(params.LocationOf("screenwindow", camera.location),
                "parameter \"screenwindow\" holds no area, expected four numbers: xMin xMax yMin yMax");
  return {values[0], values[1], values[2], values[3]};
}

ThinLens GetLens(const ParameterList& params) {
  ThinLens lens;
  lens.radius = params.GetFloat("lensradius", 0);
  lens.focalDistance = params.GetFloat("focaldistance", 1e6);
  return lens;
}

double GetFov(const BuildContext& context, const ParameterList& params) {
  const double fov = params.GetFloat("fov", 90);
  if (!context.IsV3()) return fov;
  const double halfFov = params.GetFloat("halffov", -1);
  return halfFov > 0 ? 2 * halfFov : fov;
}

SphericalProjection GetProjection(const CameraDescription& camera) {
  const std::string mapping =
      camera.params.GetString("mapping", camera.type == "spherical" ? "equalarea" : "equirectangular");
  if (mapping == "equirectangular") return SphericalProjection::Equirectangular;
  if (mapping == "equalarea") return SphericalProjection::EqualArea;
  FailUnknownName(camera.params.LocationOf("mapping", camera.location), "mapping", mapping,
                  {"equalarea", "equirectangular"});
}

std::unique_ptr<Camera> MakeCamera(const BuildContext& context, const Vec2i& resolution) {
  const CameraDescription& camera = context.description.camera;
  const ParameterList& params = camera.params;
  const Transform cameraToRender = context.renderFromWorld * camera.cameraFromWorld.Inverse();
  if (camera.cameraFromWorld.IsSingular())
    throw Error(camera.location, "the camera's transform is singular, expected one that can be inverted");
  const std::string type = camera.IsGiven() ? camera.type : "perspective";
  if (type == "perspective")
    return std::make_unique<PerspectiveCamera>(cameraToRender, resolution, GetScreenWindow(camera, resolution),
                                               GetFov(context, params), GetLens(params), camera.location);
  if (type == "orthographic")
    return std::make_unique<OrthographicCamera>(cameraToRender, resolution, GetScreenWindow(camera, resolution),
                                                GetLens(params), camera.location);
  if (type == "environment" || type == "spherical")
    return std::make_unique<SphericalCamera>(cameraToRender, resolution, GetProjection(camera), camera.location);
  if (type == "realistic") {
    context.diagnostics.Warn(
        camera.location, "camera \"realistic\" is not supported; a pinhole with a field of view of 40 degrees is used");
    params.IgnoreAll();
    return std::make_unique<PerspectiveCamera>(cameraToRender, resolution, GetScreenWindow(camera, resolution), 40,
                                               ThinLens(), camera.location);
  }
  FailUnknownName(camera.location, "camera", type, {"perspective", "orthographic", "spherical", "environment"});
}

}  // namespace

Transform RenderFromWorld(const SceneDescription& description) {
  const CameraDescription& camera = description.camera;
  Vec3d origin(0);
  if (camera.type == "orthographic") {
    std::vector<double> depths = ShapeDepths(description);
    if (!depths.empty()) {
      const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
      std::nth_element(depths.begin(), middle, depths.end());
      origin.z = *middle;
    }
  }
  const Vec3d position = camera.cameraFromWorld.Inverse().Point(origin);
  const bool isFinite = std::isfinite(position.x) && std::isfinite(position.y) && std::isfinite(position.z);
  return isFinite ? Transform::Translate(-position) : Transform();
}

std::unique_ptr<Camera> BuildCamera(const BuildContext& context, const Vec2i& resolution) {
  const ParameterList& params = context.description.camera.params;
  std::unique_ptr<Camera> camera = MakeCamera(context, resolution);
  // Nothing moves yet, so only the shutter's duration matters, and that to the film.
  params.ReportUnused(context.diagnostics, {"shutteropen", "shutterclose", "screenwindow", "frameaspectratio",
                                            "lensradius", "focaldistance"});
  return camera;
}

}  // namespace dapple
