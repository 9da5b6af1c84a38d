#include "src/io/parameters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "src/io/nearest_name.h"

namespace dapple {

namespace {

struct TypeTraits {
  std::string_view name;
  int components;
};

// In the order of ParameterType.
constexpr std::array<TypeTraits, 14> kTypes = {{{"integer", 1},
                                                {"float", 1},
                                                {"point2", 2},
                                                {"vector2", 2},
                                                {"point3", 3},
                                                {"vector3", 3},
                                                {"normal", 3},
                                                {"rgb", 3},
                                                {"xyz", 3},
                                                {"spectrum", 2},
                                                {"blackbody", 1},
                                                {"string", 0},
                                                {"texture", 0},
                                                {"bool", 0}}};

[[noreturn]] void FailType(const Parameter& parameter, std::string_view expected) {
  throw Error(parameter.location, fmt::format("parameter \"{}\" is \"{}\", expected \"{}\"", parameter.name,
                                              TypeName(parameter.type), expected));
}

void CheckCount(const Parameter& parameter, int count, int expected) {
  if (expected < 0 || count == expected) return;
  throw Error(parameter.location, fmt::format("parameter \"{}\" has {} value{}, expected {}", parameter.name, count,
                                              count == 1 ? "" : "s", expected));
}

/// The numbers of a parameter as vectors. Throws Error where a number is beyond the vector's range.
template <typename Vector>
std::vector<Vector> Vectors(const Parameter& parameter) {
  using Component = typename Vector::BaseType;
  constexpr unsigned kCount = Vector::dimensions();
  std::vector<Vector> result(parameter.numbers.size() / kCount);
  for (std::size_t i = 0; i < result.size(); ++i)
    for (unsigned c = 0; c < kCount; ++c) {
      const double number = parameter.numbers[kCount * i + c];
      if (std::abs(number) > std::numeric_limits<Component>::max())
        throw Error(parameter.location, fmt::format("parameter \"{}\" has the value {}, beyond the range of float",
                                                    parameter.name, number));
      result[i][static_cast<int>(c)] = static_cast<Component>(number);
    }
  return result;
}

Vec3d Triple(const Parameter* parameter, const Vec3d& fallback) {
  return parameter ? Vec3d(parameter->numbers[0], parameter->numbers[1], parameter->numbers[2]) : fallback;
}

}  // namespace

std::string_view TypeName(ParameterType type) { return kTypes[static_cast<std::size_t>(type)].name; }

int ComponentCount(ParameterType type) { return kTypes[static_cast<std::size_t>(type)].components; }

int Parameter::Count() const {
  if (!strings.empty()) return static_cast<int>(strings.size());
  if (!integers.empty()) return static_cast<int>(integers.size());
  return static_cast<int>(numbers.size()) / std::max(1, ComponentCount(type));
}

std::size_t MemoryBytes(const Parameter& parameter) {
  std::size_t bytes = sizeof(Parameter) + parameter.name.size();
  bytes += parameter.numbers.size() * sizeof(double) + parameter.integers.size() * sizeof(int);
  for (const std::string& text : parameter.strings) bytes += sizeof(std::string) + text.size();
  return bytes;
}

void ParameterList::Add(Parameter parameter) {
  const auto sameName = [&](const Parameter& other) { return other.name == parameter.name; };
  const auto found = std::find_if(parameters_.begin(), parameters_.end(), sameName);
  if (found == parameters_.end())
    parameters_.push_back(std::move(parameter));
  else
    *found = std::move(parameter);
}

void ParameterList::AddDefaults(const ParameterList& defaults) {
  const std::size_t ownCount = parameters_.size();
  for (const Parameter& parameter : defaults.parameters_) {
    const auto sameName = [&](const Parameter& other) { return other.name == parameter.name; };
    const auto ownEnd = parameters_.begin() + static_cast<std::ptrdiff_t>(ownCount);
    if (std::any_of(parameters_.begin(), ownEnd, sameName)) continue;
    parameters_.push_back(parameter);
    parameters_.back().isInherited = true;
  }
}

const Parameter* ParameterList::Find(std::string_view name) const {
  if (std::find(askedNames_.begin(), askedNames_.end(), name) == askedNames_.end()) askedNames_.emplace_back(name);
  for (const Parameter& parameter : parameters_) {
    if (parameter.name != name) continue;
    parameter.lookedUp = true;
    return &parameter;
  }
  return nullptr;
}

const Parameter* ParameterList::Find(std::string_view name, ParameterType type) const {
  const Parameter* parameter = Find(name);
  if (parameter && parameter->type != type) FailType(*parameter, TypeName(type));
  return parameter;
}

const Parameter* ParameterList::FindCounted(std::string_view name, ParameterType type, int expectedCount) const {
  const Parameter* parameter = Find(name, type);
  if (parameter) CheckCount(*parameter, parameter->Count(), expectedCount);
  return parameter;
}

double ParameterList::GetFloat(std::string_view name, double fallback) const {
  const Parameter* parameter = FindCounted(name, ParameterType::Float, 1);
  return parameter ? parameter->numbers[0] : fallback;
}

int ParameterList::GetInt(std::string_view name, int fallback) const {
  const Parameter* parameter = FindCounted(name, ParameterType::Integer, 1);
  return parameter ? parameter->integers[0] : fallback;
}

bool ParameterList::GetBool(std::string_view name, bool fallback) const {
  const Parameter* parameter = FindCounted(name, ParameterType::Bool, 1);
  return parameter ? parameter->integers[0] != 0 : fallback;
}

std::string ParameterList::GetString(std::string_view name, const std::string& fallback) const {
  const Parameter* parameter = FindCounted(name, ParameterType::String, 1);
  return parameter ? parameter->strings[0] : fallback;
}

Vec3d ParameterList::GetPoint3(std::string_view name, const Vec3d& fallback) const {
  return Triple(FindCounted(name, ParameterType::Point3, 1), fallback);
}

Vec3d ParameterList::GetVector3(std::string_view name, const Vec3d& fallback) const {
  return Triple(FindCounted(name, ParameterType::Vector3, 1), fallback);
}

std::vector<double> ParameterList::GetFloatArray(std::string_view name, int expectedCount) const {
  const Parameter* parameter = FindCounted(name, ParameterType::Float, expectedCount);
  return parameter ? parameter->numbers : std::vector<double>();
}

std::vector<int> ParameterList::GetIntArray(std::string_view name, int expectedCount) const {
  const Parameter* parameter = FindCounted(name, ParameterType::Integer, expectedCount);
  return parameter ? parameter->integers : std::vector<int>();
}

std::vector<std::string> ParameterList::GetStringArray(std::string_view name, int expectedCount) const {
  const Parameter* parameter = FindCounted(name, ParameterType::String, expectedCount);
  return parameter ? parameter->strings : std::vector<std::string>();
}

std::vector<Vec2> ParameterList::GetPoint2Array(std::string_view name, int expectedCount) const {
  const Parameter* parameter = Find(name);
  if (!parameter) return {};
  if (parameter->type != ParameterType::Point2 && parameter->type != ParameterType::Float)
    FailType(*parameter, TypeName(ParameterType::Point2));
  const std::vector<double>& numbers = parameter->numbers;
  if (numbers.size() % 2 != 0)
    throw Error(parameter->location, fmt::format("parameter \"{}\" has {} numbers, expected a multiple of 2",
                                                 parameter->name, numbers.size()));
  CheckCount(*parameter, static_cast<int>(numbers.size() / 2), expectedCount);
  return Vectors<Vec2>(*parameter);
}

std::vector<Vec3d> ParameterList::GetPoint3Array(std::string_view name, int expectedCount) const {
  const Parameter* parameter = FindCounted(name, ParameterType::Point3, expectedCount);
  return parameter ? Vectors<Vec3d>(*parameter) : std::vector<Vec3d>();
}

std::vector<Vec3> ParameterList::GetVector3Array(std::string_view name, int expectedCount) const {
  const Parameter* parameter = FindCounted(name, ParameterType::Vector3, expectedCount);
  return parameter ? Vectors<Vec3>(*parameter) : std::vector<Vec3>();
}

std::vector<Vec3> ParameterList::GetNormalArray(std::string_view name, int expectedCount) const {
  const Parameter* parameter = FindCounted(name, ParameterType::Normal, expectedCount);
  return parameter ? Vectors<Vec3>(*parameter) : std::vector<Vec3>();
}

FileLocation ParameterList::LocationOf(std::string_view name, const FileLocation& fallback) const {
  for (const Parameter& parameter : parameters_)
    if (parameter.name == name) return parameter.location;
  return fallback;
}

void ParameterList::ReportUnused(Diagnostics& diagnostics, const std::vector<std::string>& otherKnownNames) const {
  std::vector<std::string> known = askedNames_;
  known.insert(known.end(), otherKnownNames.begin(), otherKnownNames.end());
  for (const Parameter& parameter : parameters_) {
    if (parameter.lookedUp || parameter.isInherited) continue;
    if (std::find(otherKnownNames.begin(), otherKnownNames.end(), parameter.name) != otherKnownNames.end()) continue;
    diagnostics.Warn(parameter.location,
                     fmt::format("unknown parameter \"{}\"{}", parameter.name, DidYouMean(parameter.name, known)));
  }
}

void ParameterList::IgnoreAll() const {
  for (const Parameter& parameter : parameters_) parameter.lookedUp = true;
}

}  // namespace dapple
