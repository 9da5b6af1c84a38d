// Tests must be able to fail: each of these faults is rejected by the check that is named for it, the same things
// without fault pass all checks.
#include <iostream>

#include <gtest/gtest.h>

#include "tests/lights/mutants.h"

namespace dapple {
namespace {

std::string Join(const Rejections& names) {
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : ", ") + name;
  return all;
}

class Mutation : public ::testing::TestWithParam<Fault> {};

TEST_P(Mutation, IsRejectedInTheSamplerInTheDensityAndInBoth) {
  const Fault& fault = GetParam();
  EXPECT_EQ(Join(fault.rejections(Place::Nowhere)), "") << "without a fault";
  const char* const places[] = {"sampler", "density", "both"};
  for (const Place place : {Place::Sampler, Place::Density, Place::Both}) {
    const size_t i = static_cast<size_t>(place) - 1;
    const Rejections names = fault.rejections(place);
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
