// What must be true of every light, as checks that give a verdict.
#pragma once

#include "lights/emission_disk.h"
#include "src/base/frame.h"
#include "tests/lights/light_cases.h"
#include "tests/support/verdict.h"

namespace dapple {

/// A light under test, prepared for `kTestExtent`, and the shape that it shines from (null: none).
struct TestedLight {
  TestedLight(const LightCase& c) : light(*c.light), shape(c.shape.get()) {}
  TestedLight(const Light& l, const Shape* s) : light(l), shape(s) {}

  const Light& light;
  const Shape* shape;
};

/// The disk from which light of infinitely far away arrives from the unit direction `w` in the extent of all cases.
EmissionDisk DiskAcross(const Vec3& w);

/// Points that see the lights of `AllLights` from near, from far, from behind and edge-on.
std::vector<LightContext> TestContexts();

/// Chi-square of `Sample_Li` against `Pdf_Li`: over the shape's surface where there is one (so that the parts of it
/// which stand in each other's way are told apart), else over the sphere. Passes delta lights.
Verdict CheckDirectionsToLight(const TestedLight& tested, const LightContext& at);

/// Chi-square of `Sample_Le` against `Pdf_Le`: of the origins alone, over the shape's surface or the disk across the
/// scene; of the directions alone; and of both together. Passes where the half is discrete.
Verdict CheckRayOrigins(const TestedLight& tested);
Verdict CheckRayDirections(const TestedLight& tested);
Verdict CheckRays(const TestedLight& tested);

/// The mean flux of emitted rays is `Power()`, within five standard errors, and so is an adaptive quadrature of what
/// the light emits by its own account of radiance (`L`, `Le`, or what `Sample_Li` says of a light without extent),
/// which may differ by `quadratureError` of it.
Verdict CheckEnergy(const TestedLight& tested, double quadratureError = 2e-4);

/// A disk of the scene that receives light on its upper side.
struct Patch {
  Vec3 center;
  Frame frame;
  float radius;
};

/// Patches that any light may be asked about, and one where most of this light's rays fall.
std::vector<Patch> TestPatches(const TestedLight& tested);

/// The irradiance by `Sample_Li`, taken over the patch, is the flux of `Sample_Le`'s rays through it, within five
/// standard errors of their difference. `receiver`: what `Sample_Li` is told but for point and normal.
Verdict CheckBothSides(const TestedLight& tested, const Patch& patch,
                       const LightContext& receiver = LightContext(Vec3(0)));

/// Draws report the densities that `Pdf_Li` and `Pdf_Le` have for them, and the radiance that a ray which meets the
/// light there looks up (not asked of textures, whose points round). The flux of no ray, in its largest component, is
/// more than `spread` times or less than 1 / `spread` of the mean: emission is in proportion to what is looked up.
Verdict CheckLookup(const TestedLight& tested, double spread, bool isTextured = false);

}  // namespace dapple
