#pragma once

#include "common/base/status.h"
#include "common/frame/frame.h"

namespace isotherm {

/// Lossless packing of 16-bit images. Each encoder keeps its scratch memory, so that a stream
/// allocates only its payloads. Thread-compatible: one per stream.
class DepthEncoder {
 public:
  DepthEncoder();
  ~DepthEncoder();
  EncodedImage Encode(const Image<std::uint16_t>& depth_raw);

 private:
  struct Scratch;
  std::unique_ptr<Scratch> scratch_;
};

/// Encodes thermal images without loss and keeps its buffers from one to the next.
/// Thread-compatible.
class ThermalEncoder {
 public:
  ThermalEncoder();
  ~ThermalEncoder();
  /// Pixels are counts of `scale`, which decides the encoding (TemperatureEncoding): the image does
  /// not carry it.
  EncodedImage Encode(const Image<std::uint16_t>& temperature_raw, const RadiometricScale& scale);

 private:
  struct Scratch;
  std::unique_ptr<Scratch> scratch_;
};

/// Returns the encoding of images whose pixels are counts of `scale`: one of its own for any but
/// centi-kelvin, so that nobody who knows no other scale takes them for that.
Encoding TemperatureEncoding(const RadiometricScale& scale);

/// Cannot be taken for temperatures: see Encoding::kCounts16.
EncodedImage PackCounts(const Image<std::uint16_t>& counts);

/// Unpacks any Encoding. Sizes are checked before anything is allocated; a payload that is
/// truncated, too long or inconsistent is kDataLoss and never read out of bounds. `max_pixels`
/// bounds width x height.
Result<Image<std::uint16_t>> Decode(const EncodedImage& encoded, std::size_t max_pixels = 1U << 24);

/// Decode for those who ask for temperatures, in counts of the frame's scale: an empty image if
/// nothing relates its counts to temperatures.
Result<Image<std::uint16_t>> DecodeTemperatures(const EncodedImage& encoded,
                                                std::size_t max_pixels = 1U << 24);

}  // namespace isotherm
