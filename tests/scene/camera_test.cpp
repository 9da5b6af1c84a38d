// Facts of cameras, for each kind of camera and under rigid, mirrored and stretching transforms.
#include <functional>
#include <memory>

#include <gtest/gtest.h>

#include "src/scene/orthographic_camera.h"
#include "src/scene/perspective_camera.h"
#include "src/scene/spherical_camera.h"

namespace dapple {
namespace {

constexpr Vec2i kResolution(40, 30);
constexpr double kPixels = 40 * 30;

/// Evenly spread points of the unit cube: multiples of the inverse powers of the root of x^6 = x + 1.
struct Even5D {
  double x[5] = {0.5, 0.5, 0.5, 0.5, 0.5};
  void Next() {
    constexpr double kRoot = 1.1347241384015194;
    double step = 1;
    for (double& value : x) {
      step /= kRoot;
      value += step;
      value -= std::floor(value);
    }
  }
};

struct CameraCase {
  std::string name;
  Transform cameraToRender;
  std::function<std::unique_ptr<Camera>(const Transform&)> make;
  bool hasLensPlane = true;  // a cosine counts at the lens
};

std::vector<CameraCase> Cases() {
  const Transform lookAt = Transform::CameraToWorldLookAt({1, 2, 3}, {2, 2.5, 5}, {0.1, 1, 0});
  const Transform mirrored = lookAt * Transform::Scale({-1, 1, 1});
  const Transform stretched = lookAt * Transform::Scale({1.5, 0.7, 0.8}) * Transform::Rotate(20, {1, 1, 0});
  const ScreenWindow window = ScreenWindow::FromAspect(4. / 3);
  const ScreenWindow shifted{-0.7, 1.2, -0.9, 0.4};
  const auto pinhole = [=](const Transform& t) {
    return std::make_unique<PerspectiveCamera>(t, kResolution, window, 50);
  };
  const auto lens = [=](const Transform& t) {
    return std::make_unique<PerspectiveCamera>(t, kResolution, shifted, 60, ThinLens{0.2, 1.7});
  };
  const auto parallel = [=](const Transform& t) {
    return std::make_unique<OrthographicCamera>(t, kResolution, window);
  };
  const auto telecentric = [=](const Transform& t) {
    return std::make_unique<OrthographicCamera>(t, kResolution, shifted, ThinLens{0.3, 2.5});
  };
  const auto latLong = [=](const Transform& t) {
    return std::make_unique<SphericalCamera>(t, kResolution, SphericalProjection::Equirectangular);
  };
  const auto equalArea = [=](const Transform& t) {
    return std::make_unique<SphericalCamera>(t, kResolution, SphericalProjection::EqualArea);
  };
  std::vector<CameraCase> cases;
  for (const auto& [suffix, transform] :
       {std::pair{"Rigid", lookAt}, std::pair{"Mirrored", mirrored}, std::pair{"Stretched", stretched}}) {
    const std::string prefix = suffix;
    cases.push_back({prefix + "Pinhole", transform, pinhole});
    cases.push_back({prefix + "Lens", transform, lens});
    cases.push_back({prefix + "Orthographic", transform, parallel});
    cases.push_back({prefix + "Telecentric", transform, telecentric});
    cases.push_back({prefix + "LatLong", transform, latLong, false});
    cases.push_back({prefix + "EqualArea", transform, equalArea, false});
  }
  return cases;
}

class CameraFacts : public ::testing::TestWithParam<CameraCase> {
 protected:
  CameraFacts() : camera_(GetParam().make(GetParam().cameraToRender)) {}

  /// The unit normal of the plane of camera-space x and y, into the scene.
  Vec3d LensNormal() const {
    const Transform& t = GetParam().cameraToRender;
    const Vec3d n = Normalize(Cross(t.Vector({1, 0, 0}), t.Vector({0, 1, 0})));
    return Dot(n, t.Vector({0, 0, 1})) < 0 ? -n : n;
  }

  std::unique_ptr<Camera> camera_;
};

TEST_P(CameraFacts, FilmPositionsComeBackFromRays) {
  Even5D u;
  for (int i = 0; i < 500; ++i, u.Next()) {
    const Vec2 film(static_cast<float>(u.x[0] * kResolution.x), static_cast<float>(u.x[1] * kResolution.y));
    const Vec2d uLens(u.x[2], u.x[3]);
    const Ray ray = camera_->GenerateRay(film, uLens, u.x[4]).ray;
    EXPECT_NEAR(Length(ray.d), 1, 1e-6);
    EXPECT_FLOAT_EQ(ray.state.time, static_cast<float>(u.x[4]));
    Vec2 found;
    const float We = camera_->We(ray, &found);
    // Pixels: the ray is rounded to float. Near the poles of latitude and longitude a pixel is narrow.
    const double poleWidth = GetParam().hasLensPlane ? 1 : std::sin(kPiD * u.x[1]);
    const double tolerance = 2e-3 / std::max(poleWidth, 0.01);
    EXPECT_GT(We, 0);
    EXPECT_NEAR(found.x, film.x, tolerance);
    EXPECT_NEAR(found.y, film.y, tolerance);

    // The point that the ray passes is joined to the same lens point, film position and direction.
    const std::optional<WiSample> sample = camera_->Sample_Wi(ray(2), uLens);
    ASSERT_TRUE(sample);
    EXPECT_NEAR(sample->film.x, film.x, tolerance);
    EXPECT_NEAR(sample->film.y, film.y, tolerance);
    EXPECT_LT(Length(sample->wi + ray.d), 1e-5);
    EXPECT_LT(Length(sample->lens - ray.o), 1e-5);
  }
}

TEST_P(CameraFacts, ImportanceIntegratesToOneForEachPixel) {
  // The integral of We over a pixel's rays is one, so We cos / pdf is the number of pixels, for each ray.
  Even5D u;
  for (int i = 0; i < 200; ++i, u.Next()) {
    const Vec2 film(static_cast<float>(u.x[0] * kResolution.x), static_cast<float>(u.x[1] * kResolution.y));
    const Ray ray = camera_->GenerateRay(film, {u.x[2], u.x[3]}, 0).ray;
    Vec2 found;
    const double We = camera_->We(ray, &found);
    const WePdf pdf = camera_->Pdf_We(ray);
    const double cosine = GetParam().hasLensPlane ? Dot(LensNormal(), ToDouble(ray.d)) : 1;
    // Where the direction is discrete, position is per area of the film plane, and We per area across the ray.
    EXPECT_NEAR(We * cosine / (pdf.position * pdf.direction), kPixels, 1e-3 * kPixels);
  }
}

TEST_P(CameraFacts, NothingIsSeenOutsideTheImage) {
  if (!GetParam().hasLensPlane) return;  // sees everything
  for (const Vec2& film : {Vec2(-0.1f, 3), Vec2(3, -0.1f), Vec2(40.1f, 3), Vec2(3, 30.1f)}) {
    const Ray ray = camera_->GenerateRay(film, {0.3, 0.6}, 0).ray;
    Vec2 found;
    EXPECT_EQ(camera_->We(ray, &found), 0);
    EXPECT_EQ(camera_->Pdf_We(ray).position * camera_->Pdf_We(ray).direction, 0);
    EXPECT_TRUE(camera_->Sample_Wi(ray(1), {0.3, 0.6})) << "splats outside the image reach it through the filter";
  }
  const Vec3 behind = camera_->Position() - ToFloat(LensNormal());
  EXPECT_FALSE(camera_->Sample_Wi(behind, {0.5, 0.5}));
}

/// A parallelogram that glows with radiance 1 on both sides.
struct Patch {
  Vec3d corner, a, b;
  double Area() const { return Length(Cross(a, b)); }
  Vec3d Normal() const { return Normalize(Cross(a, b)); }

  bool IsHit(const Ray& ray) const {
    const Vec3d o = ToDouble(ray.o), d = ToDouble(ray.d), n = Normal();
    const double t = Dot(corner - o, n) / Dot(d, n);
    if (!(t > 0)) return false;
    const Vec3d p = o + d * t - corner;
    const double u = Dot(Cross(p, b), n) / Area(), v = Dot(Cross(a, p), n) / Area();
    return u >= 0 && u < 1 && v >= 0 && v < 1;
  }
};

TEST_P(CameraFacts, BothSidesMeasureTheSameImage) {
  const Transform& t = GetParam().cameraToRender;
  const Vec3d corner = t.Point({-0.5, -0.35, 1.6});
  const Patch patch{corner, t.Point({0.45, -0.3, 2.3}) - corner, t.Point({-0.4, 0.5, 1.9}) - corner};
  constexpr int kSamples = 200'000;
  double fromCamera = 0, fromPatch = 0;
  Even5D u;
  for (int i = 0; i < kSamples; ++i, u.Next()) {
    const Vec2 film(static_cast<float>(u.x[0] * kResolution.x), static_cast<float>(u.x[1] * kResolution.y));
    const Vec2d uLens(u.x[2], u.x[3]);
    if (patch.IsHit(camera_->GenerateRay(film, uLens, 0).ray)) fromCamera += kPixels;
    const Vec3d p = patch.corner + patch.a * u.x[0] + patch.b * u.x[1];
    const std::optional<WiSample> sample = camera_->Sample_Wi(ToFloat(p), uLens);
    if (!sample || sample->film.x < 0 || sample->film.x > 40 || sample->film.y < 0 || sample->film.y > 30) continue;
    const double cosine = std::abs(Dot(patch.Normal(), ToDouble(sample->wi)));
    fromPatch += patch.Area() * cosine * static_cast<double>(sample->We) / sample->pdf;
  }
  EXPECT_GT(fromCamera, 0);
  // The points are far more even than random ones, of which the error would be about 1 %.
  EXPECT_NEAR(fromPatch / fromCamera, 1, 0.005);
}

TEST_P(CameraFacts, FootprintIsTheDistanceBetweenNeighbouringPixels) {
  const CameraRay center = camera_->GenerateRay({20, 15}, {0.5, 0.5}, 0);
  const Vec3 right = camera_->GenerateRay({21, 15}, {0.5, 0.5}, 0).ray(2);
  const Vec3 below = camera_->GenerateRay({20, 16}, {0.5, 0.5}, 0).ray(2);
  const Vec3 p = center.ray(2);
  const double area = Length(Cross(right - p, below - p));
  const double footprint = center.footprintAtLens + 2 * center.footprintSpread;
  // Of the right size; skewed pixels and lenses out of focus keep it from being exact.
  EXPECT_NEAR(footprint / std::sqrt(area), 1, 0.35);
}

INSTANTIATE_TEST_SUITE_P(All, CameraFacts, ::testing::ValuesIn(Cases()),
                         [](const auto& testCase) { return testCase.param.name; });

Transform AlongZ() { return Transform::CameraToWorldLookAt(Vec3d(0), {0, 0, 1}, {0, 1, 0}); }

TEST(PerspectiveCamera, ImageIsUprightAndNotMirrored) {
  const PerspectiveCamera camera(AlongZ(), {200, 100}, ScreenWindow::FromAspect(2), 90);
  const auto at = [&](float x, float y) { return camera.GenerateRay({x, y}, {0.5, 0.5}, 0).ray.d; };
  EXPECT_LT(Length(at(100, 50) - Vec3(0, 0, 1)), 1e-6);
  // 90 degrees over the shorter side: its edges are at 45 degrees.
  EXPECT_LT(Length(at(100, 0) - Normalize(Vec3(0, 1, 1))), 1e-6);
  EXPECT_LT(Length(at(200, 50) - Normalize(Vec3(2, 0, 1))), 1e-6);
}

TEST(PerspectiveCamera, TallImagesHaveTheirFieldOfViewAcross) {
  const PerspectiveCamera camera(AlongZ(), {100, 200}, ScreenWindow::FromAspect(0.5), 90);
  EXPECT_LT(Length(camera.GenerateRay({0, 100}, {0.5, 0.5}, 0).ray.d - Normalize(Vec3(-1, 0, 1))), 1e-6);
}

TEST(PerspectiveCamera, RaysOfAPixelMeetInTheFocalPlane) {
  const PerspectiveCamera camera(AlongZ(), {100, 100}, ScreenWindow(), 60, {0.25, 4});
  const Vec2 film(30, 70);
  const auto atDepth = [&](double z, const Vec2d& uLens) {
    const Ray ray = camera.GenerateRay(film, uLens, 0).ray;
    return ToDouble(ray.o) + ToDouble(ray.d) * ((z - ray.o.z) / ray.d.z);
  };
  const Vec3d center = atDepth(4, {0.5, 0.5});
  double largest = 0;
  for (int i = 0; i < 64; ++i) {
    const Vec2d uLens((i % 8 + 0.5) / 8, (i / 8 + 0.5) / 8);
    EXPECT_LT(Distance(atDepth(4, uLens), center), 1e-5);
    largest = std::max(largest, Distance(atDepth(8, uLens), atDepth(8, {0.5, 0.5})));
  }
  // At twice the distance the blur is as wide as the lens.
  EXPECT_GT(largest, 0.2);
  EXPECT_LT(largest, 0.25);
}

TEST(PerspectiveCamera, DirectionDensityIntegratesToOne) {
  const PerspectiveCamera camera(AlongZ(), {64, 48}, ScreenWindow::FromAspect(4. / 3), 70);
  constexpr int kSamples = 100'000;
  double sum = 0;
  Even5D u;
  for (int i = 0; i < kSamples; ++i, u.Next()) {
    const double z = u.x[0], phi = 2 * kPiD * u.x[1], r = std::sqrt(1 - z * z);
    const Ray ray{Vec3(0), ToFloat({r * std::cos(phi), r * std::sin(phi), z}), kInfinity, {}};
    sum += camera.Pdf_We(ray).direction * 2 * kPiD;
  }
  EXPECT_NEAR(sum / kSamples, 1, 0.005);
}

TEST(PerspectiveCamera, BadNumbersAreErrorsWithAPlace) {
  const FileLocation place(std::make_shared<const std::string>("a.pbrt"), 3, 1);
  const auto message = [&](double fov, const ThinLens& lens, const Transform& transform) -> std::string {
    try {
      PerspectiveCamera(transform, {10, 10}, ScreenWindow(), fov, lens, place);
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_EQ(message(60, {}, AlongZ()), "no error");
  for (const std::string& line : {message(0, {}, AlongZ()), message(180, {}, AlongZ()), message(60, {-1, 1}, AlongZ()),
                                  message(60, {1, 0}, AlongZ()), message(60, {}, Transform::Scale({1, 0, 1}))})
    EXPECT_EQ(line.substr(0, 17), "a.pbrt:3:1: error") << line;
}

TEST(SphericalCamera, LooksAroundAsPbrtDoes) {
  const SphericalCamera camera(AlongZ(), {400, 200}, SphericalProjection::Equirectangular);
  const auto at = [&](float x, float y) { return camera.GenerateRay({x, y}, {0.5, 0.5}, 0).ray.d; };
  EXPECT_LT(Length(at(100, 100) - Vec3(0, 0, 1)), 1e-6);
  EXPECT_LT(Length(at(200, 100) - Vec3(-1, 0, 0)), 1e-6);
  EXPECT_LT(Length(at(200, 0) - Vec3(0, 1, 0)), 1e-6);
  EXPECT_FALSE(camera.Sample_Wi(camera.Position(), {0.5, 0.5}));
}

TEST(SphericalCamera, EqualAreaFilmGoesOnBeyondItsEdges) {
  const SphericalCamera camera(AlongZ(), {100, 100}, SphericalProjection::EqualArea);
  const auto at = [&](float x, float y) { return camera.GenerateRay({x, y}, {0.5, 0.5}, 0).ray.d; };
  // Just outside is near just inside.
  EXPECT_LT(Length(at(-0.01f, 30) - at(0.01f, 70)), 1e-2);
  EXPECT_LT(Length(at(30, 100.01f) - at(70, 99.99f)), 1e-2);
}

TEST(SphericalCamera, RepeatsOfAFilmPositionLookTheSameWay) {
  constexpr float kSide = 100;
  for (const SphericalProjection mapping : {SphericalProjection::Equirectangular, SphericalProjection::EqualArea}) {
    const SphericalCamera camera(AlongZ(), Vec2i(100, 100), mapping);
    const auto along = [&](const Vec2& film) { return camera.GenerateRay(film, {0.5, 0.5}, 0).ray.d; };
    for (const float x : {0.4f, 1.3f, 30.f, 99.1f})
      for (const float y : {0.7f, 1.9f, 60.f, 99.5f}) {
        std::vector<Vec2> places = {Vec2(x, y)};
        std::array<Vec2, Camera::kMostRepeats> repeats;
        const int count = camera.FilmRepeats(places[0], &repeats);
        ASSERT_GT(count, 0);
        for (int i = 0; i < count; ++i) {
          const Vec2& repeat = repeats[static_cast<size_t>(i)];
          EXPECT_TRUE(repeat.x < 0 || repeat.x > kSide || repeat.y < 0 || repeat.y > kSide)
              << repeat.x << " " << repeat.y;
          for (const Vec2& other : places) EXPECT_NE(repeat, other);
          places.push_back(repeat);
          // Farther away no filter reaches.
          if (std::min(repeat.x, repeat.y) < -50 || std::max(repeat.x, repeat.y) > kSide + 50) continue;
          EXPECT_LT(Length(along(repeat) - along(places[0])), 1e-5f) << "(" << x << ", " << y << "), repeat " << i;
        }
      }
  }
}

TEST(OrthographicCamera, ShowsItsScreenWindowInSceneUnits) {
  const OrthographicCamera camera(AlongZ(), {100, 50}, ScreenWindow{-4, 4, -2, 2});
  const Ray corner = camera.GenerateRay({0, 0}, {0.5, 0.5}, 0).ray;
  EXPECT_LT(Length(corner.o - Vec3(-4, 2, 0)), 1e-6);
  EXPECT_LT(Length(corner.d - Vec3(0, 0, 1)), 1e-6);
}

}  // namespace
}  // namespace dapple
