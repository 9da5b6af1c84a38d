// Parameters as colours, numbers and textures.
//
// A parameter of a material or texture is a constant or names a texture; either way it comes out as a texture.
// Constants of lights come out as colours. Which RGB stands for a spectrum is pbrt's choice and depends on the version
// (src/materials/spectrum.h).
#pragma once

#include <string>
#include <vector>

#include "src/io/build_context.h"
#include "src/materials/image_texture.h"
#include "src/materials/spectrum.h"
#include "src/materials/texture.h"
#include "src/scene/scene_resources.h"

namespace dapple {

/// A gray of a float texture.
class GrayTexture final : public ColorTexture {
 public:
  explicit GrayTexture(FloatTexturePtr gray) : gray_(std::move(gray)) {}
  Color Evaluate(const TextureContext& at) const override { return Color(gray_->Evaluate(at)); }
  bool IsConstant() const override { return gray_->IsConstant(); }

 private:
  FloatTexturePtr gray_;
};

/// What one look at a texture may take.
struct TextureCost {
  std::size_t evaluations = 1;  ///< of it and of all textures below it, one that is named twice twice
  std::size_t depth = 1;        ///< textures on the longest way down
};

/// Builds what parameters say; builds textures when they are first asked for, each once.
class Values {
 public:
  /// `context` must live as long.
  explicit Values(const BuildContext& context);

  const BuildContext& Context() const { return context_; }

  // Textures. An absent parameter gives `fallback`, or null from `Find...`. Errors: a texture of that name is not there
  // or is of the other kind; a type that is no colour or number; more than one value; textures that name each other
  // more than 256 deep, or so often that one look at the first may take more than 65,536 evaluations.
  ColorTexturePtr GetColor(const ParameterList& params, std::string_view name, const Color& fallback);
  ColorTexturePtr FindColor(const ParameterList& params, std::string_view name);
  FloatTexturePtr GetFloat(const ParameterList& params, std::string_view name, double fallback);
  FloatTexturePtr FindFloat(const ParameterList& params, std::string_view name);

  /// A colour without texture; emission has its own conversion (RgbUse), and must not be negative.
  Color GetConstantColor(const ParameterList& params, std::string_view name, const Color& fallback, RgbUse use) const;
  /// One index of refraction: a number, a float texture, or a spectrum at the helium d line. Throws `Error` where a
  /// constant one is not above 0.
  FloatTexturePtr FindIndexOfRefraction(const ParameterList& params, std::string_view name);
  /// A spectrum parameter's function of the wavelength.
  Spectrum ToSpectrum(const Parameter& parameter) const;

  /// The path of the file that a parameter names. Throws `Error` where it is no string, or more than one.
  std::string FilePath(const Parameter& fileName) const;
  /// The image that a parameter names, fit for textures (`ImageCache::Get`).
  std::shared_ptr<const Image> GetImage(const Parameter& fileName, ColorEncoding encoding);
  /// The same as it stands in the file, for one use.
  Image ReadImageOnce(const Parameter& fileName, ColorEncoding encoding);
  /// Image files that were opened so far, and the bytes of those that are kept.
  ImageUse Images() const { return {images_.OpenedCount() + readOnce_, images_.MemoryBytes()}; }

 private:
  ColorTexturePtr ColorTextureAt(const Parameter& parameter);
  FloatTexturePtr FloatTextureAt(const Parameter& parameter);
  /// `(*built)[index]`, which `build` makes where it is not there yet; `parameter` names it.
  template <typename Ptr, typename Build>
  Ptr TextureAt(const Parameter& parameter, int index, std::vector<Ptr>* built, Build build);
  /// Adds to the cost of the texture that is being built, if one is, that of the one that its `parameter` names.
  void AddCost(const Parameter& parameter, const TextureCost& part);
  Color ToColor(const Parameter& parameter, RgbUse use) const;
  [[noreturn]] void FailTexture(const Parameter& parameter, bool isSpectrum) const;

  const BuildContext& context_;
  ImageCache images_;
  int readOnce_ = 0;
  std::vector<ColorTexturePtr> colorTextures_;  // by index of the description; null: not built yet
  std::vector<FloatTexturePtr> floatTextures_;
  std::vector<TextureCost> costs_;     // of those that are built
  std::vector<TextureCost> building_;  // so far, of those that are being built; each names the next
};

}  // namespace dapple
