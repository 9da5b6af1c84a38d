#include "src/io/build_film.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "src/io/nearest_name.h"

namespace dapple {

namespace {

constexpr int kMaxResolution = 1 << 16;
constexpr int kPbrtDefaultDepth = 5;  // of every integrator that knows "maxdepth", in both versions

/// A parameter that must be at least `least`.
int GetIntAtLeast(const Entity& entity, const char* name, int fallback, int least) {
  const int value = entity.params.GetInt(name, fallback);
  if (value < least)
    throw Error(entity.params.LocationOf(name, entity.location),
                fmt::format("parameter \"{}\" is {}, expected at least {}", name, value, least));
  return value;
}

int GetResolution(const Entity& film, const char* name, int fallback) {
  const int value = GetIntAtLeast(film, name, fallback, 1);
  if (value > kMaxResolution)
    throw Error(film.params.LocationOf(name, film.location),
                fmt::format("parameter \"{}\" is {}, expected at most {}", name, value, kMaxResolution));
  return value;
}

/// The pixel border at a share of the image, rounded up as in pbrt; a share that is a border but for the rounding of
/// its decimals is that border (0.07 of 100 is 7).
int PixelOfShare(double share, int size) {
  const double exact = std::clamp(share, 0.0, 1.0) * size, border = std::round(exact);
  return static_cast<int>(std::abs(exact - border) < 1e-9 * size ? border : std::ceil(exact));
}

PixelBounds BoundsOfWindow(const Vec2i& size, const std::array<double, 4>& window) {
  return {{PixelOfShare(std::min(window[0], window[1]), size.x), PixelOfShare(std::min(window[2], window[3]), size.y)},
          {PixelOfShare(std::max(window[0], window[1]), size.x), PixelOfShare(std::max(window[2], window[3]), size.y)}};
}

/// "pixelbounds": xMin xMax yMin yMax in pixels of the film's own resolution, brought to `resolution`.
PixelBounds ScaledPixelBounds(const Entity& film, const Vec2i& own, const Vec2i& resolution) {
  const std::vector<int> values = film.params.GetIntArray("pixelbounds", 4);
  const auto scaled = [](int value, int from, int to) {
    const int64_t pixel = std::clamp(value, 0, from);
    return static_cast<int>((pixel * to + from - 1) / from);
  };
  return {{scaled(values[0], own.x, resolution.x), scaled(values[2], own.y, resolution.y)},
          {scaled(values[1], own.x, resolution.x), scaled(values[3], own.y, resolution.y)}};
}

void SetCrop(const BuildContext& context, const BuildOptions& options, const Vec2i& own, RenderSettings* settings) {
  const Entity& film = context.description.film;
  const bool hasWindow = film.params.Has("cropwindow"), hasBounds = film.params.Has("pixelbounds");
  if (hasWindow && hasBounds)
    context.diagnostics.Warn(film.params.LocationOf("cropwindow", film.location),
                             "\"pixelbounds\" is given too; \"cropwindow\" is ignored");
  settings->crop = {{0, 0}, settings->resolution};
  FileLocation place;
  if (options.cropWindow) {
    settings->crop = BoundsOfWindow(settings->resolution, *options.cropWindow);
  } else if (hasBounds) {
    settings->crop = ScaledPixelBounds(film, own, settings->resolution);
    place = film.params.LocationOf("pixelbounds", film.location);
  } else if (hasWindow) {
    const std::vector<double> window = film.params.GetFloatArray("cropwindow", 4);
    settings->crop = BoundsOfWindow(settings->resolution, {window[0], window[1], window[2], window[3]});
    place = film.params.LocationOf("cropwindow", film.location);
  }
  if (settings->crop.IsEmpty())
    throw Error(place, "the crop window holds no pixel, expected xMin xMax yMin yMax within the image");
}

/// A number that darkens or brightens the whole picture.
double GetPositive(const Entity& film, const char* name, double otherwise) {
  const double value = film.params.GetFloat(name, otherwise);
  if (!(value > 0))
    throw Error(film.params.LocationOf(name, film.location),
                fmt::format("parameter \"{}\" is {}, expected more than 0", name, value));
  return value;
}

/// The factor that v4's film applies to every value: shutter time * iso / 100.
double ImagingRatio(const BuildContext& context) {
  const Entity& film = context.description.film;
  const CameraDescription& camera = context.description.camera;
  const double open = camera.params.GetFloat("shutteropen", 0), close = camera.params.GetFloat("shutterclose", 1);
  const double time = film.params.GetFloat("exposuretime", close - open);
  if (!(time > 0))
    throw Error(camera.params.LocationOf("shutterclose", camera.location),
                fmt::format("the shutter is open for {} seconds, expected more than 0", time));
  const std::string sensor = film.params.GetString("sensor", "cie1931");
  if (sensor != "cie1931")
    context.diagnostics.Warn(film.params.LocationOf("sensor", film.location),
                             fmt::format("sensor \"{}\" is not supported; \"cie1931\" is used", sensor));
  return time * GetPositive(film, "iso", 100) / 100;
}

void BuildFilm(const BuildContext& context, const BuildOptions& options, RenderSettings* settings) {
  const Entity& film = context.description.film;
  if (film.IsGiven() && film.type != "image" && film.type != "rgb") {
    if (film.type != "gbuffer" && film.type != "spectral")
      FailUnknownName(film.location, "film", film.type, {"image", "rgb", "gbuffer", "spectral"});
    context.diagnostics.Warn(film.location, fmt::format("film \"{}\" is not supported; \"rgb\" is used", film.type));
  }
  const Vec2i own(GetResolution(film, "xresolution", 1280), GetResolution(film, "yresolution", 720));
  settings->resolution = options.resolution.value_or(own);
  if (!options.resolution)
    settings->resolutionLocation =
        film.params.LocationOf(own.x >= own.y ? "xresolution" : "yresolution", film.location);
  SetCrop(context, options, own, settings);
  settings->outputFile = film.params.GetString("filename", "");
  film.params.GetFloat("diagonal", 35);  // matters to "realistic" cameras alone
  if (context.IsV3()) {
    settings->exposure = static_cast<float>(GetPositive(film, "scale", 1));
    WarnUnsupported(context, film.params, "maxsampleluminance");
  } else {
    settings->exposure = static_cast<float>(ImagingRatio(context));
    for (const char* name :
         {"maxcomponentvalue", "whitebalance", "coordinatesystem", "lambdamin", "lambdamax", "nbuckets"})
      WarnUnsupported(context, film.params, name);
    film.params.GetBool("savefp16", true);  // a matter of the file
  }
  film.params.ReportUnused(context.diagnostics);
}

Filter BuildFilter(const BuildContext& context) {
  const Entity& filter = context.description.pixelFilter;
  const ParameterList& params = filter.params;
  const bool isV3 = context.IsV3();
  const std::string type = filter.IsGiven() ? filter.type : (isV3 ? "box" : "gaussian");
  const auto radius = [&](double fallback) {
    return Vec2d(params.GetFloat(isV3 ? "xwidth" : "xradius", fallback),
                 params.GetFloat(isV3 ? "ywidth" : "yradius", fallback));
  };
  if (type == "box") return Filter::Box(radius(0.5), filter.location);
  if (type == "triangle") return Filter::Triangle(radius(2), filter.location);
  if (type == "gaussian" && isV3) {
    const Vec2d r = radius(2);
    return Filter::Gaussian(r, params.GetFloat("alpha", 2), filter.location);
  }
  if (type == "gaussian") {
    const Vec2d r = radius(1.5);
    return Filter::GaussianSigma(r, params.GetFloat("sigma", 0.5), filter.location);
  }
  if (type == "mitchell") {
    const Vec2d r = radius(2);
    const double B = params.GetFloat("B", 1. / 3), C = params.GetFloat("C", 1. / 3);
    return Filter::Mitchell(r, B, C, filter.location);
  }
  if (type == "sinc") {
    const Vec2d r = radius(4);
    return Filter::Sinc(r, params.GetFloat("tau", 3), filter.location);
  }
  FailUnknownName(filter.location, "pixel filter", type, {"box", "gaussian", "mitchell", "sinc", "triangle"});
}

int GetStratifiedSamples(const Entity& sampler) {
  const int64_t product = int64_t{GetIntAtLeast(sampler, "xsamples", 4, 1)} * GetIntAtLeast(sampler, "ysamples", 4, 1);
  constexpr int kMost = std::numeric_limits<int>::max();
  if (product > kMost)
    throw Error(sampler.params.LocationOf("xsamples", sampler.location),
                fmt::format("\"xsamples\" times \"ysamples\" is {}, expected at most {}", product, kMost));
  return static_cast<int>(product);
}

void BuildSampler(const BuildContext& context, RenderSettings* settings) {
  const Entity& sampler = context.description.sampler;
  if (!sampler.IsGiven()) return;
  // How samples are laid out is Dapple's own matter: of a sampler only their number counts.
  static const std::vector<std::string> kKnown = {"02sequence", "halton",      "independent", "lowdiscrepancy",
                                                  "maxmindist", "paddedsobol", "pmj02bn",     "random",
                                                  "sobol",      "stratified",  "zsobol"};
  if (std::find(kKnown.begin(), kKnown.end(), sampler.type) == kKnown.end())
    context.diagnostics.Warn(sampler.location,
                             fmt::format("unknown sampler \"{}\"{}", sampler.type, DidYouMean(sampler.type, kKnown)));
  settings->samplesPerPixel =
      sampler.type == "stratified" ? GetStratifiedSamples(sampler) : GetIntAtLeast(sampler, "pixelsamples", 16, 1);
  if (sampler.params.Has("seed")) settings->seed = sampler.params.GetInt("seed", 0);
  // How pbrt's own sequences are made; Dapple has its own.
  sampler.params.ReportUnused(context.diagnostics, {"pixelsamples", "xsamples", "ysamples", "jitter", "dimensions",
                                                    "randomization", "samplepixelcenter"});
}

/// pbrt-v4's sppm has no count of its own: a pass for each sample of a pixel.
int GetIterations(const BuildContext& context, const RenderSettings& settings) {
  const Entity& integrator = context.description.integrator;
  for (const char* name : {"iterations", "numiterations"})
    if (integrator.params.Has(name)) return GetIntAtLeast(integrator, name, 64, 1);
  return context.IsV3() ? 64 : settings.samplesPerPixel.value_or(16);
}

/// Of the algorithms that trace photons: pbrt's sppm and Dapple's own.
void BuildPhotons(const Entity& integrator, RenderSettings* settings) {
  const ParameterList& params = integrator.params;
  const int photons = params.GetInt("photonsperiteration", -1);
  if (photons > 0) settings->photonsPerIteration = photons;
  if (integrator.type == "light_tracing" || !params.Has("radius")) return;
  const double radius = params.GetFloat("radius", 1);
  if (!(radius > 0))
    throw Error(params.LocationOf("radius", integrator.location),
                fmt::format("parameter \"radius\" is {}, expected more than 0", radius));
  settings->radius = radius;
}

/// Where nothing absorbs, more would hold the render up for ever.
int GetMaxDepth(const BuildContext& context) {
  const Entity& integrator = context.description.integrator;
  const int depth = GetIntAtLeast(integrator, "maxdepth", kPbrtDefaultDepth, 0);
  if (depth > kMostDepth)
    context.diagnostics.Warn(
        integrator.params.LocationOf("maxdepth", integrator.location),
        fmt::format("parameter \"maxdepth\" is {}, expected at most {}; {} is used", depth, kMostDepth, kMostDepth));
  return std::min(depth, kMostDepth);
}

void BuildIntegrator(const BuildContext& context, RenderSettings* settings) {
  const Entity& integrator = context.description.integrator;
  if (!integrator.IsGiven()) return;
  settings->integrator = IntegratorNameOf(context.description);
  settings->integratorLocation = integrator.location;
  settings->maxDepth = GetMaxDepth(context);
  if (integrator.params.Has("seed")) settings->seed = integrator.params.GetInt("seed", 0);
  if (integrator.type == "sppm") settings->iterations = GetIterations(context, *settings);
  static const std::vector<std::string> kWithPhotons = {"sppm", "hybrid", "photon_mapping", "light_tracing"};
  if (std::find(kWithPhotons.begin(), kWithPhotons.end(), integrator.type) != kWithPhotons.end())
    BuildPhotons(integrator, settings);
  // Of pbrt's own algorithms and machinery; nothing here depends on them.
  integrator.params.ReportUnused(context.diagnostics, {"rrthreshold",
                                                       "lightsampler",
                                                       "lightsamplestrategy",
                                                       "regularize",
                                                       "imagewritefrequency",
                                                       "pixelbounds",
                                                       "strategy",
                                                       "visualizestrategies",
                                                       "visualizeweights",
                                                       "bootstrapsamples",
                                                       "chains",
                                                       "mutationsperpixel",
                                                       "largestepprobability",
                                                       "sigma",
                                                       "samplebsdf",
                                                       "samplelights",
                                                       "cossample",
                                                       "maxdistance",
                                                       "nsamples",
                                                       "iterations",
                                                       "numiterations",
                                                       "photonsperiteration",
                                                       "radius"});
}

/// Of pbrt-v4's Option statements.
void BuildOptionStatements(const BuildContext& context, RenderSettings* settings) {
  const ParameterList& options = context.description.options;
  if (options.Has("seed")) settings->seed = options.GetInt("seed", 0);
  for (const char* name : {"disablepixeljitter", "displacementedgescale", "forcediffuse"})
    WarnUnsupported(context, options, name);
  // Of pbrt's own machinery; the picture does not depend on them, or not here.
  options.ReportUnused(context.diagnostics, {"disabletexturefiltering", "disablewavelengthjitter", "msereferenceimage",
                                             "msereferenceout", "pixelstats", "rendercoordsys", "wavefront"});
}

}  // namespace

RenderSettings BuildSettings(const BuildContext& context, const BuildOptions& options) {
  RenderSettings settings;
  BuildFilm(context, options, &settings);
  settings.filter = BuildFilter(context);
  context.description.pixelFilter.params.ReportUnused(context.diagnostics);
  BuildSampler(context, &settings);
  BuildIntegrator(context, &settings);
  BuildOptionStatements(context, &settings);
  return settings;
}

}  // namespace dapple
