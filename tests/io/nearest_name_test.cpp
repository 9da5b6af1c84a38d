#include "src/io/nearest_name.h"

#include <gtest/gtest.h>

namespace dapple {
namespace {

const std::vector<std::string> kNames = {"radius", "roughness", "uroughness", "Kd", "eta", "cropwindow"};

TEST(NearestName, FindsMisspelledNames) {
  EXPECT_EQ(NearestName("raduis", kNames), "radius");          // swapped
  EXPECT_EQ(NearestName("radiu", kNames), "radius");           // missing
  EXPECT_EQ(NearestName("rradius", kNames), "radius");         // doubled
  EXPECT_EQ(NearestName("rodius", kNames), "radius");          // replaced
  EXPECT_EQ(NearestName("CropWindow", kNames), "cropwindow");  // upper and lower case are one
  EXPECT_EQ(NearestName("kd", kNames), "Kd");
}

TEST(NearestName, TakesTheNearerOfTwo) {
  EXPECT_EQ(NearestName("roughnes", kNames), "roughness");
  EXPECT_EQ(NearestName("uroughnes", kNames), "uroughness");
}

TEST(NearestName, NamesNothingWhereNothingIsNear) {
  EXPECT_EQ(NearestName("filename", kNames), "");
  EXPECT_EQ(NearestName("", kNames), "");
  EXPECT_EQ(NearestName("radius", {}), "");
  EXPECT_EQ(NearestName(std::string(100000, 'a'), kNames), "");
  EXPECT_EQ(DidYouMean("raduis", kNames), "; did you mean \"radius\"?");
  EXPECT_EQ(DidYouMean("filename", kNames), "");
}

}  // namespace
}  // namespace dapple
