#include "src/image/image.h"

#include <algorithm>

namespace dapple {

namespace {

// Which channel stands for R, G and B (-1: none), as `ColorAt` promises.
std::array<int, Color::kComponents> ColorChannels(const Image& image) {
  const std::array<int, Color::kComponents> rgb = {image.FindChannel("R"), image.FindChannel("G"),
                                                   image.FindChannel("B")};
  if (std::count(rgb.begin(), rgb.end(), -1) < 2) return rgb;
  const int luminance = image.FindChannel("Y");
  const int gray = luminance >= 0 ? luminance : (image.Channels() > 0 ? 0 : -1);
  return {gray, gray, gray};
}

}  // namespace

Image::Image(int width, int height, std::vector<std::string> channelNames)
    : fullSize(width, height), width_(width), height_(height), channelNames_(std::move(channelNames)) {
  assert(width >= 0 && height >= 0);
  colorChannels_ = ColorChannels(*this);
  pixels_.resize(static_cast<size_t>(width) * static_cast<size_t>(height) * channelNames_.size());
}

Image::Image(int width, int height, std::vector<std::string> channelNames, std::vector<float> values)
    : fullSize(width, height),
      width_(width),
      height_(height),
      channelNames_(std::move(channelNames)),
      pixels_(std::move(values)) {
  assert(pixels_.size() == static_cast<size_t>(width) * static_cast<size_t>(height) * channelNames_.size());
  colorChannels_ = ColorChannels(*this);
}

int Image::FindChannel(std::string_view name) const {
  const auto found = std::find(channelNames_.begin(), channelNames_.end(), name);
  return found == channelNames_.end() ? -1 : static_cast<int>(found - channelNames_.begin());
}

}  // namespace dapple
