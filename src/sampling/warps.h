// Warps of the unit square onto disks, spheres, cones and triangles: each as draw, density and inverse.
//
// Random numbers are in [0, 1]^2. Densities are per unit area on disks, per solid angle on spheres. Inverses return the
// random numbers of a point that the warp reaches. Pharr, Jakob and Humphreys 2023, appendix A.5, unless said
// otherwise.
#pragma once

#include "src/base/vec.h"

namespace dapple {

/// The angle of (x, y) from the x axis, counter-clockwise, as a share of the full turn, in [0, 1].
double TurnOf(double x, double y);

/// Uniform on the unit disk by polar coordinates; density 1 / pi.
Vec2d SampleDiskPolar(const Vec2d& u);
Vec2d InvertDiskPolar(const Vec2d& p);

/// Uniform on the unit disk with little distortion (Shirley and Chiu 1997); density 1 / pi.
Vec2d SampleDiskConcentric(const Vec2d& u);
Vec2d InvertDiskConcentric(const Vec2d& p);

inline constexpr double kDiskPdf = 0.318309886183790671538;

/// Uniform on the hemisphere around +z; density 1 / (2 pi).
Vec3d SampleHemisphere(const Vec2d& u);
Vec2d InvertHemisphere(const Vec3d& w);
inline constexpr double kHemispherePdf = 0.159154943091895335769;

/// By the cosine on the hemisphere around +z; density cos theta / pi.
Vec3d SampleCosineHemisphere(const Vec2d& u);
double CosineHemispherePdf(double cosTheta);
Vec2d InvertCosineHemisphere(const Vec3d& w);

/// Uniform on the sphere; density 1 / (4 pi).
Vec3d SampleSphere(const Vec2d& u);
Vec2d InvertSphere(const Vec3d& w);
inline constexpr double kSpherePdf = 0.0795774715459476678844;

/// Uniform in the cone around +z of which `oneMinusCosMax` = 1 - cos thetaMax in (0, 2] is given: narrow cones keep
/// their precision. Density 1 / (2 pi oneMinusCosMax).
Vec3d SampleCone(const Vec2d& u, double oneMinusCosMax);
double ConePdf(double oneMinusCosMax);
Vec2d InvertCone(const Vec3d& w, double oneMinusCosMax);

/// Uniform barycentric coordinates (b1, b2) on a triangle, low distortion (Heitz 2019); density 2 over the unit
/// triangle.
Vec2d SampleTriangle(const Vec2d& u);
Vec2d InvertTriangle(const Vec2d& b);

/// x in [0, 1] of density proportional to a (1 - x) + b x for a, b >= 0, not both zero.
double SampleLinear(double u, double a, double b);
double LinearPdf(double x, double a, double b);
double InvertLinear(double x, double a, double b);

/// A point of the unit square of density proportional to the bilinear function that is w[0], w[1], w[2], w[3] >= 0 at
/// (0,0), (1,0), (0,1), (1,1), not all zero.
Vec2d SampleBilinear(const Vec2d& u, const double (&w)[4]);
double BilinearPdf(const Vec2d& p, const double (&w)[4]);
Vec2d InvertBilinear(const Vec2d& p, const double (&w)[4]);

}  // namespace dapple
