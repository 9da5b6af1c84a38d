#include "src/materials/procedural_textures.h"

#include <array>
#include <cstdint>

namespace dapple {
namespace {

// Perlin's permutation of 0..255 (Perlin 2002, "Improving noise").
constexpr std::array<uint8_t, 256> kPermutation = {
    151, 160, 137, 91,  90,  15,  131, 13,  201, 95,  96,  53,  194, 233, 7,   225, 140, 36,  103, 30,  69,  142,
    8,   99,  37,  240, 21,  10,  23,  190, 6,   148, 247, 120, 234, 75,  0,   26,  197, 62,  94,  252, 219, 203,
    117, 35,  11,  32,  57,  177, 33,  88,  237, 149, 56,  87,  174, 20,  125, 136, 171, 168, 68,  175, 74,  165,
    71,  134, 139, 48,  27,  166, 77,  146, 158, 231, 83,  111, 229, 122, 60,  211, 133, 230, 220, 105, 92,  41,
    55,  46,  245, 40,  244, 102, 143, 54,  65,  25,  63,  161, 1,   216, 80,  73,  209, 76,  132, 187, 208, 89,
    18,  169, 200, 196, 135, 130, 116, 188, 159, 86,  164, 100, 109, 198, 173, 186, 3,   64,  52,  217, 226, 250,
    124, 123, 5,   202, 38,  147, 118, 126, 255, 82,  85,  212, 207, 206, 59,  227, 47,  16,  58,  17,  182, 189,
    28,  42,  223, 183, 170, 213, 119, 248, 152, 2,   44,  154, 163, 70,  221, 153, 101, 155, 167, 43,  172, 9,
    129, 22,  39,  253, 19,  98,  108, 110, 79,  113, 224, 232, 178, 185, 112, 104, 218, 246, 97,  228, 251, 34,
    242, 193, 238, 210, 144, 12,  191, 179, 162, 241, 81,  51,  145, 235, 249, 14,  239, 107, 49,  192, 214, 31,
    181, 199, 106, 157, 184, 84,  204, 176, 115, 121, 50,  45,  127, 4,   150, 254, 138, 236, 205, 93,  222, 114,
    67,  29,  24,  72,  243, 141, 128, 195, 78,  66,  215, 61,  156, 180};

int Permute(int i) { return kPermutation[static_cast<size_t>(i & 255)]; }

/// The product of the gradient at a lattice point with the offset d from it (pbrt-v3, section 10.6.1).
float GradientProduct(int x, int y, int z, const Vec3& d) {
  const int h = Permute(Permute(Permute(x) + y) + z) & 15;
  const float u = h < 8 || h == 12 || h == 13 ? d.x : d.y;
  const float v = h < 4 || h == 12 || h == 13 ? d.y : d.z;
  return ((h & 1) ? -u : u) + ((h & 2) ? -v : v);
}

float Smooth(float t) { return t * t * t * (t * (6 * t - 15) + 10); }

}  // namespace

float Noise(const Vec3& p) {
  constexpr float kLimit = 0x1p23f;
  if (!(MaxAbsComponent(p) < kLimit) || !IsFinite(p)) return 0;
  const int x = static_cast<int>(std::floor(p.x)), y = static_cast<int>(std::floor(p.y));
  const int z = static_cast<int>(std::floor(p.z));
  const Vec3 d(p.x - static_cast<float>(x), p.y - static_cast<float>(y), p.z - static_cast<float>(z));
  const auto corner = [&](int i, int j, int k) {
    return GradientProduct(x + i, y + j, z + k,
                           d - Vec3(static_cast<float>(i), static_cast<float>(j), static_cast<float>(k)));
  };
  const float wx = Smooth(d.x), wy = Smooth(d.y), wz = Smooth(d.z);
  const float low =
      std::lerp(std::lerp(corner(0, 0, 0), corner(1, 0, 0), wx), std::lerp(corner(0, 1, 0), corner(1, 1, 0), wx), wy);
  const float high =
      std::lerp(std::lerp(corner(0, 0, 1), corner(1, 0, 1), wx), std::lerp(corner(0, 1, 1), corner(1, 1, 1), wx), wy);
  return std::lerp(low, high, wz);
}

bool IsInsideDot(const Vec2& st) {
  constexpr float kRadius = 0.35f, kMaxShift = 0.5f - kRadius;
  const auto noise = [](float s, float t) { return Noise({s, t, 0.5f}); };
  const float s = std::floor(st.x + 0.5f), t = std::floor(st.y + 0.5f);
  if (!(noise(s + 0.5f, t + 0.5f) > 0)) return false;
  const float centerS = s + kMaxShift * noise(s + 1.5f, t + 2.8f), centerT = t + kMaxShift * noise(s + 4.5f, t + 9.8f);
  return Sqr(st.x - centerS) + Sqr(st.y - centerT) < kRadius * kRadius;
}

}  // namespace dapple
