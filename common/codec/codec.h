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

class ThermalEncoder {
 public:
  ThermalEncoder();
  ~ThermalEncoder();
  EncodedImage Encode(const Image<std::uint16_t>& centikelvin);

 private:
  struct Scratch;
  std::unique_ptr<Scratch> scratch_;
};

/// Cannot be taken for temperatures: see Encoding::kCounts16.
EncodedImage PackCounts(const Image<std::uint16_t>& counts);

/// Unpacks any Encoding. Sizes are checked before anything is allocated; a payload that is
/// truncated, too long or inconsistent is kDataLoss and never read out of bounds. `max_pixels`
/// bounds width x height.
Result<Image<std::uint16_t>> Decode(const EncodedImage& encoded, std::size_t max_pixels = 1U << 24);

/// Decode for those who ask for temperatures, centi-kelvin: an empty image if there are counts.
Result<Image<std::uint16_t>> DecodeTemperatures(const EncodedImage& encoded,
                                                std::size_t max_pixels = 1U << 24);

}  // namespace isotherm
