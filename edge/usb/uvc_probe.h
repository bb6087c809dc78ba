#pragma once

#include <cstdint>
#include <vector>

#include "common/base/status.h"
#include "edge/usb/bytes.h"

namespace isotherm {

/// Holds what host and camera agree on before a stream starts (UVC 1.5, table 4-75), as far as
/// uncompressed video needs it.
struct UvcProbe {
  std::uint8_t format = 0;
  std::uint8_t frame = 0;
  std::uint32_t interval = 0;  ///< 100 ns.
  std::uint32_t max_frame_bytes = 0;
  std::uint32_t max_payload_bytes = 0;  ///< Per bus interval (isochronous) or per payload (bulk).
  std::uint32_t clock_hz = 0;           ///< 0 in UVC 1.0, which does not say it here.
};

/// Bytes of the control in a version of the class: 26 (1.0), 34 (1.1) or 48 (1.5).
std::size_t UvcProbeBytes(int version);
std::vector<std::uint8_t> PackUvcProbe(const UvcProbe& probe, std::size_t size);
/// kDataLoss for fewer than 26 bytes.
Result<UvcProbe> UnpackUvcProbe(Bytes bytes);

}  // namespace isotherm
