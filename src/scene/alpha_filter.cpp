#include "src/scene/alpha_filter.h"

#include <bit>

#include "src/base/hash.h"

namespace dapple {

namespace {

uint64_t Bits(float a, float b) {
  return (static_cast<uint64_t>(std::bit_cast<uint32_t>(a)) << 32) | std::bit_cast<uint32_t>(b);
}

}  // namespace

bool AlphaFilter::Accepts(const Shape& shape, const PrimitiveHit& hit, const Ray& ray) const {
  TextureContext at(shape.Uv(hit));
  at.p = ray(hit.t);
  const float coverage = Coverage(*alpha_, at);
  if (coverage == 0 || coverage == 1) return coverage == 1;
  const uint64_t hash = Hash(Bits(ray.o.x, ray.o.y), Bits(ray.o.z, ray.d.x), Bits(ray.d.y, ray.d.z),
                             Bits(hit.b1, hit.b2), static_cast<uint64_t>(hit.primitive));
  return static_cast<double>(hash >> 11) * 0x1p-53 < static_cast<double>(coverage);
}

}  // namespace dapple
