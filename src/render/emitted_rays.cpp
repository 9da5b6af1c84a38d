#include "src/render/emitted_rays.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <iterator>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "src/base/error.h"
#include "src/base/parallel.h"
#include "src/photons/light_path.h"
#include "src/render/json_text.h"
#include "src/sampling/seed.h"

namespace dapple {

namespace {

constexpr const char* kColumns =
    "light,name,origin_x,origin_y,origin_z,direction_x,direction_y,direction_z,normal_x,normal_y,normal_z,"
    "radiance_r,radiance_g,radiance_b,pdf_light,pdf_position,pdf_direction,position_is_discrete,"
    "direction_is_discrete,flux_r,flux_g,flux_b";

std::vector<std::string> ColumnNames() {
  std::vector<std::string> names(1);
  for (const char* c = kColumns; *c != '\0'; ++c) {
    if (*c == ',') {
      names.emplace_back();
    } else {
      names.back() += *c;
    }
  }
  return names;
}

void CheckLight(const Scene& scene, const EmitOptions& options) {
  const int count = static_cast<int>(scene.Lights().size());
  if (count == 0) throw Error("none of the scene's lights emits anything: there are no rays");
  if (options.light && (*options.light < 0 || *options.light >= count)) {
    throw Error(fmt::format("light {} is not there: expected one of 0 to {}, as `dapple info` lists them",
                            *options.light, count - 1));
  }
}

std::optional<EmissionSample> EmitOne(const Scene& scene, const EmissionSampler& emission, const EmitOptions& options,
                                      int64_t path) {
  Sampler sampler = Sampler::ForLightPath(SeedFrom(options.seed), path, 0, options.count);
  if (!options.light) return EmitPhoton(emission, sampler);
  const Light& light = *scene.Lights()[static_cast<size_t>(*options.light)];
  const std::optional<LeSample> le = light.Sample_Le(EmissionNumbers(sampler));
  if (!le) return std::nullopt;
  EmissionSample sample;
  sample.light = *options.light;
  sample.pdfLight = 1;
  sample.le = *le;
  return sample;
}

EmittedRay ToWorld(const Transform& renderToWorld, const EmissionSample& sample, int count) {
  const LeSample& le = sample.le;
  EmittedRay ray;
  ray.light = sample.light;
  ray.origin = renderToWorld.Point(ToDouble(le.ray.o));
  ray.direction = ToFloat(Normalize(renderToWorld.Vector(ToDouble(le.ray.d))));
  ray.normal = ToFloat(Normalize(renderToWorld.Normal(ToDouble(le.n))));
  ray.radiance = le.Le;
  ray.pdfLight = sample.pdfLight;
  ray.pdfPosition = le.pdfPos;
  ray.pdfDirection = le.pdfDir;
  ray.positionIsDiscrete = le.deltaPos;
  ray.directionIsDiscrete = le.deltaDir;
  ray.flux = sample.Flux() / static_cast<float>(count);
  return ray;
}

enum class RowFormat { Csv, Json };

/// The columns of a ray. JSON has names in quotation marks, and no infinities: they are null, as the flux of a light
/// beyond all floats.
void AppendRow(const Scene& scene, const EmittedRay& r, RowFormat format, std::string* text) {
  const auto end = std::back_inserter(*text);
  const bool isJson = format == RowFormat::Json;
  const auto addOne = [&](auto number) {
    isJson && !std::isfinite(number) ? fmt::format_to(end, ",null") : fmt::format_to(end, ",{}", number);
  };
  const auto add = [&](auto... numbers) { (addOne(numbers), ...); };
  const std::string_view name = scene.Lights()[static_cast<size_t>(r.light)]->Name(), quote = isJson ? "\"" : "";
  fmt::format_to(end, "{},{}{}{}", r.light, quote, name, quote);
  add(r.origin.x, r.origin.y, r.origin.z);
  for (const Vec3& v : {r.direction, r.normal}) add(v.x, v.y, v.z);
  add(r.radiance.r, r.radiance.g, r.radiance.b, r.pdfLight, r.pdfPosition, r.pdfDirection);
  fmt::format_to(end, ",{:d},{:d}", r.positionIsDiscrete, r.directionIsDiscrete);
  add(r.flux.r, r.flux.g, r.flux.b);
}

static_assert(std::endian::native == std::endian::little, "PLY files are written as they lie in memory");

template <typename... T>
void AppendBytes(std::string* bytes, T... values) {
  (bytes->append(reinterpret_cast<const char*>(&values), sizeof(values)), ...);
}

}  // namespace

EmittedRays EmitRays(const Scene& scene, const EmitOptions& options) {
  CheckLight(scene, options);
  constexpr int64_t kRaysPerChunk = 4096;
  const EmissionSampler emission(scene);
  std::vector<std::optional<EmissionSample>> samples(static_cast<size_t>(options.count));
  ParallelForChunks(options.count, kRaysPerChunk, [&](int64_t begin, int64_t end) {
    for (int64_t i = begin; i < end; ++i) samples[static_cast<size_t>(i)] = EmitOne(scene, emission, options, i);
  });
  EmittedRays emitted{options, {}};
  emitted.rays.reserve(samples.size());
  for (const std::optional<EmissionSample>& sample : samples) {
    if (sample) emitted.rays.push_back(ToWorld(scene.RenderToWorld(), *sample, options.count));
  }
  return emitted;
}

std::string RaysToCsv(const Scene& scene, const EmittedRays& emitted) {
  std::string text = std::string(kColumns) + "\n";
  for (const EmittedRay& ray : emitted.rays) {
    AppendRow(scene, ray, RowFormat::Csv, &text);
    text += '\n';
  }
  return text;
}

std::string RaysToJson(const Scene& scene, const EmittedRays& emitted) {
  nlohmann::ordered_json head = {{"rays", emitted.options.count}, {"seed", emitted.options.seed}};
  for (size_t i = 0; i < scene.Lights().size(); ++i) {
    const Light& light = *scene.Lights()[i];
    const Color power = light.Power();
    head["lights"].push_back({{"index", i}, {"name", light.Name()}, {"power", {power.r, power.g, power.b}}});
  }
  head["columns"] = ColumnNames();
  std::string text = DumpJson(head, 1);
  text.erase(text.rfind('\n'));  // goes on before the closing brace
  text += ",\n \"data\": [";
  for (size_t i = 0; i < emitted.rays.size(); ++i) {
    text += i == 0 ? "\n  [" : ",\n  [";
    AppendRow(scene, emitted.rays[i], RowFormat::Json, &text);
    text += ']';
  }
  return text + "\n ]\n}\n";
}

std::string RaysToPly(const Scene& scene, const EmittedRays& emitted) {
  std::string bytes = "ply\nformat binary_little_endian 1.0\ncomment rays emitted by the lights of a scene\n";
  for (size_t i = 0; i < scene.Lights().size(); ++i) {
    bytes += fmt::format("comment light {} {}\n", i, scene.Lights()[i]->Name());
  }
  bytes +=
      fmt::format("element vertex {}\nproperty double x\nproperty double y\nproperty double z\n", emitted.rays.size());
  for (const char* name : {"nx", "ny", "nz", "normal_x", "normal_y", "normal_z", "radiance_r", "radiance_g",
                           "radiance_b", "flux_r", "flux_g", "flux_b"}) {
    bytes += fmt::format("property float {}\n", name);
  }
  for (const char* name : {"pdf_light", "pdf_position", "pdf_direction"}) {
    bytes += fmt::format("property double {}\n", name);
  }
  bytes += "property int light\nproperty uchar position_is_discrete\nproperty uchar direction_is_discrete\n";
  bytes += "end_header\n";
  for (const EmittedRay& r : emitted.rays) {
    AppendBytes(&bytes, r.origin.x, r.origin.y, r.origin.z);
    for (const Vec3& v : {r.direction, r.normal}) AppendBytes(&bytes, v.x, v.y, v.z);
    for (const Color& c : {r.radiance, r.flux}) AppendBytes(&bytes, c.r, c.g, c.b);
    AppendBytes(&bytes, r.pdfLight, r.pdfPosition, r.pdfDirection, static_cast<int32_t>(r.light),
                static_cast<uint8_t>(r.positionIsDiscrete), static_cast<uint8_t>(r.directionIsDiscrete));
  }
  return bytes;
}

}  // namespace dapple
