#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "edge/usb/uvc_descriptors.h"

namespace isotherm {

/// Holds what the descriptors of an emulated UVC camera say.
struct UvcCameraLayout {
  std::uint16_t version = 0x0100;
  std::vector<UvcUnit> units;
  std::string_view four_characters;
  /// Holds an image size that the camera offers.
  struct Size {
    int width = 0;
    int height = 0;
  };
  std::vector<Size> sizes;                    ///< Frame indices count from 1 in this order.
  std::uint32_t interval = 333'333;           ///< 100 ns.
  std::vector<std::uint16_t> packet_fields;   ///< wMaxPacketSize of alternate settings 1, 2, ...
  bool bulk = false;                          ///< Then one packet field, in alternate setting 0.
  std::uint32_t bulk_payload_bytes = 16'384;  ///< Most bytes of a payload, header included.
};

/// A configuration descriptor with a video function: control interface 0, streaming interface 1,
/// endpoint 0x81, one uncompressed 16-bit format with index 2.
std::vector<std::uint8_t> MakeUvcConfiguration(const UvcCameraLayout& layout);

inline constexpr std::uint8_t kEmulatedFormatIndex = 2;

}  // namespace isotherm
