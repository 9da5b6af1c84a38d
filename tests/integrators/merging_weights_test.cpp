// The recursive sums of both walks against the densities themselves: for a path of known densities, each technique's
// weight follows from what its own two walks know, and the weights of all techniques sum to one.
#include "integrators/merging_weights.h"

#include <vector>

#include <gtest/gtest.h>

#include "src/base/hash.h"

namespace dapple {
namespace {

/// A vertex of a path x1 ... xm, counted from the camera. Densities are per solid angle.
struct Vertex {
  bool isSpecular;
  double cosToCamera, cosToLight;  // |ng . w|
  double toLight;                  // of the camera's walk going on toward the light
  double toCamera;                 // of the light's walk going on toward the camera
  double eta;                      // of merging here
  double qFactor;                  // by which q becomes less where the camera's walk leaves
};

/// The point of the light: `emission` is the density of the emitted ray over area at xm, over the cosine there and the
/// unit of solid angle at xm; `sampling` the density of light sampling at xm.
struct LightEnd {
  double emission, sampling;
};

double Uniform(uint64_t seed, uint64_t i) { return static_cast<double>(Hash(seed, i) >> 11) * 0x1p-53; }

std::vector<Vertex> RandomPath(uint64_t seed, size_t length) {
  std::vector<Vertex> path;
  for (size_t i = 0; i < length; ++i) {
    const auto u = [&](uint64_t k) { return 0.05 + 3 * Uniform(seed, 16 * i + k); };
    const bool isSpecular = Uniform(seed, 16 * i + 9) < 0.3;
    path.push_back({isSpecular, u(0) / 4, u(1) / 4, u(2), u(3), isSpecular ? 0 : u(4), isSpecular ? 1 : u(5) / 4});
  }
  return path;
}

/// Densities of all techniques, all of them over the density of scattering into the light and without the factors that
/// they share. Index 0: scattering into the light; 1: light sampling; j + 1: merging at x_j (j from 1).
std::vector<double> Densities(const std::vector<Vertex>& path, const LightEnd& light) {
  const size_t m = path.size();
  std::vector<double> densities(m + 1);
  const Vertex& last = path[m - 1];
  const double intoLight = last.isSpecular ? 1 : last.toLight;
  densities[0] = intoLight;
  densities[1] = last.isSpecular ? 0 : light.sampling;
  // Areas: the walk from the light reaches x_i from x_{i+1} with toCamera_{i+1} cosToLight_i / d^2, the camera's walk
  // x_{i+1} from x_i with toLight_i cosToCamera_{i+1} / d^2. Specular densities stand for a delta each: 1 / 1.
  const auto scatter = [&](size_t i, double pdf) { return path[i].isSpecular ? 1 : pdf; };
  for (size_t j = 0; j + 1 < m; ++j) {
    double q = 1;
    for (size_t i = 0; i < j; ++i) q *= path[i].qFactor;
    double ratio = path[j].eta * q * light.emission * last.cosToLight;
    for (size_t i = j + 1; i < m; ++i) ratio *= scatter(i, path[i].toCamera) * path[i - 1].cosToLight;
    for (size_t i = j; i + 1 < m; ++i) ratio /= scatter(i, path[i].toLight) * path[i + 1].cosToCamera;
    densities[j + 2] = ratio;
  }
  return densities;
}

/// The walk from the camera, arrived at x_{k+1} (index k), and q there.
struct CameraWalk {
  MergingWeights weights;
  double q = 1;
};

CameraWalk WalkFromCamera(const std::vector<Vertex>& path, size_t k) {
  CameraWalk walk;
  for (size_t i = 0; i <= k; ++i) {
    walk.weights.Arrive(path[i].cosToCamera);
    if (i == k) break;
    if (path[i].isSpecular) {
      walk.weights.ScatterSpecular(path[i].cosToLight);
    } else {
      walk.weights.Scatter(path[i].eta * walk.q, path[i].toLight, path[i].toCamera, 1, path[i].cosToLight);
    }
    walk.q *= path[i].qFactor;
  }
  return walk;
}

MergingWeights WalkFromLight(const std::vector<Vertex>& path, const LightEnd& light, size_t k) {
  const Vertex& last = path.back();
  MergingWeights weights;
  const double paths = last.isSpecular
                           ? 1 / (light.emission * last.cosToLight)
                           : (light.sampling + last.toLight) / (light.emission * last.cosToLight * last.toCamera);
  weights.Begin(paths, last.cosToCamera);
  for (size_t i = path.size() - 1; i-- > k;) {
    weights.Arrive(path[i].cosToLight);
    if (i == k) break;
    if (path[i].isSpecular) {
      weights.ScatterSpecular(path[i].cosToCamera);
    } else {
      weights.Scatter(path[i].eta, path[i].toCamera, path[i].toLight, path[i].qFactor, path[i].cosToCamera);
    }
  }
  return weights;
}

TEST(MergingWeights, GiveEachTechniqueItsShareOfTheDensities) {
  for (uint64_t seed = 0; seed < 400; ++seed) {
    const size_t m = 1 + seed % 6;
    const std::vector<Vertex> path = RandomPath(seed, m);
    const LightEnd light{0.1 + Uniform(seed, 1001), 0.1 + 2 * Uniform(seed, 1002)};
    const std::vector<double> densities = Densities(path, light);
    double sum = 0;
    for (const double density : densities) sum += density;
    const auto expectShare = [&](size_t technique, double weight) {
      EXPECT_NEAR(weight, densities[technique] / sum, 1e-12) << "seed " << seed << ", technique " << technique;
    };

    // Scattering into the light, and light sampling.
    const Vertex& last = path.back();
    CameraWalk walk = WalkFromCamera(path, m - 1);
    const double merging = light.emission * last.cosToLight * walk.weights.Before().merging;
    if (!last.isSpecular) {
      expectShare(1, light.sampling / (light.sampling + last.toLight + merging * last.toCamera));
      walk.weights.Scatter(0, last.toLight, last.toCamera, 1, last.cosToLight);
      expectShare(0, 1 / (1 + light.sampling / last.toLight + light.emission * walk.weights.Unmerged().merging));
    } else {
      walk.weights.ScatterSpecular(last.cosToLight);
      expectShare(0, 1 / (1 + light.emission * walk.weights.Unmerged().merging));
    }

    for (size_t j = 0; j + 1 < m; ++j) {
      if (path[j].isSpecular) continue;
      const CameraWalk camera = WalkFromCamera(path, j);
      const MergingWeights::Sums before = WalkFromLight(path, light, j).Before();
      const double others = path[j].toLight * (before.paths + camera.q * path[j].qFactor * before.merging) +
                            path[j].toCamera * camera.weights.Before().merging;
      const double eta = path[j].eta * camera.q;
      expectShare(j + 2, eta / (eta + others));
    }
  }
}

}  // namespace
}  // namespace dapple
