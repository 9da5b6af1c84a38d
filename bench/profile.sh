#!/usr/bin/env bash
# profile.sh COMMAND ARGS...: where the processor time of a render goes, by the names of the functions that perf saw it in.
#   bench/profile.sh build/release/dapple render scene.pbrt --integrator sppm --passes 24 --quiet -o /tmp/profile.exr
set -euo pipefail

[ $# -gt 0 ] || { sed -n 2,3p "$0"; exit 2; }
command -v perf > /dev/null || { echo "profile.sh needs perf (Debian: linux-perf)" >&2; exit 1; }
data=$(mktemp)
trap 'rm -f "$data"' EXIT
perf record --quiet --output "$data" --freq 800 "$@"
perf report --input "$data" --sort dso,sym 2> /dev/null | awk '
  function kind(name) {
    if (name ~ /ForEachLightPath/) return "walks from the lights"
    if (name ~ /embree/) return "Embree"
    if (name ~ /Accelerator|Intersect|TriangleMesh::(Interact|Corners|PointError|Fill)|Sphere::[^S]|Quadric|FirstAccepted|IsTraceable|MaterialAt|Unoccluded|ShadowRay|nextafter|atan2/) return "intersections beside Embree"
    if (name ~ /PassOn|::Gather|::Merge|GatherRadius::(At|KeyOf)|InverseCoverage|IsOnSameSurface/) return "gathering"
    if (name ~ /Bsdf|Material|Lobe|Light|Distribution|Spherical|Emission|SampleCosine|SampleArea|SampleSolid|SampleAt|FindCell|PointInCell|variant|Fresnel|sincos|__sin_|__cos|EmittedAlong|SampleDirect|SampleDisk/) return "shading and lights"
    if (name ~ /Sampler/) return "random numbers"
    if (name ~ /divideTree|SplitInto|BuildTrees|Permute|nanoflann|memmove|nth/) return "building photon maps"
    return "other"
  }
  /%/ && !/^#/ { share[kind($0)] += $1; total += $1 }
  END { for (name in share) printf "%5.1f %%  %s\n", 100 * share[name] / total, name }' | sort -rn
