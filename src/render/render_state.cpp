#include "src/render/render_state.h"

#include <filesystem>
#include <fstream>
#include <limits>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "src/base/content_hash.h"
#include "src/image/atomic_file.h"
#include "src/render/json_text.h"

namespace dapple {

namespace {

// The file: a head of two lines, what it is and, as JSON, the origin; the film's bytes; the hash of head and film.
constexpr std::string_view kKind = "dapple render state ";
constexpr std::string_view kFirstLine = "dapple render state 2\n";
constexpr size_t kHashDigits = 32;

std::string OriginToJson(const RenderOrigin& origin) {
  const RenderRecord& record = origin.record;
  nlohmann::ordered_json json = {
      {"scene", record.scene},
      {"integrator", record.integrator},
      {"seed", record.seed},
      {"version", record.version},
      {"instructionSet", record.instructionSet},
      {"exposure", origin.exposure},
      {"aovs", ToString(origin.aovs)},
      {"identity", nlohmann::ordered_json::object()},
  };
  for (const auto& [name, value] : origin.identity.fields) json["identity"][name] = value;
  if (record.seconds) json["seconds"] = *record.seconds;
  if (record.clamp) json["clamp"] = *record.clamp;
  return DumpJson(json);
}

RenderOrigin OriginFromJson(std::string_view text, const FileLocation& location) {
  const auto json = nlohmann::ordered_json::parse(text);
  RenderOrigin origin;
  origin.record.scene = json.at("scene").get<std::string>();
  origin.record.integrator = json.at("integrator").get<std::string>();
  origin.record.seed = json.at("seed").get<int>();
  origin.record.version = json.at("version").get<std::string>();
  origin.record.instructionSet = json.at("instructionSet").get<std::string>();
  origin.exposure = json.at("exposure").get<float>();
  const auto aovs = ParseAovs(json.at("aovs").get<std::string>());
  if (!aovs) throw Error(location, "not the state of a render: unknown layers");
  origin.aovs = *aovs;
  if (json.contains("clamp")) origin.record.clamp = json.at("clamp").get<float>();
  if (json.contains("seconds")) origin.record.seconds = json.at("seconds").get<double>();
  for (const auto& [name, value] : json.at("identity").items())
    origin.identity.fields.emplace_back(name, value.get<std::string>());
  return origin;
}

std::string HashOf(std::string_view head, std::string_view sums) {
  ContentHash hash;
  hash.AddText(head);
  hash.AddText(sums);
  return hash.Hex();
}

std::string ReadBytes(const std::string& path) {
  std::error_code failure;
  if (std::filesystem::is_directory(path, failure))
    throw Error(FileLocation(path), "expected the state of a render; this is a folder");
  if (!std::filesystem::is_regular_file(path, failure)) throw Error(FileLocation(path), "no such file");
  std::string bytes(std::filesystem::file_size(path, failure), '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (failure || !file) throw Error(FileLocation(path), "cannot read the file");
  return bytes;
}

/// The lowest of the film's passes; behind all where it has none.
int64_t FirstPass(const Film& film) {
  return film.Passes().IsEmpty() ? std::numeric_limits<int64_t>::max() : film.Passes().All().front().begin;
}

}  // namespace

bool IsStateName(const std::string& path) { return std::filesystem::path(path).extension() == ".dapple"; }

void WriteState(const std::string& path, const RenderOrigin& origin, const Film& film) {
  const std::vector<std::byte> sums = film.Serialize();
  const std::string head = std::string(kFirstLine) + OriginToJson(origin) + "\n";
  const std::string_view sumBytes(reinterpret_cast<const char*>(sums.data()), sums.size());
  const std::string hash = HashOf(head, sumBytes);
  WriteFileAtomically(path, {head, sumBytes, hash});
}

RenderState ReadState(const std::string& path) {
  const FileLocation location(path);
  const std::string bytes = ReadBytes(path);
  const std::string_view all = bytes;
  if (all.starts_with(kKind) && !all.starts_with(kFirstLine))
    throw Error(location,
                "another version of the program wrote this state of a render, which does not tell whether its passes "
                "are of the same picture: expected one of this version");
  if (!all.starts_with(kFirstLine))
    throw Error(location, "not the state of a render: expected a file that `dapple render` wrote");
  const size_t headEnd = all.find('\n', kFirstLine.size()) + 1;  // 0 where there is no second line
  if (headEnd == 0 || all.size() - headEnd < kHashDigits) throw Error(location, "the file ends early");
  const std::string_view head = all.substr(0, headEnd), hash = all.substr(all.size() - kHashDigits);
  const std::string_view sums = all.substr(headEnd, all.size() - kHashDigits - headEnd);
  if (HashOf(head, sums) != hash) throw Error(location, "the file is damaged: its hash is not that of its content");
  try {
    RenderState state{OriginFromJson(head.substr(kFirstLine.size()), location),
                      Film::Deserialize(std::as_bytes(std::span(sums)), location)};
    if (state.film.ExtraChannels() != FilmChannels(state.origin.aovs))
      throw Error(location,
                  fmt::format("not the state of a render: its sums do not have the channels of its layers, {}",
                              ToString(state.origin.aovs)));
    return state;
  } catch (const nlohmann::json::exception& error) {
    throw Error(location, fmt::format("not the state of a render: {}", error.what()));
  }
}

void JoinState(const RenderState& part, const std::string& path, RenderState* whole) {
  const FileLocation location(path);
  if (const std::string what = Differences(part.origin.identity, whole->origin.identity); !what.empty())
    throw Error(location, fmt::format("it is of another render than those before it: {}", what));
  if (const auto common = part.film.Passes().FirstCommon(whole->film.Passes()))
    throw Error(location, fmt::format("double: {} in it and in those before it", common->ToString()));
  if (FirstPass(part.film) < FirstPass(whole->film)) whole->origin = part.origin;
  whole->film.Merge(part.film);
}

void RequireAllPasses(const Film& film, std::optional<int> passes) {
  const PassRanges& held = film.Passes();
  const int64_t last = held.IsEmpty() ? 0 : held.All().back().end, end = passes.value_or(last);
  PassRanges missing;
  for (auto gap = held.FirstMissing({0, end}); gap; gap = held.FirstMissing({gap->end, end})) missing.Add(*gap);
  if (!missing.IsEmpty())
    throw Error(fmt::format("passes are missing: {}; those given are {}", missing.ToString(), held.ToString()));
  if (last > end)
    throw Error(fmt::format("too many passes: expected 0 to {}; those given are {}", end - 1, held.ToString()));
}

RenderRecord RecordOf(const RenderState& state) {
  RenderRecord record = state.origin.record;
  record.passes = static_cast<int>(state.film.PassCount());
  record.seconds.reset();
  return record;
}

}  // namespace dapple
