#include "src/io/build_textures.h"

#include <charconv>

#include <fmt/format.h>

#include "src/materials/procedural_textures.h"

namespace dapple {

namespace {

const std::vector<std::string> kTextureTypes = {"constant", "imagemap", "checkerboard", "scale",
                                                "mix",      "bilerp",   "dots"};
const std::vector<std::string> kUnsupportedTypes = {"uv", "fbm", "wrinkled", "marble", "windy", "ptex", "directionmix"};

// The same for textures of float and of colour.
template <typename T>
TexturePtr<T> Get(Values& values, const ParameterList& params, std::string_view name, double fallback) {
  if constexpr (std::is_same_v<T, float>)
    return values.GetFloat(params, name, fallback);
  else
    return values.GetColor(params, name, Color(static_cast<float>(fallback)));
}

template <typename T>
T GetConstant(Values& values, const ParameterList& params, std::string_view name, double fallback) {
  if constexpr (std::is_same_v<T, float>)
    return static_cast<float>(params.GetFloat(name, fallback));
  else
    return values.GetConstantColor(params, name, Color(static_cast<float>(fallback)), RgbUse::kReflectance);
}

Transform TextureFromRender(const BuildContext& context, const TextureDescription& texture) {
  return (context.renderFromWorld * texture.worldFromTexture).Inverse();
}

TextureMappingPtr BuildMapping(const BuildContext& context, const TextureDescription& texture) {
  const ParameterList& params = texture.params;
  const std::string type = params.GetString("mapping", "uv");
  const Transform textureFromRender = TextureFromRender(context, texture);
  if (type == "uv") {
    const Vec2d scale(params.GetFloat("uscale", 1), params.GetFloat("vscale", 1));
    const Vec2d delta(params.GetFloat("udelta", 0), params.GetFloat("vdelta", 0));
    return std::make_shared<UvMapping>(Vec2(scale), Vec2(delta));
  }
  if (type == "planar") {
    const Vec3d v1 = params.GetVector3("v1", {1, 0, 0}), v2 = params.GetVector3("v2", {0, 1, 0});
    const Vec2d delta(params.GetFloat("udelta", 0), params.GetFloat("vdelta", 0));
    // pbrt-v3 takes the plane's vectors in the world's space.
    const Transform space = context.IsV3() ? context.renderFromWorld.Inverse() : textureFromRender;
    return std::make_shared<PlanarMapping>(space, v1, v2, delta);
  }
  if (type == "spherical") return std::make_shared<SphericalMapping>(textureFromRender);
  if (type == "cylindrical") {
    using Height = CylindricalMapping::Height;
    return std::make_shared<CylindricalMapping>(textureFromRender,
                                                context.IsV3() ? Height::kDirection : Height::kPoint);
  }
  FailUnknownName(params.LocationOf("mapping", texture.location), "texture mapping", type,
                  {"uv", "planar", "spherical", "cylindrical"});
}

ColorEncoding GammaEncoding(const std::string& name, const FileLocation& location) {
  const std::string digits = name.substr(std::min(name.size(), std::string("gamma ").size()));
  float gamma = 0;
  const auto [end, failure] = std::from_chars(digits.data(), digits.data() + digits.size(), gamma);
  if (failure != std::errc() || end != digits.data() + digits.size() || !(gamma > 0))
    throw Error(location, fmt::format("encoding \"{}\" has no positive number after \"gamma\"", name));
  return ColorEncoding::Gamma(gamma);
}

ColorEncoding GetEncoding(const BuildContext& context, const TextureDescription& texture) {
  const ParameterList& params = texture.params;
  if (context.IsV3()) return params.GetBool("gamma", true) ? ColorEncoding::SRgb() : ColorEncoding::Linear();
  const std::string name = params.GetString("encoding", "sRGB");
  const FileLocation location = params.LocationOf("encoding", texture.location);
  if (name == "sRGB") return ColorEncoding::SRgb();
  if (name == "linear") return ColorEncoding::Linear();
  if (name.starts_with("gamma")) return GammaEncoding(name, location);
  FailUnknownName(location, "encoding", name, {"sRGB", "linear", "gamma <number>"});
}

WrapMode GetWrap(const TextureDescription& texture) {
  const std::string name = texture.params.GetString("wrap", "repeat");
  if (name == "repeat") return WrapMode::kRepeat;
  if (name == "black") return WrapMode::kBlack;
  if (name == "clamp") return WrapMode::kClamp;
  if (name == "octahedralsphere") return WrapMode::kOctahedralSphere;
  FailUnknownName(texture.params.LocationOf("wrap", texture.location), "wrap mode", name,
                  {"repeat", "black", "clamp", "octahedralsphere"});
}

ImageTextureOptions GetImageOptions(const BuildContext& context, const TextureDescription& texture) {
  const ParameterList& params = texture.params;
  ImageTextureOptions options;
  options.wrap = GetWrap(texture);
  options.scale = static_cast<float>(params.GetFloat("scale", 1));
  if (!context.IsV3()) {
    options.invert = params.GetBool("invert", false);
    if (params.GetString("filter", "bilinear") == "point") options.filter = ImageFilter::kPoint;
  }
  // How pbrt filters over a ray's footprint, which rays here do not carry.
  params.GetFloat("maxanisotropy", 8);
  params.GetBool("trilinear", false);
  return options;
}

template <typename T>
TexturePtr<T> BuildImageMap(Values& values, const TextureDescription& texture) {
  const BuildContext& context = values.Context();
  const Parameter* fileName = texture.params.Find("filename");
  if (!fileName)
    throw Error(texture.location,
                fmt::format("texture \"{}\" names no image, expected a parameter \"string filename\"", texture.name));
  const ImageTextureOptions options = GetImageOptions(context, texture);
  const TextureMappingPtr mapping = BuildMapping(context, texture);
  const std::shared_ptr<const Image> image = values.GetImage(*fileName, GetEncoding(context, texture));
  if constexpr (std::is_same_v<T, float>) {
    const PixelScalar scalar = context.IsV3() ? PixelScalar::kLuminance : PixelScalar::kAlphaOrAverage;
    return std::make_shared<ImageFloatTexture>(image, mapping, scalar, options, fileName->location);
  } else {
    return std::make_shared<ImageColorTexture>(image, mapping, options, fileName->location);
  }
}

template <typename T>
TexturePtr<T> BuildCheckerboard(Values& values, const TextureDescription& texture) {
  const ParameterList& params = texture.params;
  const int dimension = params.GetInt("dimension", 2);
  TexturePtr<T> even = Get<T>(values, params, "tex1", 1), odd = Get<T>(values, params, "tex2", 0);
  params.GetString("aamode", "none");  // of pbrt-v3; point sampled here as in pbrt-v4
  if (dimension == 2)
    return std::make_shared<CheckerboardTexture<T>>(BuildMapping(values.Context(), texture), even, odd);
  if (dimension == 3)
    return std::make_shared<Checkerboard3Texture<T>>(TextureFromRender(values.Context(), texture), even, odd);
  throw Error(params.LocationOf("dimension", texture.location),
              fmt::format("a checkerboard of {} dimensions, expected 2 or 3", dimension));
}

template <typename T>
TexturePtr<T> BuildScale(Values& values, const TextureDescription& texture) {
  const ParameterList& params = texture.params;
  if (values.Context().IsV3()) {
    const TexturePtr<T> first = Get<T>(values, params, "tex1", 1), second = Get<T>(values, params, "tex2", 1);
    return MakeScale(first, second);
  }
  const TexturePtr<T> scaled = Get<T>(values, params, "tex", 1);
  return MakeScale(scaled, values.GetFloat(params, "scale", 1));
}

template <typename T>
TexturePtr<T> BuildMix(Values& values, const TextureDescription& texture) {
  const ParameterList& params = texture.params;
  // One after the other: which of them has an error first does not depend on the compiler.
  const TexturePtr<T> first = Get<T>(values, params, "tex1", 0), second = Get<T>(values, params, "tex2", 1);
  return MakeMix<T>(first, second, values.GetFloat(params, "amount", 0.5));
}

template <typename T>
TexturePtr<T> BuildSupported(Values& values, const TextureDescription& texture) {
  const ParameterList& params = texture.params;
  const std::string& type = texture.type;
  if (type == "constant") return MakeConstant(GetConstant<T>(values, params, "value", 1));
  if (type == "imagemap") return BuildImageMap<T>(values, texture);
  if (type == "checkerboard") return BuildCheckerboard<T>(values, texture);
  if (type == "scale") return BuildScale<T>(values, texture);
  if (type == "mix") return BuildMix<T>(values, texture);
  if (type == "bilerp")
    return MakeBilerp<T>(BuildMapping(values.Context(), texture), GetConstant<T>(values, params, "v00", 0),
                         GetConstant<T>(values, params, "v01", 1), GetConstant<T>(values, params, "v10", 0),
                         GetConstant<T>(values, params, "v11", 1));
  if (type == "dots")
    return std::make_shared<DotsTexture<T>>(BuildMapping(values.Context(), texture),
                                            Get<T>(values, params, "inside", 1), Get<T>(values, params, "outside", 0));
  FailUnknownName(texture.location, "texture", type, kTextureTypes);
}

template <typename T>
TexturePtr<T> Build(Values& values, const TextureDescription& texture) {
  const BuildContext& context = values.Context();
  if (std::find(kUnsupportedTypes.begin(), kUnsupportedTypes.end(), texture.type) != kUnsupportedTypes.end()) {
    context.diagnostics.Warn(texture.location,
                             fmt::format("texture \"{}\" of type \"{}\" is not supported; the constant "
                                         "0.5 is used",
                                         texture.name, texture.type));
    texture.params.IgnoreAll();
    return MakeConstant(T(0.5f));
  }
  TexturePtr<T> result = BuildSupported<T>(values, texture);
  texture.params.ReportUnused(context.diagnostics);
  return result;
}

}  // namespace

ColorTexturePtr BuildColorTexture(Values& values, const TextureDescription& texture) {
  return Build<Color>(values, texture);
}

FloatTexturePtr BuildFloatTexture(Values& values, const TextureDescription& texture) {
  return Build<float>(values, texture);
}

}  // namespace dapple
