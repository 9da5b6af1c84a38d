// Tests must be able to fail: each of these faults is rejected by the check that is named for it, the same lights
// without fault pass all checks.
#include <iostream>

#include <gtest/gtest.h>

#include "tests/lights/mutants.h"

namespace dapple {
namespace {

constexpr double kLevel = 1e-6;  // a fault is far below it; some 80 checks of lights without fault are not

/// The names of the checks that reject the light.
std::vector<std::string> Rejections(const TestedLight& tested, double spread) {
  std::vector<std::string> names;
  const auto note = [&](const Verdict& verdict, const char* name) {
    if (!verdict.passes && (names.empty() || names.back() != name)) names.push_back(name);
  };
  for (size_t i = 0; i < 2; ++i) {
    note(CheckDirectionsToLight(tested, TestContexts()[i], kLevel), "chi-square of Sample_Li");
  }
  note(CheckRayOrigins(tested, kLevel), "chi-square of origins");
  note(CheckRayDirections(tested, kLevel), "chi-square of directions");
  note(CheckEnergy(tested), "energy");
  for (const Patch& patch : TestPatches(tested)) note(CheckBothSides(tested, patch), "both sides");
  note(CheckLookup(tested, spread), "lookup");
  return names;
}

std::vector<std::string> RejectionsOf(const Fault& fault, Place place) {
  const Mutant mutant = fault.make(place);
  mutant.light->Prepare(kTestExtent);
  return Rejections(TestedLight(*mutant.light, mutant.shape.get()), fault.spread);
}

std::string Join(const std::vector<std::string>& names) {
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : ", ") + name;
  return all;
}

class Mutation : public ::testing::TestWithParam<Fault> {};

TEST_P(Mutation, IsRejectedInTheSamplerInTheDensityAndInBoth) {
  const Fault& fault = GetParam();
  EXPECT_EQ(Join(RejectionsOf(fault, Place::Nowhere)), "") << "without a fault";
  const char* const places[] = {"sampler", "density", "both"};
  for (const Place place : {Place::Sampler, Place::Density, Place::Both}) {
    const size_t i = static_cast<size_t>(place) - 1;
    const std::vector<std::string> names = RejectionsOf(fault, place);
    std::cout << "| " << fault.name << " | " << places[i] << " | " << Join(names) << " |\n";
    EXPECT_NE(std::find(names.begin(), names.end(), fault.rejectedBy[i]), names.end())
        << fault.name << " in " << places[i] << ": expected " << fault.rejectedBy[i];
  }
}

INSTANTIATE_TEST_SUITE_P(Faults, Mutation, ::testing::ValuesIn(AllFaults()), [](const auto& fault) {
  std::string name = fault.param.name;
  std::replace_if(
      name.begin(), name.end(), [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
  return name;
});

}  // namespace
}  // namespace dapple
