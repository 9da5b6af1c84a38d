#include "src/render/aov.h"

#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "integrators/camera_path.h"
#include "integrators/pixel_loop.h"
#include "src/base/numerics.h"

namespace dapple {

namespace {

/// What a first hit is recorded as. The last channel is the share of a pixel's samples that met anything: what only
/// hits have is divided by it.
constexpr std::array<std::string_view, 11> kChannels{"albedo.R", "albedo.G", "albedo.B", "N.X", "N.Y",     "N.Z",
                                                     "Z",        "P.X",      "P.Y",      "P.Z", "coverage"};
using FirstHit = std::array<float, kChannels.size()>;

/// A layer of first hits: its place in `kChannels`.
struct Layer {
  std::string_view name;
  bool AovSet::*isWanted;
  size_t begin, count;
  bool isOfHits;  ///< the mean over what is there, else over all samples
  float nothing;  ///< the value where nothing is there
};

constexpr std::array<Layer, 4> kLayers{{
    {"albedo", &AovSet::albedo, 0, 3, false, 0},
    {"normal", &AovSet::normal, 3, 3, false, 0},
    {"depth", &AovSet::depth, 6, 1, true, std::numeric_limits<float>::infinity()},
    {"position", &AovSet::position, 7, 3, true, 0},
}};

constexpr std::string_view kVariance = "variance", kNone = "none";

FirstHit Describe(const Scene& scene, const SurfaceInteraction& hit, const Material& material) {
  const Bsdf bsdf = material.GetBsdf(hit);
  const Color albedo = bsdf.Albedo(hit.wo);
  const Vec3 facing = FaceForward(bsdf.ShadingFrame().n, hit.wo);
  const Vec3d n = Normalize(scene.RenderToWorld().Normal(ToDouble(facing)));
  const Vec3d p = scene.RenderToWorld().Point(ToDouble(hit.p));
  const auto f = [](double value) { return static_cast<float>(value); };
  return {albedo.r, albedo.g, albedo.b, f(n.x), f(n.y), f(n.z), scene.GetCamera().Depth(hit.p),
          f(p.x),   f(p.y),   f(p.z),   1};
}

/// All zero where the ray meets nothing.
FirstHit FindFirstHit(const Scene& scene, Ray ray, PassStats& stats) {
  for (;;) {
    ++stats.cameraRays;
    const std::optional<SurfaceInteraction> hit = scene.Intersect(ray);
    if (!hit) return {};
    if (const Material* const material = scene.MaterialAt(*hit)) return Describe(scene, *hit, *material);
    ray = SpawnRay(*hit, ray.d);
  }
}

/// Where each of the film's extra channels stands in `kChannels`.
std::vector<size_t> PlacesOf(const std::vector<std::string>& names) {
  std::vector<size_t> places;
  for (const std::string& name : names)
    places.push_back(static_cast<size_t>(std::ranges::find(kChannels, name) - kChannels.begin()));
  return places;
}

std::vector<std::string> PictureChannels(const AovSet& aovs) {
  std::vector<std::string> names{"R", "G", "B"};
  for (const Layer& layer : kLayers)
    if (aovs.*layer.isWanted)
      names.insert(names.end(), kChannels.begin() + layer.begin, kChannels.begin() + layer.begin + layer.count);
  if (aovs.variance) names.insert(names.end(), {"variance.R", "variance.G", "variance.B"});
  return names;
}

void CopyLayer(const Layer& layer, const Image& extras, Image* picture) {
  const int coverage = extras.FindChannel(kChannels.back());
  for (const std::string_view name : std::span(kChannels).subspan(layer.begin, layer.count)) {
    const int from = extras.FindChannel(name), to = picture->FindChannel(name);
    for (int y = 0; y < picture->Height(); ++y)
      for (int x = 0; x < picture->Width(); ++x) {
        const float share = layer.isOfHits ? extras.At(x, y, coverage) : 1;
        picture->At(x, y, to) = share > 0 ? extras.At(x, y, from) / share : layer.nothing;
      }
  }
}

/// Zero before both halves have a pass.
void AddVariance(const Film& film, float exposure, Image* picture) {
  const double n0 = static_cast<double>(film.PassCount(0)), n1 = static_cast<double>(film.PassCount(1));
  if (n0 == 0 || n1 == 0) return;
  const Image half0 = film.HalfImage(0), half1 = film.HalfImage(1);
  const double factor = n0 * n1 / Sqr(n0 + n1) * Sqr(double{exposure});
  const int first = picture->FindChannel("variance.R");
  for (int y = 0; y < picture->Height(); ++y)
    for (int x = 0; x < picture->Width(); ++x)
      for (int c = 0; c < Color::kComponents; ++c)
        picture->At(x, y, first + c) =
            static_cast<float>(factor * Sqr(double{half0.At(x, y, c)} - double{half1.At(x, y, c)}));
}

}  // namespace

std::optional<AovSet> ParseAovs(const std::string& text) {
  AovSet aovs;
  if (text == kNone) return aovs;
  std::istringstream names(text);
  for (std::string name; std::getline(names, name, ',');) {
    const auto layer = std::ranges::find(kLayers, name, &Layer::name);
    if (layer != kLayers.end()) {
      aovs.*layer->isWanted = true;
    } else if (name == kVariance) {
      aovs.variance = true;
    } else {
      return std::nullopt;
    }
  }
  return aovs;
}

std::string ToString(const AovSet& aovs) {
  std::vector<std::string_view> names;
  for (const Layer& layer : kLayers)
    if (aovs.*layer.isWanted) names.push_back(layer.name);
  if (aovs.variance) names.push_back(kVariance);
  if (names.empty()) names.push_back(kNone);
  return fmt::format("{}", fmt::join(names, ","));
}

std::vector<std::string> FilmChannels(const AovSet& aovs) {
  std::vector<std::string> names;
  bool needsCoverage = false;
  for (const Layer& layer : kLayers) {
    if (!(aovs.*layer.isWanted)) continue;
    names.insert(names.end(), kChannels.begin() + layer.begin, kChannels.begin() + layer.begin + layer.count);
    needsCoverage |= layer.isOfHits;
  }
  if (needsCoverage) names.emplace_back(kChannels.back());
  return names;
}

PassStats RecordFirstHits(const Scene& scene, uint64_t seed, int pass, Film& film) {
  const std::vector<size_t> places = PlacesOf(film.ExtraChannels());
  return ForEachPixel(film, [&](const Vec2i& pixel, PassStats& stats) {
    Sampler sampler = Sampler::ForPixel(seed, pixel, pass);
    const FirstHit hit = FindFirstHit(scene, SamplePixel(scene, film.PixelFilter(), pixel, sampler).camera.ray, stats);
    FirstHit values;
    for (size_t i = 0; i < places.size(); ++i) values[i] = hit[places[i]];
    film.AddExtras(pixel, std::span(values).first(places.size()));
  });
}

Image ToPicture(const Film& film, float exposure, const AovSet& aovs) {
  const Image radiance = film.ToImage();
  Image picture(radiance.Width(), radiance.Height(), PictureChannels(aovs));
  picture.origin = radiance.origin;
  picture.fullSize = radiance.fullSize;
  for (int y = 0; y < picture.Height(); ++y)
    for (int x = 0; x < picture.Width(); ++x) picture.SetColor(x, y, radiance.ColorAt(x, y) * exposure);
  if (!film.ExtraChannels().empty()) {
    const Image extras = film.ExtraImage();
    for (const Layer& layer : kLayers)
      if (aovs.*layer.isWanted) CopyLayer(layer, extras, &picture);
  }
  if (aovs.variance) AddVariance(film, exposure, &picture);
  return picture;
}

}  // namespace dapple
