#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "common/base/status.h"
#include "common/frame/image.h"

/// These unpack images of Encoding::kDepthRans, kThermalRans and kScaledThermalRans, in which
/// programs up to 0.2 packed them, in an upper and a lower half.
namespace isotherm::codec {

/// Keeps its memory. Thread-compatible.
class DepthHalvesDecoder {
 public:
  DepthHalvesDecoder();
  ~DepthHalvesDecoder();
  /// `image` has the size that the payload must have.
  Status Decode(std::span<const std::uint8_t> payload, Image<std::uint16_t>& image);

 private:
  struct Scratch;
  std::unique_ptr<Scratch> scratch_;
};

/// Keeps its memory. Thread-compatible.
class ThermalHalvesDecoder {
 public:
  ThermalHalvesDecoder();
  ~ThermalHalvesDecoder();
  /// `image` has the size that the payload must have.
  Status Decode(std::span<const std::uint8_t> payload, Image<std::uint16_t>& image);

 private:
  struct Scratch;
  std::unique_ptr<Scratch> scratch_;
};

}  // namespace isotherm::codec
