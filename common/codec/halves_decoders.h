#pragma once

#include <cstdint>
#include <span>

#include "common/base/status.h"
#include "common/codec/depth_values.h"
#include "common/codec/halves_decoder.h"
#include "common/frame/image.h"

/// These unpack images of Encoding::kDepthRans, kThermalRans and kScaledThermalRans, in which
/// programs up to 0.2 packed them, in an upper and a lower half.
namespace isotherm::codec {

/// Keeps its memory. Thread-compatible.
class DepthHalvesDecoder {
 public:
  /// `image` has the size that the payload must have.
  Status Decode(std::span<const std::uint8_t> payload, Image<std::uint16_t>& image);

 private:
  DepthValues values_;
  HalvesDecoder<DepthModel> decoder_;
};

/// Keeps its memory. Thread-compatible.
class ThermalHalvesDecoder {
 public:
  /// `image` has the size that the payload must have.
  Status Decode(std::span<const std::uint8_t> payload, Image<std::uint16_t>& image);

 private:
  HalvesDecoder<ThermalModel> decoder_;
};

}  // namespace isotherm::codec
