#include "src/materials/image_texture.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace dapple {
namespace {

void CheckNotEmpty(const Image& image, const FileLocation& location) {
  if (image.Width() == 0 || image.Height() == 0)
    throw Error(location, "the image is empty; expected at least one pixel");
}

/// The channel A, or -1 where there is none or it is 1 in all pixels.
int FindUsedAlpha(const Image& image) {
  const int alpha = image.FindChannel("A");
  if (alpha < 0) return -1;
  for (int y = 0; y < image.Height(); ++y) {
    for (int x = 0; x < image.Width(); ++x) {
      if (image.At(x, y, alpha) != 1) return alpha;
    }
  }
  return -1;
}

}  // namespace

ImageColorTexture::ImageColorTexture(std::shared_ptr<const Image> image, TextureMappingPtr mapping,
                                     const ImageTextureOptions& options, const FileLocation& location)
    : image_(std::move(image)), mapping_(std::move(mapping)), options_(options) {
  assert(image_ && mapping_);
  CheckNotEmpty(*image_, location);
}

Color ImageColorTexture::Evaluate(const TextureContext& at) const {
  const Color color = options_.scale * FilterImage(*image_, mapping_->Map(at), options_.wrap, options_.filter,
                                                   [this](int x, int y) { return image_->ColorAt(x, y); });
  if (!options_.invert) return color;
  return Map(color, [](float value) { return std::max(0.f, 1 - value); });
}

ImageFloatTexture::ImageFloatTexture(std::shared_ptr<const Image> image, TextureMappingPtr mapping, PixelScalar scalar,
                                     const ImageTextureOptions& options, const FileLocation& location)
    : image_(std::move(image)), mapping_(std::move(mapping)), options_(options), scalar_(scalar) {
  assert(image_ && mapping_);
  CheckNotEmpty(*image_, location);
  if (scalar == PixelScalar::kAlphaOrAverage) alphaChannel_ = FindUsedAlpha(*image_);
}

float ImageFloatTexture::TexelAt(int x, int y) const {
  if (alphaChannel_ >= 0) return image_->At(x, y, alphaChannel_);
  const Color color = image_->ColorAt(x, y);
  if (image_->IsGray()) return color.r;
  return scalar_ == PixelScalar::kLuminance ? color.Luminance() : color.Average();
}

float ImageFloatTexture::Evaluate(const TextureContext& at) const {
  const float value = options_.scale * FilterImage(*image_, mapping_->Map(at), options_.wrap, options_.filter,
                                                   [this](int x, int y) { return TexelAt(x, y); });
  return options_.invert ? std::max(0.f, 1 - value) : value;
}

std::shared_ptr<const Image> ImageCache::Get(const std::string& path, ColorEncoding encoding,
                                             const FileLocation& location) {
  std::vector<Entry>& entries = entries_[path];
  for (const Entry& entry : entries) {
    if (entry.encoding == encoding) return entry.image;
  }
  Image image = ReadImage(path, encoding, location);
  ++openedCount_;
  const auto isBad = [](float value) { return !std::isfinite(value); };
  const auto badCount = std::count_if(image.Values().begin(), image.Values().end(), isBad);
  if (badCount > 0) {
    std::replace_if(image.Values().begin(), image.Values().end(), isBad, 0.f);
    if (diagnostics_) {
      diagnostics_->Warn(location, "\"" + path + "\" holds " + std::to_string(badCount) +
                                       " infinities or NaNs; they are taken for zero");
    }
  }
  entries.push_back({encoding, std::make_shared<const Image>(std::move(image))});
  return entries.back().image;
}

int64_t ImageCache::MemoryBytes() const {
  int64_t bytes = 0;
  for (const auto& [path, entries] : entries_)
    for (const Entry& entry : entries) bytes += static_cast<int64_t>(entry.image->Values().size_bytes());
  return bytes;
}

}  // namespace dapple
