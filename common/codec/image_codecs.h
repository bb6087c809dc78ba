#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "common/base/status.h"
#include "common/frame/image.h"

/// The codes behind codec.h, each without its envelope.
namespace isotherm::codec {

/// Depth, whose values are few (DepthValues). Keeps its memory. Thread-compatible.
class DepthCodec {
 public:
  DepthCodec();
  ~DepthCodec();
  void Encode(const Image<std::uint16_t>& image, std::vector<std::uint8_t>& payload);
  /// `image` has the size that the payload must have.
  Status Decode(std::span<const std::uint8_t> payload, Image<std::uint16_t>& image);

 private:
  struct Scratch;
  std::unique_ptr<Scratch> scratch_;
};

/// Temperature: smooth up to the camera's noise. Keeps its memory. Thread-compatible.
class ThermalCodec {
 public:
  ThermalCodec();
  ~ThermalCodec();
  void Encode(const Image<std::uint16_t>& image, std::vector<std::uint8_t>& payload);
  /// `image` has the size that the payload must have.
  Status Decode(std::span<const std::uint8_t> payload, Image<std::uint16_t>& image);

 private:
  struct Scratch;
  std::unique_ptr<Scratch> scratch_;
};

}  // namespace isotherm::codec
