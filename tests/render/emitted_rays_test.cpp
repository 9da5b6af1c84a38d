#include "src/render/emitted_rays.h"

#include <cmath>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "src/base/error.h"
#include "src/base/numerics.h"
#include "src/io/ply.h"
#include "src/photons/emission_sampler.h"
#include "tests/support/scene_from_text.h"

namespace dapple {
namespace {

using testing_support::SceneFromText;

// A point (power 4 pi I), a quad lamp of two triangles (pi L A) and a ball (4 pi^2 r^2 L), a million units out.
constexpr const char* kFarScene = R"(LookAt 1000000 2 -6  1000000 0.5 0  0 1 0
Camera "perspective"
WorldBegin
LightSource "point" "rgb I" [1 2 3] "point from" [1000001.25 4 -1]
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [8 6 4]
  Shape "trianglemesh" "point P" [999998 4 0  999999 4 0  999999 4 2  999998 4 2] "integer indices" [0 1 2  0 2 3]
AttributeEnd
AttributeBegin
  Translate 1000000 0 3
  AreaLightSource "diffuse" "rgb L" [2 2 1]
  Shape "sphere" "float radius" 0.5
AttributeEnd
Shape "sphere" "float radius" 0.1
WorldEnd
)";

TEST(EmittedRays, FluxAddsUpToThePower) {
  const auto scene = SceneFromText(kFarScene);
  const EmittedRays emitted = EmitRays(*scene, {.count = 20000, .light = {}, .seed = 3});
  ASSERT_EQ(emitted.rays.size(), 20000u);
  const double truth[3] = {4 * kPiD * 1 + kPiD * 2 * 8 + kPiD * kPiD * 2, 4 * kPiD * 2 + kPiD * 2 * 6 + kPiD * kPiD * 2,
                           4 * kPiD * 3 + kPiD * 2 * 4 + kPiD * kPiD * 1};
  for (int c = 0; c < 3; ++c) {
    double sum = 0, squares = 0;
    for (const EmittedRay& ray : emitted.rays) {
      const double flux = static_cast<double>(ray.flux[c]);
      sum += flux, squares += flux * flux;
    }
    // The standard error of a sum of n values is sqrt(n) times their deviation.
    const double error = std::sqrt(std::max(0.0, squares - sum * sum / 20000));
    EXPECT_NEAR(sum, truth[c], 4 * error + 1e-5 * truth[c]) << c;
    EXPECT_LT(error / truth[c], 0.01) << c;
  }
}

TEST(EmittedRays, AreInTheWorldWithTheirDensities) {
  const auto scene = SceneFromText(kFarScene);
  const Transform toRender = scene->RenderToWorld().Inverse();
  const EmissionSampler emission(*scene);
  int kinds[3] = {0, 0, 0};
  for (const EmittedRay& ray : EmitRays(*scene, {.count = 2000, .light = {}, .seed = 1}).rays) {
    ++kinds[ray.light];
    if (ray.light == 0) {
      EXPECT_EQ(ray.origin, Vec3d(1000001.25, 4, -1));  // float would have steps of 1/16 here
      EXPECT_TRUE(ray.positionIsDiscrete);
      EXPECT_EQ(ray.normal, Vec3(0));
    } else if (ray.light == 1) {
      EXPECT_NEAR(ray.origin.y, 4, 1e-4);
      EXPECT_EQ(std::abs(ray.normal.y), 1);
      EXPECT_GE(Dot(ray.normal, ray.direction), 0);
    } else {
      EXPECT_NEAR(Length(ray.origin - Vec3d(1000000, 0, 3)), 0.5, 1e-5);
    }
    EXPECT_FALSE(ray.directionIsDiscrete);
    // The flux is that of the densities: Le cos / (product of densities) / rays.
    const double cosTheta = ray.light == 0 ? 1 : std::abs(Dot(ToDouble(ray.normal), ToDouble(ray.direction)));
    const double density = ray.pdfLight * ray.pdfPosition * ray.pdfDirection;
    EXPECT_NEAR(static_cast<double>(ray.flux.g) * density * 2000 / (static_cast<double>(ray.radiance.g) * cosTheta), 1,
                1e-5);
    const EmissionPdf pdf =
        emission.Pdf(ray.light, Ray{ToFloat(toRender.Point(ray.origin)), ray.direction}, {ray.normal});
    EXPECT_NEAR(pdf.light / ray.pdfLight, 1, 1e-12);
    EXPECT_NEAR(pdf.position / ray.pdfPosition, 1, 1e-4);
    EXPECT_NEAR(pdf.direction / ray.pdfDirection, 1, 1e-4);
  }
  for (const int count : kinds) EXPECT_GT(count, 100);
}

TEST(EmittedRays, OfOneLightAddUpToItsPower) {
  const auto scene = SceneFromText(kFarScene);
  for (int light = 0; light < 3; ++light) {
    const EmittedRays emitted = EmitRays(*scene, {.count = 1000, .light = light, .seed = 2});
    Color sum;
    for (const EmittedRay& ray : emitted.rays) {
      ASSERT_EQ(ray.light, light);
      ASSERT_EQ(ray.pdfLight, 1);
      sum += ray.flux;
    }
    // Each ray of these lights carries the same flux.
    EXPECT_NEAR(sum.g / scene->Lights()[static_cast<size_t>(light)]->Power().g, 1, 1e-3f);
  }
  EXPECT_THROW(EmitRays(*scene, {.count = 1, .light = 3, .seed = 0}), Error);
  EXPECT_THROW(EmitRays(*scene, {.count = 1, .light = -1, .seed = 0}), Error);
}

TEST(EmittedRays, TheFormatsAgree) {
  const auto scene = SceneFromText(kFarScene);
  const EmittedRays emitted = EmitRays(*scene, {.count = 50, .light = {}, .seed = 1});
  const std::string csv = RaysToCsv(*scene, emitted);
  EXPECT_EQ(std::ranges::count(csv, '\n'), 51);
  const auto json = nlohmann::json::parse(RaysToJson(*scene, emitted));
  EXPECT_EQ(json["rays"], 50);
  EXPECT_EQ(json["lights"].size(), 3u);
  EXPECT_EQ(json["lights"][1]["name"], "area");
  EXPECT_NEAR(static_cast<double>(json["lights"][1]["power"][0]), 16 * kPiD, 1e-4);
  ASSERT_EQ(json["data"].size(), 50u);
  std::string header;
  for (const auto& column : json["columns"]) header += (header.empty() ? "" : ",") + std::string(column);
  EXPECT_EQ(header, csv.substr(0, csv.find('\n')));
  const PlyMesh ply = ParsePly(RaysToPly(*scene, emitted), "rays.ply");
  ASSERT_EQ(ply.positions.size(), 50u);
  for (size_t i = 0; i < 50; ++i) {
    const auto& row = json["data"][i];
    ASSERT_EQ(row.size(), json["columns"].size());
    EXPECT_EQ(ply.positions[i], emitted.rays[i].origin);
    EXPECT_EQ(ply.normals[i], emitted.rays[i].direction);
    EXPECT_EQ(static_cast<double>(row[2]), emitted.rays[i].origin.x);  // all digits
    EXPECT_EQ(static_cast<float>(row[5]), emitted.rays[i].direction.x);
    EXPECT_EQ(static_cast<double>(row[16]), emitted.rays[i].pdfDirection);
  }
}

TEST(EmittedRays, WhatIsBeyondAllFloatsIsNullInJson) {
  const auto scene = SceneFromText(
      "Camera \"perspective\" WorldBegin LightSource \"point\" \"rgb I\" [2e38 1 2e38] Shape \"sphere\" WorldEnd");
  const EmittedRays emitted = EmitRays(*scene, {.count = 3, .light = 0, .seed = 1});
  ASSERT_TRUE(std::isinf(emitted.rays.at(0).flux.r));
  const auto json = nlohmann::json::parse(RaysToJson(*scene, emitted));
  const auto& row = json["data"][0];
  ASSERT_EQ(row.size(), json["columns"].size());
  EXPECT_TRUE(row[19].is_null());
  EXPECT_NEAR(static_cast<double>(row[20]), 4 * kPiD / 3, 1e-5);
  EXPECT_EQ(static_cast<float>(row[11]), 2e38f);
}

}  // namespace
}  // namespace dapple
