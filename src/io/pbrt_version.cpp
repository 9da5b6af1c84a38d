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

// Weights: a word that makes the other version refuse the whole file 10 (WorldEnd: pbrt-v4 stops there, and no v3 file
// renders without it: more than all others), a name that only one version knows 4, a habit of one version's files 1
// to 3.
constexpr Evidence kEvidence[] = {
    {WordKind::Directive, "WorldEnd", 3, 100},
    {WordKind::Directive, "TransformBegin", 3, 1},
    {WordKind::Directive, "Attribute", 4, 10},
    {WordKind::Directive, "Option", 4, 10},
    {WordKind::Directive, "ColorSpace", 4, 10},
    {WordKind::Directive, "Import", 4, 10},
    {WordKind::Ending, "WorldBegin without WorldEnd", 4, 3},

    {WordKind::ParameterType, "point", 3, 4},
    {WordKind::ParameterType, "vector", 3, 4},
    {WordKind::ParameterType, "color", 3, 4},
    {WordKind::ParameterType, "xyz", 3, 2},
    {WordKind::ParameterType, "point2", 4, 1},
    {WordKind::ParameterType, "point3", 4, 1},
    {WordKind::ParameterType, "vector2", 4, 1},
    {WordKind::ParameterType, "vector3", 4, 1},
    {WordKind::BoolSpelling, "quoted", 3, 4},
    {WordKind::BoolSpelling, "bare", 4, 4},
    {WordKind::BlackbodyForm, "scaled", 3, 2},
    {WordKind::BlackbodyForm, "plain", 4, 2},

    {WordKind::Camera, "environment", 3, 4},
    {WordKind::Camera, "spherical", 4, 4},
    {WordKind::Film, "image", 3, 4},
    {WordKind::Film, "rgb", 4, 4},
    {WordKind::Film, "gbuffer", 4, 4},
    {WordKind::Film, "spectral", 4, 4},
    {WordKind::Sampler, "lowdiscrepancy", 3, 4},
    {WordKind::Sampler, "02sequence", 3, 4},
    {WordKind::Sampler, "maxmindist", 3, 4},
    {WordKind::Sampler, "random", 3, 4},
    {WordKind::Sampler, "independent", 4, 4},
    {WordKind::Sampler, "paddedsobol", 4, 4},
    {WordKind::Sampler, "zsobol", 4, 4},
    {WordKind::Sampler, "pmj02bn", 4, 4},
    {WordKind::Integrator, "directlighting", 3, 4},
    {WordKind::Integrator, "whitted", 3, 4},
    {WordKind::Integrator, "ao", 3, 4},
    {WordKind::Integrator, "ambientocclusion", 4, 4},
    {WordKind::Integrator, "simplepath", 4, 4},
    {WordKind::Integrator, "simplevolpath", 4, 4},
    {WordKind::Integrator, "lightpath", 4, 4},
    {WordKind::Integrator, "randomwalk", 4, 4},
    {WordKind::Integrator, "function", 4, 4},
    {WordKind::IntegratorParameter, "numiterations", 3, 2},
    {WordKind::FilterParameter, "xwidth", 3, 4},
    {WordKind::FilterParameter, "ywidth", 3, 4},
    {WordKind::FilterParameter, "xradius", 4, 4},
    {WordKind::FilterParameter, "yradius", 4, 4},

    {WordKind::Material, "matte", 3, 4},
    {WordKind::Material, "glass", 3, 4},
    {WordKind::Material, "metal", 3, 4},
    {WordKind::Material, "mirror", 3, 4},
    {WordKind::Material, "plastic", 3, 4},
    {WordKind::Material, "substrate", 3, 4},
    {WordKind::Material, "uber", 3, 4},
    {WordKind::Material, "translucent", 3, 4},
    {WordKind::Material, "disney", 3, 4},
    {WordKind::Material, "fourier", 3, 4},
    {WordKind::Material, "kdsubsurface", 3, 4},
    {WordKind::Material, "diffuse", 4, 4},
    {WordKind::Material, "coateddiffuse", 4, 4},
    {WordKind::Material, "coatedconductor", 4, 4},
    {WordKind::Material, "conductor", 4, 4},
    {WordKind::Material, "dielectric", 4, 4},
    {WordKind::Material, "thindielectric", 4, 4},
    {WordKind::Material, "diffusetransmission", 4, 4},
    {WordKind::Material, "measured", 4, 4},
    {WordKind::Material, "interface", 4, 4},
    {WordKind::MaterialParameter, "namedmaterial1", 3, 4},
    {WordKind::MaterialParameter, "namedmaterial2", 3, 4},
    {WordKind::MaterialParameter, "bumpmap", 3, 4},
    {WordKind::MaterialParameter, "materials", 4, 4},
    {WordKind::MaterialParameter, "displacement", 4, 4},
    {WordKind::MaterialParameter, "normalmap", 4, 4},

    {WordKind::TextureValue, "color", 3, 4},
    {WordKind::TextureValue, "spectrum", 4, 1},
    {WordKind::Texture, "uv", 3, 4},
    {WordKind::Texture, "directionmix", 4, 4},
    {WordKind::Texture, "ptex", 4, 1},
    {WordKind::TextureParameter, "trilinear", 3, 4},
    {WordKind::TextureParameter, "gamma", 3, 4},
    {WordKind::TextureParameter, "encoding", 4, 4},
    {WordKind::TextureParameter, "filter", 4, 4},
    {WordKind::TextureParameter, "invert", 4, 4},

    {WordKind::Light, "exinfinite", 3, 4},
    {WordKind::LightParameter, "mapname", 3, 4},
    {WordKind::LightParameter, "nsamples", 3, 4},
    {WordKind::LightParameter, "samples", 3, 4},
    {WordKind::LightParameter, "filename", 4, 4},
    {WordKind::LightParameter, "power", 4, 4},
    {WordKind::LightParameter, "illuminance", 4, 4},
    {WordKind::LightParameter, "portal", 4, 4},

    {WordKind::Shape, "cone", 3, 4},
    {WordKind::Shape, "hyperboloid", 3, 4},
    {WordKind::Shape, "paraboloid", 3, 4},
    {WordKind::Shape, "heightfield", 3, 4},
    {WordKind::Shape, "nurbs", 3, 4},
    {WordKind::Shape, "bilinearmesh", 4, 4},
    {WordKind::ShapeParameter, "nlevels", 3, 4},
    {WordKind::ShapeParameter, "shadowalpha", 3, 4},
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
  const std::string place = location.ToString();
  votes_.push_back({evidence.version, evidence.weight,
                    fmt::format("{}{}", Describe(kind, word), place.empty() ? "" : fmt::format(" ({})", place))});
}

void PbrtVersionVotes::SawParameters(WordKind kind, const ParameterList& parameters) {
  for (const Parameter& parameter : parameters.All()) Saw(kind, parameter.name, parameter.location);
}

int PbrtVersionVotes::Version() const {
  int balance = 0;
  for (const Vote& vote : votes_) balance += vote.version == 4 ? vote.weight : -vote.weight;
  return balance < 0 ? 3 : 4;
}

std::string PbrtVersionVotes::Reason(int version) const {
  constexpr std::size_t kShown = 3;
  std::vector<Vote> votes;
  std::copy_if(votes_.begin(), votes_.end(), std::back_inserter(votes),
               [&](const Vote& vote) { return vote.version == version; });
  std::stable_sort(votes.begin(), votes.end(), [](const Vote& a, const Vote& b) { return a.weight > b.weight; });
  if (votes.empty()) return "nothing in the file tells the version";
  std::string reason;
  for (std::size_t i = 0; i < std::min(kShown, votes.size()); ++i) reason += (i > 0 ? ", " : "") + votes[i].text;
  return reason;
}

}  // namespace dapple
