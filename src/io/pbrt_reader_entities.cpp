// The statements that describe what is in the scene and how it is rendered.
#include <fmt/format.h>

#include "src/io/nearest_name.h"
#include "src/io/pbrt_parameters.h"
#include "src/io/pbrt_reader.h"
#include "src/io/text_file.h"

namespace dapple {

namespace {

struct NamedTarget {
  std::string_view name;
  AttributeTarget target;
};
constexpr NamedTarget kAttributeTargets[] = {{"shape", AttributeTarget::Shape},
                                             {"light", AttributeTarget::Light},
                                             {"material", AttributeTarget::Material},
                                             {"medium", AttributeTarget::Medium},
                                             {"texture", AttributeTarget::Texture}};

struct NamedSpace {
  std::string_view name;
  RgbSpace space;
};
constexpr NamedSpace kRgbSpaces[] = {{"srgb", RgbSpace::Srgb},
                                     {"dci-p3", RgbSpace::DciP3},
                                     {"rec2020", RgbSpace::Rec2020},
                                     {"aces2065-1", RgbSpace::Aces2065_1}};

// Parameters of Attribute statements are copied to each statement that inherits them. They are few: a copy of ten takes
// 2 KB, some thirty times the text of a small shape.
constexpr std::size_t kInheritedAnyway = std::size_t{256} << 20, kMostInheritedOfText = 64;

}  // namespace

template <typename Description>
Description PbrtReader::ReadEntity(std::string_view what, WordKind kind) {
  Description description;
  description.location = here_;
  description.type = ReadName(what);
  votes_.Saw(kind, description.type, here_);
  return description;
}

void PbrtReader::Attribute() {
  const std::string name = ReadName("shape, light, material, medium or texture");
  std::vector<std::string> known;
  for (const NamedTarget& entry : kAttributeTargets) {
    known.emplace_back(entry.name);
    if (entry.name != name) continue;
    auto& attributes = state_.Now().attributes[static_cast<std::size_t>(entry.target)];
    ParameterList added = ReadParameters();
    if (attributes) AddDefaults(*attributes, &added);
    CheckCount(added, "Attribute statements");
    attributes = std::make_shared<const ParameterList>(std::move(added));
    return;
  }
  throw Error(here_,
              fmt::format("Attribute {}, expected \"shape\", \"light\", \"material\", \"medium\" or \"texture\"{}",
                          Quoted(name), DidYouMean(name, known)));
}

void PbrtReader::Option() {
  ParameterList added = ReadParameters();
  for (Parameter& parameter : added.All()) scene_.options.Add(std::move(parameter));
  CheckCount(scene_.options, "Option statements");
}

void PbrtReader::CheckCount(const ParameterList& parameters, std::string_view statements) const {
  if (parameters.All().size() > kMostParameters)
    throw Error(here_, fmt::format("{} set more than {} parameters", statements, kMostParameters));
}

void PbrtReader::AddDefaults(const ParameterList& defaults, ParameterList* parameters) {
  for (const Parameter& parameter : defaults.All()) inheritedBytes_ += MemoryBytes(parameter);
  const std::size_t most = kInheritedAnyway + kMostInheritedOfText * sources_.BytesRead();
  if (inheritedBytes_ > most)
    throw Error(here_, fmt::format("what Attribute statements set takes more than {} MB and {} times the text, for all "
                                   "those that inherit it",
                                   kInheritedAnyway >> 20, kMostInheritedOfText));
  parameters->AddDefaults(defaults);
}

void PbrtReader::ColorSpace() {
  const std::string name = ReadName("a colour space");
  std::vector<std::string> known;
  for (const NamedSpace& entry : kRgbSpaces) {
    known.emplace_back(entry.name);
    if (entry.name != name) continue;
    state_.Now().rgbSpace = entry.space;
    return;
  }
  throw Error(here_,
              fmt::format("unknown colour space {}, expected \"srgb\", \"dci-p3\", \"rec2020\" or \"aces2065-1\"{}",
                          Quoted(name), DidYouMean(name, known)));
}

void PbrtReader::Camera() {
  scene_.camera = ReadEntity<CameraDescription>("the type of camera", WordKind::Camera);
  scene_.camera.params = ReadParameters();
  scene_.camera.cameraFromWorld = state_.Now().transform;
  if (scene_.camera.cameraFromWorld.IsSingular()) throw Error(here_, "the camera's transform has no inverse");
  coordinateSystems_["camera"] = state_.Now().transform.Inverse();
}

void PbrtReader::Film() {
  scene_.film = ReadEntity("the type of film", WordKind::Film);
  scene_.film.params = ReadParameters();
}

void PbrtReader::Sampler() {
  scene_.sampler = ReadEntity("the type of sampler", WordKind::Sampler);
  scene_.sampler.params = ReadParameters();
}

void PbrtReader::Integrator() {
  scene_.integrator = ReadEntity("the type of integrator", WordKind::Integrator);
  scene_.integrator.params = ReadParameters();
  votes_.SawParameters(WordKind::IntegratorParameter, scene_.integrator.params);
}

void PbrtReader::Accelerator() {
  scene_.accelerator = ReadEntity("the type of accelerator", WordKind::Accelerator);
  scene_.accelerator.params = ReadParameters();
}

void PbrtReader::PixelFilter() {
  scene_.pixelFilter = ReadEntity("the type of filter", WordKind::PixelFilter);
  scene_.pixelFilter.params = ReadParameters();
  votes_.SawParameters(WordKind::FilterParameter, scene_.pixelFilter.params);
}

void PbrtReader::Material() {
  auto material = ReadEntity<MaterialDescription>("the type of material", WordKind::Material);
  material.params = ReadParameters(AttributeTarget::Material);
  votes_.SawParameters(WordKind::MaterialParameter, material.params);
  ResolveTextures(material.params);
  state_.Now().material = static_cast<int>(scene_.materials.size());
  scene_.materials.push_back(std::move(material));
}

void PbrtReader::MakeNamedMaterial() {
  MaterialDescription material;
  material.location = here_;
  material.name = ReadName("the material's name");
  material.params = ReadParameters(AttributeTarget::Material);
  material.type = material.params.GetString("type", "");
  if (!material.params.Has("type"))
    throw Error(here_,
                fmt::format("material {} has no type, expected a parameter \"string type\"", Quoted(material.name)));
  votes_.Saw(WordKind::Material, material.type, here_);
  votes_.SawParameters(WordKind::MaterialParameter, material.params);
  ResolveTextures(material.params);
  if (state_.materials.IsInScope(material.name))
    diagnostics_->Warn(
        here_, fmt::format("material {} is defined again; the new one counts from here on", Quoted(material.name)));
  state_.materials.Define(material.name, static_cast<int>(scene_.materials.size()));
  scene_.materials.push_back(std::move(material));
}

void PbrtReader::NamedMaterial() {
  const std::string name = ReadName("a material's name");
  int material = state_.materials.Find(name);
  if (material < 0) {
    material = ~static_cast<int>(pendingMaterials_.size());
    pendingMaterials_.push_back({name, here_});
  }
  state_.Now().material = material;
}

void PbrtReader::Texture() {
  const std::string name = ReadName("the texture's name");
  const std::string value = ReadName("\"float\" or \"spectrum\"");
  votes_.Saw(WordKind::TextureValue, value, here_);
  if (value != "float" && value != "spectrum" && value != "color")
    throw Error(here_,
                fmt::format("texture {} of {}, expected \"float\" or \"spectrum\"", Quoted(name), Quoted(value)));
  auto texture = ReadEntity<TextureDescription>("the type of texture", WordKind::Texture);
  texture.name = name;
  texture.isSpectrum = value != "float";
  texture.params = ReadParameters(AttributeTarget::Texture);
  votes_.SawParameters(WordKind::TextureParameter, texture.params);
  ResolveTextures(texture.params);
  texture.worldFromTexture = state_.Now().transform;
  ScopedNames& names = texture.isSpectrum ? state_.spectrumTextures : state_.floatTextures;
  if (names.IsInScope(name))
    diagnostics_->Warn(here_,
                       fmt::format("texture {} is defined again; the new one counts from here on", Quoted(name)));
  names.Define(name, static_cast<int>(scene_.textures.size()));
  scene_.textures.push_back(std::move(texture));
}

void PbrtReader::LightSource() {
  auto light = ReadEntity<LightDescription>("the type of light", WordKind::Light);
  light.params = ReadParameters(AttributeTarget::Light);
  votes_.SawParameters(WordKind::LightParameter, light.params);
  ResolveTextures(light.params);
  light.worldFromLight = state_.Now().transform;
  if (HasInverse("the light")) scene_.lights.push_back(std::move(light));
}

void PbrtReader::AreaLightSource() {
  Entity light = ReadEntity("the type of area light", WordKind::Light);
  light.params = ReadParameters(AttributeTarget::Light);
  votes_.SawParameters(WordKind::LightParameter, light.params);
  state_.Now().areaLight = static_cast<int>(scene_.areaLights.size());
  scene_.areaLights.push_back(std::move(light));
}

void PbrtReader::Shape() {
  auto shape = ReadEntity<ShapeDescription>("the type of shape", WordKind::Shape);
  shape.params = ReadParameters(AttributeTarget::Shape);
  votes_.SawParameters(WordKind::ShapeParameter, shape.params);
  if (!HasInverse("the shape")) return;
  ResolveTextures(shape.params);
  const GraphicsState& now = state_.Now();
  shape.worldFromShape = now.transform;
  shape.reverseOrientation = now.reverseOrientation;
  shape.material = now.material;
  shape.areaLight = now.areaLight;
  (object_ < 0 ? scene_.shapes : scene_.objects[static_cast<std::size_t>(object_)].shapes).push_back(std::move(shape));
}

void PbrtReader::ReverseOrientation() { state_.Now().reverseOrientation = !state_.Now().reverseOrientation; }

void PbrtReader::MediumInterface() {
  std::string media = ReadName("the inner medium's name");
  if (Lexer().Peek().kind == TokenKind::String) media += ReadName("the outer medium's name");
  if (!media.empty()) WarnOfMedia();
}

void PbrtReader::MakeNamedMedium() {
  ReadName("the medium's name");
  ReadParameters();
  WarnOfMedia();
}

void PbrtReader::WarnOfMedia() {
  if (!mediaWarned_)
    diagnostics_->Warn(here_, "participating media are not supported; the scene is rendered without them");
  mediaWarned_ = true;
}

bool PbrtReader::HasInverse(std::string_view what) {
  const bool hasInverse = !state_.Now().transform.IsSingular();
  if (!hasInverse) diagnostics_->Warn(here_, fmt::format("{} is left out: its transform has no inverse", what));
  return hasInverse;
}

}  // namespace dapple
