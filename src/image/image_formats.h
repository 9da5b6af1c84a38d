// One reader for each family of image formats; image_io.cpp chooses. Each throws `Error` at `location`.
#pragma once

#include <string>
#include <string_view>

#include "src/image/image_io.h"

namespace dapple {

/// Throws where an image of this size would pass `kMaxImagePixels` or `kMaxImageSide`, or has no pixel.
void CheckImageSize(int64_t width, int64_t height, const FileLocation& location);

/// Decodes a whole image file in memory; `path` is asked for its extension where the content bears no mark (TGA).
Image DecodeImage(std::string_view bytes, const std::string& path, ColorEncoding encoding,
                  const FileLocation& location);

/// OpenEXR: `bytes` is the whole file.
Image ReadExr(std::string_view bytes, const FileLocation& location);
/// PNG, JPEG, TGA: `bytes` is the whole file.
Image ReadStb(std::string_view bytes, ColorEncoding encoding, const FileLocation& location);
/// Radiance HDR ("-Y height +X width", RGBE; flat or run-length encoded in the old or the new way).
Image ReadHdr(std::string_view bytes, const FileLocation& location);
/// Portable float map: "PF" (R, G, B) or "Pf" (Y), rows from the bottom.
Image ReadPfm(std::string_view bytes, const FileLocation& location);

}  // namespace dapple
