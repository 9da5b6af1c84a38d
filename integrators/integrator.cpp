#include "integrators/integrator.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "integrators/hybrid.h"
#include "integrators/light_tracing.h"
#include "integrators/path.h"
#include "integrators/photon_mapping.h"
#include "integrators/sppm.h"
#include "src/base/error.h"

namespace dapple {

namespace {

template <typename T>
std::unique_ptr<Integrator> Make(const IntegratorOptions& options) {
  return std::make_unique<T>(options);
}

constexpr std::pair<std::string_view, std::unique_ptr<Integrator> (*)(const IntegratorOptions&)> kIntegrators[] = {
    {"path", Make<PathIntegrator>},
    {"light_tracing", Make<LightTracingIntegrator>},
    {"photon_mapping", Make<PhotonMappingIntegrator>},
    {"sppm", Make<SppmIntegrator>},
    {"hybrid", Make<HybridIntegrator>},
};

template <typename T>
std::string ToText(const std::optional<T>& value) {
  return value ? fmt::format("{}", *value) : "automatic";
}

std::string ToText(KernelShape kernel) { return kernel == KernelShape::Cone ? "cone" : "epanechnikov"; }

std::string ToText(DirectTechnique technique) {
  switch (technique) {
    case DirectTechnique::Mis:
      return "mis";
    case DirectTechnique::Light:
      return "light";
    case DirectTechnique::Bsdf:
      return "bsdf";
  }
  return "";
}

}  // namespace

PassStats& PassStats::operator+=(const PassStats& s) {
  cameraRays += s.cameraRays;
  shadowRays += s.shadowRays;
  photonRays += s.photonRays;
  probeRays += s.probeRays;
  photonsEmitted += s.photonsEmitted;
  photonsStored += s.photonsStored;
  gathers += s.gathers;
  photonsGathered += s.photonsGathered;
  splats += s.splats;
  photonMaps += s.photonMaps;
  photonMapBytes = std::max(photonMapBytes, s.photonMapBytes);
  nonFinite += s.nonFinite;
  return *this;
}

std::vector<std::pair<std::string, std::string>> DescribeOptions(const IntegratorOptions& options) {
  // All members by name: one that is added and not told here does not compile. The guide follows from the others.
  const auto& [maxDepth, photonsPerPass, cameraSamples, radius, radiusScale, kernel, guideEmission, guide, direct] =
      options;
  const auto& [technique, lightSamples] = direct;
  return {
      {"max-depth", fmt::format("{}", maxDepth)},       {"photons", ToText(photonsPerPass)},
      {"camera-samples", ToText(cameraSamples)},        {"radius", ToText(radius)},
      {"radius-scale", fmt::format("{}", radiusScale)}, {"kernel", ToText(kernel)},
      {"guide", guideEmission ? "on" : "off"},          {"direct", ToText(technique)},
      {"light-samples", ToText(lightSamples)},
  };
}

std::vector<std::string_view> IntegratorNames() {
  std::vector<std::string_view> names;
  for (const auto& [name, make] : kIntegrators) names.push_back(name);
  return names;
}

std::unique_ptr<Integrator> MakeIntegrator(std::string_view name, const IntegratorOptions& options) {
  for (const auto& [known, make] : kIntegrators)
    if (known == name) return make(options);
  throw Error(fmt::format("unknown integrator \"{}\"; expected auto, {}", name, fmt::join(IntegratorNames(), ", ")));
}

}  // namespace dapple
