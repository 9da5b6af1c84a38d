#include "src/image/film.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <thread>

#include <gtest/gtest.h>

#include "src/base/hash.h"
#include "src/base/numerics.h"

namespace dapple {
namespace {

constexpr Vec2i kResolution(12, 10);
constexpr PixelBounds kCrop{{2, 3}, {10, 9}};

Film SmallFilm(const Filter& filter = Filter::Box()) { return {kResolution, kCrop, filter}; }

double Uniform(uint64_t i, uint64_t dimension) { return static_cast<double>(Hash(i, dimension) >> 11) * 0x1p-53; }

// Values of many magnitudes and both signs.
Color WildColor(uint64_t i) {
  const auto component = [&](uint64_t c) {
    const double magnitude = std::exp2(80 * Uniform(i, 10 + c) - 42);
    return static_cast<float>(Uniform(i, 20 + c) < 0.5 ? -magnitude : magnitude);
  };
  return {component(0), component(1), component(2)};
}

TEST(FixedPoint, RoundsToTheNearestMultipleOfItsLeastBit) {
  for (const float value :
       {0.f, -0.f, 1.f, -1.f, 0.1f, -0.3f, 0x1p-40f, -0x1.8p-30f, 0x1.fffffep39f, -0x1.fffffep39f, 3.5e-12f})
    EXPECT_EQ(FixedPoint::FromFloat(value).ToDouble(), double{value}) << value;
  EXPECT_EQ(FixedPoint::FromFloat(0x1p-64f).low, 1u);
  EXPECT_EQ(FixedPoint::FromFloat(0x1p-65f).low, 1u);
  EXPECT_EQ(FixedPoint::FromFloat(0x1.7ffffep-64f).low, 1u);
  EXPECT_EQ(FixedPoint::FromFloat(0x1.8p-64f).low, 2u);
  EXPECT_EQ(FixedPoint::FromFloat(0x1.fffffep-66f).low, 0u);
  EXPECT_EQ(FixedPoint::FromFloat(std::numeric_limits<float>::denorm_min()), FixedPoint{});
  EXPECT_EQ(FixedPoint::FromFloat(-0x1p-64f).ToDouble(), -0x1p-64);
  for (uint64_t i = 0; i < 100000; ++i) {
    const float value = WildColor(i).r;
    const double fixed = FixedPoint::FromFloat(value).ToDouble();
    EXPECT_LE(std::abs(fixed - double{value}), 0x1p-65);
    EXPECT_EQ((FixedPoint::FromFloat(value) + FixedPoint::FromFloat(-value)), FixedPoint{});
  }
}

TEST(FixedPoint, Range) {
  EXPECT_TRUE(FixedPoint::IsInRange(0x1.fffffep39f));
  EXPECT_TRUE(FixedPoint::IsInRange(-0x1.fffffep39f));
  for (const float value : {0x1p40f, -0x1p40f, INFINITY, -INFINITY, std::nanf("")})
    EXPECT_FALSE(FixedPoint::IsInRange(value)) << value;
}

// A float or double sum would lose the million small values beside the huge one, which comes and goes.
TEST(Film, TinyValuesSurviveHugeOnes) {
  Film film = SmallFilm();
  film.AddSample({5, 5}, Color(0x1p39f), 0);
  for (int i = 0; i < 1000000; ++i) film.AddSample({5, 5}, Color(0x1p-40f), 0);
  film.AddSample({5, 5}, Color(-0x1p39f), 0);
  film.FinishPass(0);
  EXPECT_EQ(film.ToImage().ColorAt(3, 2), Color(static_cast<float>(1000000 * 0x1p-40)));
}

TEST(Film, AnyOrderAndAnySplitGivesTheSameBits) {
  constexpr uint64_t kSamples = 20000;
  for (const Filter& filter : {Filter::Box(), Filter::Mitchell()}) {
    const auto add = [&](Film& film, uint64_t i) {
      const Vec2i pixel(2 + static_cast<int>(Hash(i, 1) % 8), 3 + static_cast<int>(Hash(i, 2) % 6));
      const int64_t pass = static_cast<int64_t>(Hash(i, 3) % 5);
      const Vec2 position(static_cast<float>(12 * Uniform(i, 4)), static_cast<float>(10 * Uniform(i, 5)));
      film.AddSample(pixel, WildColor(i), pass);
      film.AddSplat(position, WildColor(i + kSamples), pass);
    };
    Film forward = SmallFilm(filter);
    for (uint64_t i = 0; i < kSamples; ++i) add(forward, i);
    for (int pass = 0; pass < 5; ++pass) forward.FinishPass(pass);

    std::vector<uint64_t> order(kSamples);
    std::iota(order.begin(), order.end(), 0);
    std::shuffle(order.begin(), order.end(), std::mt19937(1));
    std::array<Film, 3> parts = {SmallFilm(filter), SmallFilm(filter), SmallFilm(filter)};
    for (const uint64_t i : order) add(parts[Hash(i, 6) % 3], i);
    for (int pass = 0; pass < 5; ++pass) parts[static_cast<size_t>(pass) % 3].FinishPass(pass);
    parts[1].Merge(parts[2]);
    parts[0].Merge(parts[1]);
    EXPECT_TRUE(parts[0] == forward);
    EXPECT_EQ(parts[0].Serialize(), forward.Serialize());
  }
}

TEST(Film, ThreadsThatSplatTogetherGiveTheSameBits) {
  constexpr uint64_t kSplats = 40000;
  constexpr uint64_t kThreads = 4;
  for (const Filter& filter : {Filter::Box(), Filter::Triangle({1.5, 1.5})}) {
    const auto splat = [&](Film& film, uint64_t i) {
      // Few pixels and both signs: threads meet, carries and borrows abound.
      film.AddSplat({static_cast<float>(4 + 2 * Uniform(i, 1)), static_cast<float>(5 + Uniform(i, 2))}, WildColor(i),
                    1);
      if (i % 100 == 0) film.AddSplat({5, 5}, Color(INFINITY), 1);
    };
    Film serial = SmallFilm(filter);
    for (uint64_t i = 0; i < kSplats; ++i) splat(serial, i);
    Film shared = SmallFilm(filter);
    {
      std::vector<std::jthread> threads;
      for (uint64_t t = 0; t < kThreads; ++t)
        threads.emplace_back([&, t] {
          for (uint64_t i = t; i < kSplats; i += kThreads) splat(shared, i);
        });
    }
    EXPECT_TRUE(shared == serial);
    EXPECT_EQ(shared.NonFiniteCount(), static_cast<int64_t>(kSplats / 100));
  }
}

TEST(Film, BadValuesAreCountedAndNeverAdded) {
  Film film = SmallFilm();
  const Film empty = film;
  film.AddSample({3, 4}, Color(1, std::nanf(""), 1), 0);
  film.AddSample({3, 4}, Color(1, 1, -INFINITY), 0);
  film.AddSample({3, 4}, Color(0x1p40f), 1);
  film.AddSplat({3.5f, 4.5f}, Color(std::nanf("")), 0);
  film.AddSplat({std::nanf(""), 4.5f}, Color(1), 0);
  film.AddSplat({INFINITY, 4.5f}, Color(1), 0);
  EXPECT_EQ(film.NonFiniteCount(), 6);
  film.FinishPass(0);
  const Image image = film.ToImage();
  EXPECT_TRUE(std::all_of(image.Values().begin(), image.Values().end(), [](float v) { return v == 0; }));
  EXPECT_FALSE(film == empty);
}

TEST(Film, WhatGaveBadValuesIsKeptAndAddedUp) {
  Film whole = SmallFilm(), first = SmallFilm(), second = SmallFilm();
  for (Film* film : {&whole, &first}) {
    film->CountNonFinite("light 0 (point)", 3);
    film->AddSample({3, 4}, Color(INFINITY), 0);
    film->FinishPass(0);
  }
  for (Film* film : {&whole, &second}) {
    film->CountNonFinite("material \"a b\" (a.pbrt:3:1)", 2);
    film->CountNonFinite("light 0 (point)", 4);
    film->FinishPass(1);
  }
  first.Merge(Film::Deserialize(second.Serialize()));
  EXPECT_EQ(first, whole);
  EXPECT_EQ(Film::Deserialize(whole.Serialize()), whole);
  EXPECT_EQ(first.NonFiniteBySource(),
            (std::map<std::string, int64_t>{{"light 0 (point)", 7}, {"material \"a b\" (a.pbrt:3:1)", 2}}));
  EXPECT_EQ(first.RefusedCount(), 1);
  EXPECT_EQ(first.NonFiniteCount(), 10);
}

TEST(Film, SplatsFarAwayTouchNothing) {
  Film film = SmallFilm(Filter::Gaussian());
  for (const float x : {-1e30f, -100.f, 1e9f, std::numeric_limits<float>::max()}) film.AddSplat({x, 5}, Color(1), 0);
  film.FinishPass(0);
  const Image image = film.ToImage();
  EXPECT_TRUE(std::all_of(image.Values().begin(), image.Values().end(), [](float v) { return v == 0; }));
  EXPECT_EQ(film.NonFiniteCount(), 0);
}

TEST(Film, BoxSplatFallsIntoThePixelThatHoldsIt) {
  for (const Filter& filter : {Filter::Box(), Filter::Box({0.5, 0.5000001})}) {
    // Corners and edges count to the pixel whose lower bounds they are.
    for (const Vec2& position : {Vec2(4, 5.5f), Vec2(4.999f, 5.5f), Vec2(4.5f, 5.25f)}) {
      Film film = SmallFilm(filter);
      film.AddSplat(position, Color(1), 0);
      film.FinishPass(0);
      const Image image = film.ToImage();
      EXPECT_NEAR(image.ColorAt(2, 2).r, 1, 1e-6) << position;
      EXPECT_NEAR(std::accumulate(image.Values().begin(), image.Values().end(), 0.), 3, 1e-5) << position;
    }
  }
}

// Radiance 1 everywhere is density 1 of unit splats per pixel area, over all of SplatBounds: the image must be
// constant, border pixels of the crop included, for each filter. Positions are jittered within fine strata.
TEST(Film, UniformSplatsGiveAConstantImage) {
  for (const Filter& filter : {Filter::Box(), Filter::Box({1.3, 0.7}), Filter::Triangle(), Filter::Gaussian(),
                               Filter::GaussianSigma(), Filter::Mitchell(), Filter::Sinc({2, 3}, 2)}) {
    Film film = SmallFilm(filter);
    const Imath::Box2d bounds = film.SplatBounds();
    const Vec2d size = bounds.size();
    const int columns = static_cast<int>(std::ceil(size.x * 24)), rows = static_cast<int>(std::ceil(size.y * 24));
    const float value = static_cast<float>(size.x * size.y / (columns * rows));
    for (int i = 0; i < columns; ++i) {
      for (int j = 0; j < rows; ++j) {
        const auto id = static_cast<uint64_t>(i * rows + j);
        film.AddSplat({static_cast<float>(bounds.min.x + (i + Uniform(id, 1)) * size.x / columns),
                       static_cast<float>(bounds.min.y + (j + Uniform(id, 2)) * size.y / rows)},
                      Color(value), 0);
      }
    }
    film.FinishPass(0);
    const Image image = film.ToImage();
    for (const float pixel : image.Values()) EXPECT_NEAR(pixel, 1, 0.01) << "radius " << filter.Radius();
  }
}

// A radiance that varies: weighted camera samples and splats have the same expectation in each pixel.
TEST(Film, CameraSamplesAndSplatsAgree) {
  const auto radiance = [](double x, double y) {
    return static_cast<float>(2 + std::sin(1.1 * x) * std::cos(0.8 * y));
  };
  for (const Filter& filter :
       {Filter::Box(), Filter::Triangle(), Filter::GaussianSigma(), Filter::Mitchell(), Filter::Sinc({2, 3}, 2)}) {
    Film film = SmallFilm(filter);
    constexpr int kGrid = 80;
    for (int y = kCrop.min.y; y < kCrop.max.y; ++y) {
      for (int x = kCrop.min.x; x < kCrop.max.x; ++x) {
        for (int i = 0; i < kGrid * kGrid; ++i) {
          const auto id = static_cast<uint64_t>((y * kResolution.x + x) * kGrid * kGrid + i);
          const FilterSample s =
              filter.Sample({(i % kGrid + Uniform(id, 3)) / kGrid, (i / kGrid + Uniform(id, 4)) / kGrid});
          film.AddSample({x, y},
                         Color(radiance(x + 0.5 + s.offset.x, y + 0.5 + s.offset.y) * s.weight / (kGrid * kGrid)), 0);
        }
      }
    }
    const Imath::Box2d bounds = film.SplatBounds();
    const Vec2d size = bounds.size();
    const int columns = static_cast<int>(std::ceil(size.x * 24)), rows = static_cast<int>(std::ceil(size.y * 24));
    for (int i = 0; i < columns; ++i) {
      for (int j = 0; j < rows; ++j) {
        const auto id = static_cast<uint64_t>(i * rows + j);
        const Vec2d p(bounds.min.x + (i + Uniform(id, 1)) * size.x / columns,
                      bounds.min.y + (j + Uniform(id, 2)) * size.y / rows);
        film.AddSplat({static_cast<float>(p.x), static_cast<float>(p.y)},
                      Color(radiance(p.x, p.y) * static_cast<float>(size.x * size.y / (columns * rows))), 1);
      }
    }
    film.FinishPass(0);
    film.FinishPass(1);
    const Image samples = film.HalfImage(0), splats = film.HalfImage(1);
    for (size_t i = 0; i < samples.Values().size(); ++i)
      EXPECT_NEAR(samples.Values()[i], splats.Values()[i], 0.02) << "radius " << filter.Radius();
  }
}

TEST(Film, ImagesAreMeansOfTheirPasses) {
  Film film = SmallFilm();
  EXPECT_EQ(film.ToImage().ColorAt(0, 0), Color(0));
  for (int pass = 0; pass < 5; ++pass) {
    film.AddSample({2, 3}, Color(static_cast<float>(pass)), pass);
    film.FinishPass(pass);
  }
  EXPECT_EQ(film.PassCount(), 5);
  EXPECT_EQ(film.PassCount(0), 3);
  EXPECT_EQ(film.ToImage().ColorAt(0, 0), Color(2));
  EXPECT_EQ(film.HalfImage(0).ColorAt(0, 0), Color(2));
  EXPECT_EQ(film.HalfImage(1).ColorAt(0, 0), Color(2));
  EXPECT_EQ(film.ToImage().origin, kCrop.min);
  EXPECT_EQ(film.ToImage().fullSize, kResolution);
  EXPECT_EQ(film.ToImage().Width(), 8);
}

TEST(Film, StateComesBackFromBytes) {
  Film film = SmallFilm(Filter::Gaussian({2, 1.5}, 1.7));
  for (uint64_t i = 0; i < 100; ++i) film.AddSplat({6, 6}, WildColor(i), static_cast<int64_t>(i));
  film.AddSample({6, 6}, Color(INFINITY), 0);
  for (const int pass : {0, 7, 8, 3}) film.FinishPass(pass);
  const std::vector<std::byte> bytes = film.Serialize();
  Film read = Film::Deserialize(bytes);
  EXPECT_TRUE(read == film);
  EXPECT_EQ(read.Passes().ToString(), "0, 3, 7 to 8");
  read.AddSample({6, 6}, Color(1), 0);
  EXPECT_FALSE(read == film);
}

// A pixel's value of a pass is one sample's or a splat's share: at most the clamp, colours keep their hue.
TEST(Film, AClampBoundsWhatOneSampleOrSplatAdds) {
  Film film = SmallFilm(Filter::Triangle({1, 1}));
  film.ClampTo(2);
  film.AddSample({3, 4}, Color(1, 8, -4), 0);
  film.AddSample({4, 4}, Color(1, 2, -2), 0);
  film.AddSplat({6.5f, 6.5f}, Color(100, 50, 0), 0);
  film.AddSample({3, 4}, Color(INFINITY, 1, 1), 0);
  film.FinishPass(0);
  const Image image = film.ToImage();
  EXPECT_EQ(image.ColorAt(1, 1), Color(0.25f, 2, -1));
  EXPECT_EQ(image.ColorAt(2, 1), Color(1, 2, -2));
  EXPECT_EQ(image.ColorAt(4, 3), Color(2, 1, 0));
  EXPECT_EQ(film.NonFiniteCount(), 1);
}

TEST(Film, ExtraChannelsAreExactMeansThatAreKeptAndMerged) {
  const std::vector<std::string> names{"Z", "N.X"};
  Film whole = SmallFilm(), first = SmallFilm(), second = SmallFilm();
  for (Film* film : {&whole, &first, &second}) film->AddExtraChannels(names);
  const auto add = [](Film& film, int pass) {
    const float z = pass % 2 == 0 ? 0x1p39f : -0x1p39f;
    film.AddExtras({9, 8}, std::vector<float>{z + static_cast<float>(pass) * 0x1p20f, 0x1p-40f});
    film.FinishPass(pass);
  };
  for (const int pass : {0, 1, 2, 3}) add(whole, pass);
  for (const int pass : {2, 1}) add(second, pass);
  for (const int pass : {3, 0}) add(first, pass);
  first.Merge(second);
  EXPECT_EQ(first, whole);
  EXPECT_EQ(Film::Deserialize(whole.Serialize()), whole);
  const Image image = whole.ExtraImage();
  EXPECT_EQ(image.ChannelNames(), names);
  EXPECT_EQ(image.origin, kCrop.min);
  EXPECT_EQ(image.At(7, 5, 0), 1.5f * 0x1p20f);
  EXPECT_EQ(image.At(7, 5, 1), 0x1p-40f);
  EXPECT_EQ(image.At(0, 0, 0), 0);
  whole.AddExtras({9, 8}, std::vector<float>{1, std::nanf("")});
  EXPECT_EQ(whole.NonFiniteCount(), 1);
  EXPECT_EQ(whole.ExtraImage().At(7, 5, 0), 1.5f * 0x1p20f) << "all or nothing of a sample";
  EXPECT_THROW(whole.Merge(SmallFilm()), Error);
}

TEST(Film, BlurIsKeptAndMergedByHalves) {
  Film whole = SmallFilm(), first = SmallFilm(), second = SmallFilm();
  EXPECT_FALSE(whole.TracksBlur());
  for (Film* film : {&whole, &first, &second}) film->TrackBlur();
  const auto add = [](Film& film, int pass) {
    film.AddSample({9, 8}, Color(1), pass);
    film.AddBlur({9, 8}, Color(pass % 2 == 0 ? 1.f : -0.5f * static_cast<float>(pass)), pass);
    film.FinishPass(pass);
  };
  for (const int pass : {0, 1, 2, 3}) add(whole, pass);
  for (const int pass : {2, 1}) add(second, pass);
  for (const int pass : {3, 0}) add(first, pass);
  first.Merge(second);
  EXPECT_EQ(first, whole);
  EXPECT_EQ(Film::Deserialize(whole.Serialize()), whole);
  EXPECT_EQ(whole.BlurImage(0).ColorAt(7, 5), Color(1));
  EXPECT_EQ(whole.BlurImage(1).ColorAt(7, 5), Color(-1));
  EXPECT_EQ(whole.ToImage().ColorAt(7, 5), Color(1)) << "the picture knows nothing of it";
  whole.AddBlur({9, 8}, Color(INFINITY), 0);
  EXPECT_EQ(whole.BlurImage(0).ColorAt(7, 5), Color(1));
  EXPECT_EQ(whole.NonFiniteCount(), 0);
  EXPECT_THROW(whole.Merge(SmallFilm()), Error);
}

TEST(Film, BytesThatAreNoFilmAreErrors) {
  const std::vector<std::byte> bytes = SmallFilm().Serialize();
  for (size_t length = 0; length < bytes.size(); length += 11)
    EXPECT_THROW(Film::Deserialize(std::span(bytes).first(length)), Error) << length;
  std::vector<std::byte> longer = bytes;
  longer.push_back({});
  EXPECT_THROW(Film::Deserialize(longer), Error);
  // Marks, version, kind of filter, sizes, crop, radii: everything of the header but free numbers.
  for (size_t i = 0; i < 56; ++i) {
    std::vector<std::byte> broken = bytes;
    broken[i] ^= std::byte{0xff};
    try {
      EXPECT_FALSE(Film::Deserialize(broken) == SmallFilm()) << i;
    } catch (const Error&) {
    }
  }
}

TEST(Film, BadSizesAndMergesAreErrors) {
  EXPECT_THROW(Film({0, 10}, {{0, 0}, {0, 10}}, Filter::Box()), Error);
  EXPECT_THROW(Film({10, 10}, {{5, 5}, {5, 10}}, Filter::Box()), Error);
  EXPECT_THROW(Film({10, 10}, {{-1, 0}, {10, 10}}, Filter::Box()), Error);
  EXPECT_THROW(Film({10, 10}, {{0, 0}, {11, 10}}, Filter::Box()), Error);
  EXPECT_THROW(Film({1000000, 1000000}, {{0, 0}, {1000000, 1000000}}, Filter::Box()), Error);
  Film film = SmallFilm();
  EXPECT_THROW(film.Merge(SmallFilm(Filter::Triangle())), Error);
  EXPECT_THROW(film.Merge(Film(kResolution, {{0, 0}, kResolution}, Filter::Box())), Error);
  // A pass that is counted twice would weigh twice.
  Film other = SmallFilm();
  film.FinishPass(2);
  other.FinishPass(2);
  EXPECT_THROW(film.Merge(other), Error);
}

}  // namespace
}  // namespace dapple
