#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/base/status.h"
#include "common/frame/image.h"

namespace isotherm {

/// Holds what the head of a PNG file says.
struct PngHead {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  int channels = 0;  ///< 1 grey, 2 grey and alpha, 3 colour (palettes too), 4 colour and alpha.
  int bits = 0;      ///< Per channel.
};

/// Reads the head only. kDataLoss if the bytes are not a PNG.
Result<PngHead> ReadPngHead(std::span<const std::uint8_t> file);

/// Decodes a 16-bit grey PNG into `image`, which has the size that the file must have. Everything
/// is checked before the decoder allocates: kind, size, and that the file is not smaller than such
/// an image can be. A file that is damaged or cut off is kDataLoss; what is in `image` is then
/// undefined. Chunks that are not pixels (text, profiles) are skipped.
Status DecodeGrey16Png(std::span<const std::uint8_t> file, Image<std::uint16_t>& image);
/// The same for 8 bits per pixel.
Status DecodeGrey8Png(std::span<const std::uint8_t> file, Image<std::uint8_t>& image);

/// Pixels for the encoder: rows from the top, without gaps.
struct PngPixels {
  int width = 0;
  int height = 0;
  int channels = 3;  ///< 1 grey or 3 colour.
  int bits = 8;      ///< 8, or 16 in the order of this machine.
  std::span<const std::uint8_t> bytes;
  /// Takes a third of the time and makes the file larger: for what is looked at once.
  bool is_fleeting = false;
};

/// The pixels as a PNG file in memory. kInvalidArgument for an image without pixels.
Result<std::vector<std::uint8_t>> EncodePng(const PngPixels& pixels);
Result<std::vector<std::uint8_t>> EncodeGrey16Png(const Image<std::uint16_t>& image);

}  // namespace isotherm
