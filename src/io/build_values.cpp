#include "src/io/build_values.h"

#include <fmt/format.h>

#include "src/io/build_textures.h"
#include "src/io/nearest_name.h"
#include "src/io/text_file.h"
#include "src/io/value_bounds.h"
#include "src/materials/named_spectra.h"
#include "src/materials/procedural_textures.h"

namespace dapple {

namespace {

// A level takes some kilobytes of the stack when it is built, much less when it is asked.
constexpr std::size_t kDeepest = 256, kMostEvaluations = 65'536;

const char* RgbSpaceName(RgbSpace space) {
  switch (space) {
    case RgbSpace::DciP3:
      return "dci-p3";
    case RgbSpace::Rec2020:
      return "rec2020";
    case RgbSpace::Aces2065_1:
      return "aces2065-1";
    default:
      return "srgb";
  }
}

void CheckOneValue(const Parameter& parameter, int count) {
  if (count == 1) return;
  throw Error(parameter.location, fmt::format("parameter \"{}\" has {} values, expected one", parameter.name, count));
}

/// `of` says in messages which of the parameter's numbers it is.
void CheckNumber(const Parameter& parameter, std::string_view of, double number, const ValueBounds& bounds) {
  if (bounds.Contains(number)) return;
  throw Error(parameter.location,
              fmt::format("{} of parameter \"{}\" is {}, expected {}", of, parameter.name, number, bounds.ToString()));
}

/// `parameter` names a texture of the right kind, which was not there yet where it stands.
[[noreturn]] void FailForwardTexture(const Parameter& parameter, const TextureDescription& named) {
  const std::vector<Parameter>& own = named.params.All();
  const bool isOwn = std::any_of(own.begin(), own.end(), [&](const Parameter& of) { return &of == &parameter; });
  if (isOwn) throw Error(parameter.location, fmt::format("texture \"{}\" names itself", named.name));
  throw Error(parameter.location,
              fmt::format("texture \"{}\" is defined further down ({}), expected before the texture that names it",
                          named.name, named.location.ToString()));
}

void CheckDepth(const Parameter& parameter, std::size_t depth) {
  if (depth > kDeepest)
    throw Error(parameter.location, fmt::format("textures name each other more than {} deep", kDeepest));
}

[[noreturn]] void FailColorType(const Parameter& parameter) {
  throw Error(parameter.location, fmt::format("parameter \"{}\" is \"{}\", expected a colour: \"rgb\", \"spectrum\", "
                                              "\"blackbody\" or a texture",
                                              parameter.name, TypeName(parameter.type)));
}

}  // namespace

Values::Values(const BuildContext& context)
    : context_(context),
      images_(&context.diagnostics),
      colorTextures_(context.description.textures.size()),
      floatTextures_(context.description.textures.size()),
      costs_(context.description.textures.size()) {}

Spectrum Values::ToSpectrum(const Parameter& parameter) const {
  const Spectrum::Outside outside = context_.IsV3() ? Spectrum::Outside::kConstant : Spectrum::Outside::kZero;
  if (parameter.strings.empty()) return Spectrum::FromPairs(parameter.numbers, outside, parameter.location);
  CheckOneValue(parameter, parameter.Count());
  const std::string& name = parameter.strings[0];
  if (IsSpectrumName(name)) return NamedSpectrum(name, parameter.location);
  const std::filesystem::path path = context_.description.ResolvePath(name, parameter.location);
  std::error_code failure;
  if (!std::filesystem::exists(path, failure))
    throw Error(parameter.location,
                fmt::format("no file and no spectrum is named \"{}\"{}", name, DidYouMean(name, SpectrumNames())));
  return ParseSpectrum(ReadTextFile(path, parameter.location), path.string(), outside);
}

Color Values::ToColor(const Parameter& parameter, RgbUse use) const {
  const bool isV3 = context_.IsV3(), isEmission = use == RgbUse::kEmission;
  const std::vector<double>& numbers = parameter.numbers;
  const auto triple = [&] {
    CheckOneValue(parameter, parameter.Count());
    return Color(static_cast<float>(numbers[0]), static_cast<float>(numbers[1]), static_cast<float>(numbers[2]));
  };
  switch (parameter.type) {
    case ParameterType::Rgb:
      return isV3 ? triple() : RgbFromColorSpace(triple(), RgbSpaceName(parameter.rgbSpace), use, parameter.location);
    case ParameterType::Xyz: {
      triple();
      return XyzToRgb({numbers[0], numbers[1], numbers[2]});
    }
    case ParameterType::Float: {
      CheckOneValue(parameter, parameter.Count());
      return Color(static_cast<float>(numbers[0]));
    }
    case ParameterType::Blackbody:
      if (!isV3) {
        CheckOneValue(parameter, parameter.Count());
        CheckNumber(parameter, "the temperature", numbers[0], kPositive);
        return BlackbodyV4(numbers[0]);
      }
      if (numbers.size() != 2)
        throw Error(parameter.location, fmt::format("parameter \"{}\" has {} numbers, expected two: kelvin and scale",
                                                    parameter.name, numbers.size()));
      CheckNumber(parameter, "the temperature", numbers[0], kPositive);
      CheckNumber(parameter, "the scale", numbers[1], kNotNegative);
      return BlackbodyV3(numbers[0]) * static_cast<float>(numbers[1]);
    case ParameterType::Spectrum:
      if (isV3) return SpectrumToColorV3(ToSpectrum(parameter));
      return isEmission ? EmissionToColorV4(ToSpectrum(parameter)) : SpectrumToColorV4(ToSpectrum(parameter));
    default:
      FailColorType(parameter);
  }
}

Color Values::GetConstantColor(const ParameterList& params, std::string_view name, const Color& fallback,
                               RgbUse use) const {
  const Parameter* parameter = params.Find(name);
  if (!parameter) return fallback;
  const Color color = ToColor(*parameter, use);
  const bool saysNegative = parameter->type == ParameterType::Rgb || parameter->type == ParameterType::Float;
  const bool isNegative =
      saysNegative && std::any_of(parameter->numbers.begin(), parameter->numbers.end(), [](double x) { return x < 0; });
  if (use == RgbUse::kEmission && isNegative)
    throw Error(parameter->location, fmt::format("parameter \"{}\" has a negative value, expected 0 or more", name));
  // What is left of negative values stands for colours outside the gamut.
  return use == RgbUse::kEmission ? Map(color, [](float x) { return std::max(x, 0.f); }) : color;
}

void Values::FailTexture(const Parameter& parameter, bool isSpectrum) const {
  const std::string& name = parameter.strings[0];
  const bool isOfOtherKind = (isSpectrum ? parameter.floatTexture : parameter.spectrumTexture) >= 0;
  const char* kind = isSpectrum ? "spectrum" : "float";
  if (isOfOtherKind)
    throw Error(parameter.location, fmt::format("texture \"{}\" of parameter \"{}\" is a {} texture, expected a {} one",
                                                name, parameter.name, isSpectrum ? "float" : "spectrum", kind));
  std::vector<std::string> known;
  for (const TextureDescription& texture : context_.description.textures) {
    if (texture.isSpectrum != isSpectrum) continue;
    if (texture.name == name) FailForwardTexture(parameter, texture);
    known.push_back(texture.name);
  }
  throw Error(parameter.location,
              fmt::format("no {} texture is named \"{}\" here{}", kind, name, DidYouMean(name, known)));
}

void Values::AddCost(const Parameter& parameter, const TextureCost& part) {
  if (building_.empty()) return;
  TextureCost& whole = building_.back();
  whole.evaluations += part.evaluations;
  whole.depth = std::max(whole.depth, part.depth + 1);
  CheckDepth(parameter, whole.depth);
  if (whole.evaluations > kMostEvaluations)
    throw Error(parameter.location, fmt::format("textures name each other so often that one look at this one may take "
                                                "more than {} evaluations, expected fewer",
                                                kMostEvaluations));
}

template <typename Ptr, typename Build>
Ptr Values::TextureAt(const Parameter& parameter, int index, std::vector<Ptr>* built, Build build) {
  const auto i = static_cast<size_t>(index);
  Ptr& texture = (*built)[i];
  if (!texture) {
    CheckDepth(parameter, building_.size() + 1);
    building_.emplace_back();
    texture = build(*this, context_.description.textures[i]);
    costs_[i] = building_.back();
    building_.pop_back();
  }
  AddCost(parameter, costs_[i]);
  return texture;
}

ColorTexturePtr Values::ColorTextureAt(const Parameter& parameter) {
  CheckOneValue(parameter, parameter.Count());
  if (parameter.spectrumTexture < 0) FailTexture(parameter, true);
  return TextureAt(parameter, parameter.spectrumTexture, &colorTextures_, BuildColorTexture);
}

FloatTexturePtr Values::FloatTextureAt(const Parameter& parameter) {
  CheckOneValue(parameter, parameter.Count());
  if (parameter.floatTexture < 0) FailTexture(parameter, false);
  return TextureAt(parameter, parameter.floatTexture, &floatTextures_, BuildFloatTexture);
}

ColorTexturePtr Values::FindColor(const ParameterList& params, std::string_view name) {
  const Parameter* parameter = params.Find(name);
  if (!parameter) return nullptr;
  if (parameter->type == ParameterType::Texture) return ColorTextureAt(*parameter);
  return MakeConstant(ToColor(*parameter, RgbUse::kReflectance));
}

ColorTexturePtr Values::GetColor(const ParameterList& params, std::string_view name, const Color& fallback) {
  ColorTexturePtr texture = FindColor(params, name);
  return texture ? texture : MakeConstant(fallback);
}

FloatTexturePtr Values::FindFloat(const ParameterList& params, std::string_view name) {
  const Parameter* parameter = params.Find(name);
  if (!parameter) return nullptr;
  if (parameter->type == ParameterType::Texture) return FloatTextureAt(*parameter);
  return MakeConstant(static_cast<float>(params.GetFloat(name, 0)));
}

FloatTexturePtr Values::GetFloat(const ParameterList& params, std::string_view name, double fallback) {
  FloatTexturePtr texture = FindFloat(params, name);
  return texture ? texture : MakeConstant(static_cast<float>(fallback));
}

FloatTexturePtr Values::FindIndexOfRefraction(const ParameterList& params, std::string_view name) {
  const Parameter* parameter = params.Find(name);
  if (!parameter) return nullptr;
  FloatTexturePtr eta;
  if (parameter->type == ParameterType::Spectrum)
    eta = MakeConstant(static_cast<float>(ToSpectrum(*parameter)(kFraunhoferD)));
  else if (parameter->type == ParameterType::Rgb)
    eta = MakeConstant(ToColor(*parameter, RgbUse::kReflectance).g);
  else
    eta = FindFloat(params, name);
  if (parameter->type != ParameterType::Texture)
    CheckNumber(*parameter, "the value", static_cast<double>(eta->Evaluate(TextureContext())), kPositive);
  return eta;
}

std::string Values::FilePath(const Parameter& fileName) const {
  if (fileName.type != ParameterType::String)
    throw Error(fileName.location,
                fmt::format("parameter \"{}\" is \"{}\", expected \"string\"", fileName.name, TypeName(fileName.type)));
  CheckOneValue(fileName, fileName.Count());
  return context_.description.ResolvePath(fileName.strings[0], fileName.location).string();
}

std::shared_ptr<const Image> Values::GetImage(const Parameter& fileName, ColorEncoding encoding) {
  return images_.Get(FilePath(fileName), encoding, fileName.location);
}

Image Values::ReadImageOnce(const Parameter& fileName, ColorEncoding encoding) {
  Image image = ReadImage(FilePath(fileName), encoding, fileName.location);
  ++readOnce_;
  return image;
}

}  // namespace dapple
