#include "src/io/pbrt_reader.h"

#include <algorithm>

#include <fmt/format.h>

#include "src/io/nearest_name.h"
#include "src/io/pbrt_parameters.h"
#include "src/io/text_file.h"

namespace dapple {

PbrtReader::PbrtReader(int assumedVersion, const std::filesystem::path& folder, Diagnostics& diagnostics)
    : diagnostics_(&diagnostics), state_(assumedVersion == 4, diagnostics) {
  scene_.folder = folder;
  MaterialDescription byDefault;
  byDefault.type = "diffuse";
  scene_.materials.push_back(std::move(byDefault));
}

void PbrtReader::ReadFile(const std::filesystem::path& path) {
  here_ = FileLocation(path.string());
  PushFile(path);
  Run();
}

PbrtSources::Source& PbrtReader::PushFile(const std::filesystem::path& path) {
  PbrtSources::Source& source = sources_.PushFile(path, here_);
  scene_.textFiles.push_back(path);
  return source;
}

void PbrtReader::ReadText(std::string_view text, const std::string& name) {
  here_ = FileLocation(name);
  sources_.PushText(std::string(text), name);
  Run();
}

const std::unordered_map<std::string_view, PbrtReader::Directive>& PbrtReader::Directives() {
  using R = PbrtReader;
  static const std::unordered_map<std::string_view, Directive> directives = {
      {"Identity", {&R::Identity, Part::Any}},
      {"Translate", {&R::Translate, Part::Any}},
      {"Scale", {&R::Scale, Part::Any}},
      {"Rotate", {&R::Rotate, Part::Any}},
      {"LookAt", {&R::LookAt, Part::Any}},
      {"Transform", {&R::SetTransform, Part::Any}},
      {"ConcatTransform", {&R::ConcatTransform, Part::Any}},
      {"CoordinateSystem", {&R::CoordinateSystem, Part::Any}},
      {"CoordSysTransform", {&R::CoordSysTransform, Part::Any}},
      {"ActiveTransform", {&R::ActiveTransform, Part::Any}},
      {"TransformTimes", {&R::TransformTimes, Part::Options}},
      {"Include", {&R::Include, Part::Any}},
      {"Import", {&R::Import, Part::World}},
      {"WorldBegin", {&R::WorldBegin, Part::Options}},
      {"WorldEnd", {&R::WorldEnd, Part::World}},
      {"AttributeBegin", {&R::AttributeBegin, Part::World}},
      {"AttributeEnd", {&R::AttributeEnd, Part::World}},
      {"TransformBegin", {&R::TransformBegin, Part::World}},
      {"TransformEnd", {&R::TransformEnd, Part::World}},
      {"ObjectBegin", {&R::ObjectBegin, Part::World}},
      {"ObjectEnd", {&R::ObjectEnd, Part::World}},
      {"ObjectInstance", {&R::ObjectInstance, Part::World}},
      {"Attribute", {&R::Attribute, Part::Any}},
      {"Option", {&R::Option, Part::Any}},
      {"ColorSpace", {&R::ColorSpace, Part::Any}},
      {"Camera", {&R::Camera, Part::Options}},
      {"Film", {&R::Film, Part::Options}},
      {"Sampler", {&R::Sampler, Part::Options}},
      {"Integrator", {&R::Integrator, Part::Options}},
      {"Accelerator", {&R::Accelerator, Part::Options}},
      {"PixelFilter", {&R::PixelFilter, Part::Options}},
      {"Material", {&R::Material, Part::World}},
      {"MakeNamedMaterial", {&R::MakeNamedMaterial, Part::Any}},
      {"NamedMaterial", {&R::NamedMaterial, Part::World}},
      {"Texture", {&R::Texture, Part::World}},
      {"LightSource", {&R::LightSource, Part::World}},
      {"AreaLightSource", {&R::AreaLightSource, Part::World}},
      {"Shape", {&R::Shape, Part::World}},
      {"ReverseOrientation", {&R::ReverseOrientation, Part::World}},
      {"MediumInterface", {&R::MediumInterface, Part::Any}},
      {"MakeNamedMedium", {&R::MakeNamedMedium, Part::Any}},
  };
  return directives;
}

void PbrtReader::Run() {
  while (!sources_.IsEmpty()) {
    const Token token = Lexer().Next();
    if (token.kind == TokenKind::End) {
      LeaveSource();
    } else if (hasEnded_) {
      diagnostics_->Warn(Lexer().Location(token), "what stands behind WorldEnd is not read");
      return;
    } else {
      RunStatement(token);
    }
  }
  if (isWorld_ && !hasEnded_) votes_.Saw(WordKind::Ending, "WorldBegin without WorldEnd", worldBegin_);
}

void PbrtReader::RunStatement(const Token& token) {
  here_ = Lexer().Location(token);
  if (token.kind != TokenKind::Word) throw Error(here_, fmt::format("expected a directive, found {}", Describe(token)));
  const auto found = Directives().find(token.text);
  if (found == Directives().end()) FailUnknownDirective(token);
  directive_ = found->first;
  CheckPart(directive_, found->second.part);
  votes_.Saw(WordKind::Directive, directive_, here_);
  (this->*found->second.read)();
}

void PbrtReader::LeaveSource() {
  const PbrtSources::Source& source = sources_.Top();
  if (source.isImport) {
    // What the imported file changed ends with it; a block that it leaves open is a mistake.
    const auto open = state_.OpenBlocks(source.blockCount + 1);
    if (!open.empty()) throw Error(open.back().location, open.back().message);
    state_.End(BlockKind::Import, source.includedAt);
  }
  sources_.Pop();
}

void PbrtReader::FailUnknownDirective(const Token& token) {
  std::vector<std::string> names;
  for (const auto& entry : Directives()) names.emplace_back(entry.first);
  std::sort(names.begin(), names.end());
  throw Error(here_, fmt::format("unknown directive {}{}", Quoted(token.text), DidYouMean(token.text, names)));
}

void PbrtReader::CheckPart(std::string_view name, Part part) const {
  if (part == Part::World && !isWorld_)
    throw Error(here_, fmt::format("{} before WorldBegin, expected behind it", name));
  if (part == Part::Options && isWorld_)
    throw Error(here_, fmt::format("{} behind WorldBegin ({}), expected before it", name, worldBegin_.ToString()));
}

std::string PbrtReader::ReadName(std::string_view what) {
  const Token token = Lexer().Next();
  if (token.kind == TokenKind::String) return std::string(token.text);
  throw Error(Lexer().Location(token),
              fmt::format("{}: expected {} in quotes, found {}", directive_, what, Describe(token)));
}

double PbrtReader::ReadNumber(std::size_t count) {
  const Token token = Lexer().Next();
  if (token.kind == TokenKind::Number) return token.number;
  throw Error(Lexer().Location(token),
              fmt::format("{}: expected {} numbers, found {}", directive_, count, Describe(token)));
}

void PbrtReader::ReadCloseBracket(std::size_t count) {
  const Token token = Lexer().Next();
  if (token.kind == TokenKind::CloseBracket) return;
  throw Error(Lexer().Location(token),
              fmt::format("{}: expected \"]\" behind {} numbers, found {}", directive_, count, Describe(token)));
}

ParameterList PbrtReader::ReadParameters() {
  return ParseParameters(Lexer(), state_.Now().rgbSpace, votes_, *diagnostics_);
}

ParameterList PbrtReader::ReadParameters(AttributeTarget defaults) {
  ParameterList parameters = ReadParameters();
  const auto& attributes = state_.Now().attributes[static_cast<std::size_t>(defaults)];
  if (attributes) AddDefaults(*attributes, &parameters);
  return parameters;
}

void PbrtReader::Include() {
  const std::string name = ReadName("a file name");
  PushFile(scene_.ResolvePath(name, here_));
}

void PbrtReader::Import() {
  const std::string name = ReadName("a file name");
  const std::size_t blockCount = state_.BlockCount();
  PbrtSources::Source& source = PushFile(scene_.ResolvePath(name, here_));
  source.isImport = true;
  source.blockCount = blockCount;
  state_.Begin(BlockKind::Import, here_);
}

void PbrtReader::WorldBegin() {
  isWorld_ = true;
  worldBegin_ = here_;
  GraphicsState& now = state_.Now();
  now.startTimeActive = now.endTimeActive = true;
  now.transform = Transform();
  coordinateSystems_["world"] = now.transform;
}

void PbrtReader::WorldEnd() {
  // pbrt-v3 warns of open blocks here, and renders.
  for (const auto& open : state_.OpenBlocks()) diagnostics_->Warn(open.location, open.message);
  hasEnded_ = true;
}

void PbrtReader::AttributeBegin() { state_.Begin(BlockKind::Attribute, here_); }

void PbrtReader::AttributeEnd() { state_.End(BlockKind::Attribute, here_); }

void PbrtReader::TransformBegin() {
  sawTransformBlock_ = true;
  state_.Begin(BlockKind::Transform, here_);
}

void PbrtReader::TransformEnd() { state_.End(BlockKind::Transform, here_); }

void PbrtReader::ObjectBegin() {
  const std::string name = ReadName("the object's name");
  if (object_ >= 0) {
    const ObjectDefinition& outer = scene_.objects[static_cast<std::size_t>(object_)];
    throw Error(here_, fmt::format("ObjectBegin within the object {} ({}), expected ObjectEnd first",
                                   Quoted(outer.name), outer.location.ToString()));
  }
  state_.Begin(BlockKind::Object, here_);
  object_ = static_cast<int>(scene_.objects.size());
  scene_.objects.push_back({name, {}, here_});
  const bool isNew = objects_.insert_or_assign(name, object_).second;
  if (!isNew)
    diagnostics_->Warn(
        here_, fmt::format("object {} is defined again; instances from here on show the new one", Quoted(name)));
}

void PbrtReader::ObjectEnd() {
  state_.End(BlockKind::Object, here_);
  object_ = -1;
}

void PbrtReader::ObjectInstance() {
  const std::string name = ReadName("an object's name");
  if (object_ >= 0) throw Error(here_, "ObjectInstance within an object, expected ObjectEnd first");
  if (!HasInverse("the instance")) return;
  const auto found = objects_.find(name);
  const int object = found == objects_.end() ? -1 : found->second;
  if (object < 0) pendingInstances_.push_back({scene_.instances.size(), name});
  scene_.instances.push_back({object, state_.Now().transform, here_});
}

SceneDescription PbrtReader::Finish(int version) {
  if (!isWorld_) throw Error(here_, "the scene has no WorldBegin, expected one before its shapes and lights");
  if (!hasEnded_) {
    const auto open = state_.OpenBlocks();
    if (!open.empty()) throw Error(open.back().location, open.back().message);
    if (version == 3) throw Error(worldBegin_, "WorldBegin without WorldEnd, which pbrt-v3 files have at their end");
  }
  ResolvePending();
  scene_.version = version;
  return std::move(scene_);
}

int PbrtReader::MaterialBehind(int material) const {
  if (material >= 0) return material;
  const PendingName& pending = pendingMaterials_[static_cast<std::size_t>(~material)];
  const int index = state_.materials.Find(pending.name);
  if (index < 0)
    throw Error(pending.location, fmt::format("no material is named {}{}", Quoted(pending.name),
                                              DidYouMean(pending.name, state_.materials.All())));
  return index;
}

void PbrtReader::FailUnknownObject(const std::string& name, const FileLocation& location) const {
  std::vector<std::string> known;
  for (const ObjectDefinition& object : scene_.objects) known.push_back(object.name);
  throw Error(location, fmt::format("no object is named {}{}", Quoted(name), DidYouMean(name, known)));
}

void PbrtReader::ResolvePending() {
  for (const auto& pending : pendingInstances_) {
    InstanceDescription& instance = scene_.instances[pending.instance];
    const auto found = objects_.find(pending.name);
    if (found == objects_.end()) FailUnknownObject(pending.name, instance.location);
    instance.object = found->second;
  }
  const auto resolve = [&](std::vector<ShapeDescription>& shapes) {
    for (ShapeDescription& shape : shapes) {
      shape.material = MaterialBehind(shape.material);
      ResolveTextures(shape.params);
    }
  };
  resolve(scene_.shapes);
  for (ObjectDefinition& object : scene_.objects) resolve(object.shapes);
  for (MaterialDescription& material : scene_.materials) ResolveTextures(material.params);
  for (LightDescription& light : scene_.lights) ResolveTextures(light.params);
}

void PbrtReader::ResolveTextures(ParameterList& parameters) const {
  for (Parameter& parameter : parameters.All()) {
    if (parameter.type != ParameterType::Texture) continue;
    if (parameter.floatTexture < 0) parameter.floatTexture = state_.floatTextures.Find(parameter.strings[0]);
    if (parameter.spectrumTexture < 0) parameter.spectrumTexture = state_.spectrumTextures.Find(parameter.strings[0]);
  }
}

}  // namespace dapple
