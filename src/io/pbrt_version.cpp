#include "src/io/pbrt_version.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>

namespace dapple {

namespace {

struct Evidence {
  WordKind kind;
  std::string_view word;
  int version;
  int weight;
};

// Weights, each kind more than all of the next together speak in any file: a directive that makes the other version
// refuse the file; a name that only one version knows; WorldEnd, which a v3 file needs, but which is also what is left
// behind when a v3 file is made into a v4 one; a habit of one version's files, 1 to 3.
constexpr int kRefused = 10'000, kName = 40, kWorldEnd = 20;

constexpr Evidence kEvidence[] = {
    {WordKind::Directive, "WorldEnd", 3, kWorldEnd},
    {WordKind::Directive, "TransformBegin", 3, 1},
    {WordKind::Directive, "Attribute", 4, kRefused},
    {WordKind::Directive, "Option", 4, kRefused},
    {WordKind::Directive, "ColorSpace", 4, kRefused},
    {WordKind::Directive, "Import", 4, kRefused},
    {WordKind::Ending, "WorldBegin without WorldEnd", 4, 3},

    {WordKind::ParameterType, "point", 3, kName},
    {WordKind::ParameterType, "vector", 3, kName},
    {WordKind::ParameterType, "color", 3, kName},
    {WordKind::ParameterType, "xyz", 3, 2},
    {WordKind::ParameterType, "point2", 4, 1},
    {WordKind::ParameterType, "point3", 4, 1},
    {WordKind::ParameterType, "vector2", 4, 1},
    {WordKind::ParameterType, "vector3", 4, 1},
    {WordKind::BoolSpelling, "quoted", 3, 3},
    {WordKind::BoolSpelling, "bare", 4, 3},
    {WordKind::BlackbodyForm, "scaled", 3, 2},
    {WordKind::BlackbodyForm, "plain", 4, 2},

    {WordKind::Camera, "environment", 3, kName},
    {WordKind::Camera, "spherical", 4, kName},
    {WordKind::Film, "image", 3, kName},
    {WordKind::Film, "rgb", 4, kName},
    {WordKind::Film, "gbuffer", 4, kName},
    {WordKind::Film, "spectral", 4, kName},
    {WordKind::Sampler, "lowdiscrepancy", 3, kName},
    {WordKind::Sampler, "02sequence", 3, kName},
    {WordKind::Sampler, "maxmindist", 3, kName},
    {WordKind::Sampler, "random", 3, kName},
    {WordKind::Sampler, "independent", 4, kName},
    {WordKind::Sampler, "paddedsobol", 4, kName},
    {WordKind::Sampler, "zsobol", 4, kName},
    {WordKind::Sampler, "pmj02bn", 4, kName},
    {WordKind::Integrator, "directlighting", 3, kName},
    {WordKind::Integrator, "whitted", 3, kName},
    {WordKind::Integrator, "simplepath", 4, kName},
    {WordKind::Integrator, "simplevolpath", 4, kName},
    {WordKind::Integrator, "lightpath", 4, kName},
    {WordKind::Integrator, "randomwalk", 4, kName},
    {WordKind::Integrator, "function", 4, kName},
    {WordKind::IntegratorParameter, "numiterations", 3, 2},
    {WordKind::FilterParameter, "xwidth", 3, kName},
    {WordKind::FilterParameter, "ywidth", 3, kName},
    {WordKind::FilterParameter, "xradius", 4, kName},
    {WordKind::FilterParameter, "yradius", 4, kName},

    {WordKind::Material, "matte", 3, kName},
    {WordKind::Material, "glass", 3, kName},
    {WordKind::Material, "metal", 3, kName},
    {WordKind::Material, "mirror", 3, kName},
    {WordKind::Material, "plastic", 3, kName},
    {WordKind::Material, "substrate", 3, kName},
    {WordKind::Material, "uber", 3, kName},
    {WordKind::Material, "translucent", 3, kName},
    {WordKind::Material, "disney", 3, kName},
    {WordKind::Material, "fourier", 3, kName},
    {WordKind::Material, "kdsubsurface", 3, kName},
    {WordKind::Material, "diffuse", 4, kName},
    {WordKind::Material, "coateddiffuse", 4, kName},
    {WordKind::Material, "coatedconductor", 4, kName},
    {WordKind::Material, "conductor", 4, kName},
    {WordKind::Material, "dielectric", 4, kName},
    {WordKind::Material, "thindielectric", 4, kName},
    {WordKind::Material, "diffusetransmission", 4, kName},
    {WordKind::Material, "measured", 4, kName},
    {WordKind::Material, "interface", 4, kName},
    {WordKind::MaterialParameter, "namedmaterial1", 3, kName},
    {WordKind::MaterialParameter, "namedmaterial2", 3, kName},
    {WordKind::MaterialParameter, "bumpmap", 3, kName},
    {WordKind::MaterialParameter, "materials", 4, kName},
    {WordKind::MaterialParameter, "displacement", 4, kName},
    {WordKind::MaterialParameter, "normalmap", 4, kName},

    {WordKind::TextureValue, "color", 3, kName},
    {WordKind::TextureValue, "spectrum", 4, 1},
    {WordKind::Texture, "uv", 3, kName},
    {WordKind::Texture, "directionmix", 4, kName},
    {WordKind::Texture, "ptex", 4, 1},
    {WordKind::TextureParameter, "trilinear", 3, kName},
    {WordKind::TextureParameter, "gamma", 3, kName},
    {WordKind::TextureParameter, "encoding", 4, kName},
    {WordKind::TextureParameter, "filter", 4, kName},
    {WordKind::TextureParameter, "invert", 4, kName},

    {WordKind::Light, "exinfinite", 3, kName},
    {WordKind::LightParameter, "mapname", 3, kName},
    {WordKind::LightParameter, "nsamples", 3, 2},
    {WordKind::LightParameter, "samples", 3, 2},
    {WordKind::LightParameter, "filename", 4, kName},
    {WordKind::LightParameter, "power", 4, kName},
    {WordKind::LightParameter, "illuminance", 4, kName},
    {WordKind::LightParameter, "portal", 4, kName},

    {WordKind::Shape, "cone", 3, kName},
    {WordKind::Shape, "hyperboloid", 3, kName},
    {WordKind::Shape, "paraboloid", 3, kName},
    {WordKind::Shape, "heightfield", 3, kName},
    {WordKind::Shape, "nurbs", 3, kName},
    {WordKind::Shape, "bilinearmesh", 4, kName},
    {WordKind::ShapeParameter, "nlevels", 3, kName},
    {WordKind::ShapeParameter, "shadowalpha", 3, kName},
    {WordKind::ShapeParameter, "st", 3, 2},
};

using EvidenceIndex = std::map<std::pair<WordKind, std::string_view>, std::size_t>;

const EvidenceIndex& Index() {
  static const EvidenceIndex index = [] {
    EvidenceIndex result;
    for (std::size_t i = 0; i < std::size(kEvidence); ++i) result[{kEvidence[i].kind, kEvidence[i].word}] = i;
    return result;
  }();
  return index;
}

std::string Describe(WordKind kind, std::string_view word) {
  switch (kind) {
    case WordKind::Directive:
    case WordKind::Ending:
      return std::string(word);
    case WordKind::ParameterType:
      return fmt::format("parameter type \"{}\"", word);
    case WordKind::Camera:
      return fmt::format("camera \"{}\"", word);
    case WordKind::Film:
      return fmt::format("film \"{}\"", word);
    case WordKind::Sampler:
      return fmt::format("sampler \"{}\"", word);
    case WordKind::Integrator:
      return fmt::format("integrator \"{}\"", word);
    case WordKind::Accelerator:
      return fmt::format("accelerator \"{}\"", word);
    case WordKind::PixelFilter:
      return fmt::format("pixel filter \"{}\"", word);
    case WordKind::Material:
      return fmt::format("material \"{}\"", word);
    case WordKind::Texture:
      return fmt::format("texture \"{}\"", word);
    case WordKind::TextureValue:
      return fmt::format("texture of \"{}\"", word);
    case WordKind::Light:
      return fmt::format("light \"{}\"", word);
    case WordKind::Shape:
      return fmt::format("shape \"{}\"", word);
    case WordKind::BoolSpelling:
      return fmt::format("{} true or false", word);
    case WordKind::BlackbodyForm:
      return fmt::format("{} blackbody", word);
    case WordKind::FilterParameter:
      return fmt::format("pixel filter's \"{}\"", word);
    case WordKind::IntegratorParameter:
      return fmt::format("integrator's \"{}\"", word);
    case WordKind::LightParameter:
      return fmt::format("light's \"{}\"", word);
    case WordKind::MaterialParameter:
      return fmt::format("material's \"{}\"", word);
    case WordKind::ShapeParameter:
      return fmt::format("shape's \"{}\"", word);
    case WordKind::TextureParameter:
      return fmt::format("texture's \"{}\"", word);
  }
  return std::string(word);
}

}  // namespace

void PbrtVersionVotes::Saw(WordKind kind, std::string_view word, const FileLocation& location) {
  const auto found = Index().find({kind, word});
  if (found == Index().end()) return;
  if (seen_.empty()) seen_.resize(std::size(kEvidence));
  if (seen_[found->second]) return;
  seen_[found->second] = true;
  const Evidence& evidence = kEvidence[found->second];
  votes_.push_back({evidence.version, evidence.weight, kind, Describe(kind, word), location});
}

void PbrtVersionVotes::SawParameters(WordKind kind, const ParameterList& parameters) {
  for (const Parameter& parameter : parameters.All()) Saw(kind, parameter.name, parameter.location);
}

int PbrtVersionVotes::Version() const {
  int balance = 0;
  for (const Vote& vote : votes_) balance += vote.version == 4 ? vote.weight : -vote.weight;
  return balance < 0 ? 3 : 4;
}

std::vector<PbrtVersionVotes::Vote> PbrtVersionVotes::VotesFor(int version) const {
  std::vector<Vote> votes;
  std::copy_if(votes_.begin(), votes_.end(), std::back_inserter(votes),
               [&](const Vote& vote) { return vote.version == version; });
  std::stable_sort(votes.begin(), votes.end(), [](const Vote& a, const Vote& b) { return a.weight > b.weight; });
  return votes;
}

std::string PbrtVersionVotes::Reason(int version) const {
  constexpr std::size_t kShown = 3;
  const std::vector<Vote> votes = VotesFor(version);
  if (votes.empty()) return "nothing in the file tells the version";
  std::string reason;
  for (std::size_t i = 0; i < std::min(kShown, votes.size()); ++i) {
    const std::string place = votes[i].location.ToString();
    reason += fmt::format("{}{}{}", i > 0 ? ", " : "", votes[i].text, place.empty() ? "" : fmt::format(" ({})", place));
  }
  return reason;
}

void PbrtVersionVotes::WarnOfContradiction(int version, Diagnostics& diagnostics) const {
  const int other = version == 4 ? 3 : 4;
  std::vector<Vote> against = VotesFor(other);
  // Types of parameters are read alike, and habits are no contradiction: both versions' files may have them.
  std::erase_if(against, [](const Vote& vote) { return vote.kind == WordKind::ParameterType; });
  if (against.empty() || against.front().weight < kWorldEnd) return;
  const auto worldEnd =
      std::find_if(against.begin(), against.end(), [](const Vote& vote) { return vote.weight == kWorldEnd; });
  const Vote& shown = worldEnd != against.end() ? *worldEnd : against.front();
  diagnostics.Warn(shown.location,
                   fmt::format("{} is of pbrt-v{}, but the file is read as version {} because of {}; --pbrt-version {} "
                               "reads it as version {}",
                               shown.text, other, version, Reason(version), other, other));
}

}  // namespace dapple
