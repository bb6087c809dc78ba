#include "edge/usb/uvc_probe.h"

#include <fmt/format.h>

namespace isotherm {

std::size_t UvcProbeBytes(int version) {
  // UVC 1.5, table 4-75, and its predecessors: each version appended fields.
  if (version >= 0x0150) return 48;
  return version >= 0x0110 ? 34 : 26;
}

std::vector<std::uint8_t> PackUvcProbe(const UvcProbe& probe, std::size_t size) {
  std::vector<std::uint8_t> bytes(size);
  bytes[0] = 1;  // bmHint: keep the interval.
  bytes[2] = probe.format;
  bytes[3] = probe.frame;
  PutLe32(bytes, 4, probe.interval);
  PutLe32(bytes, 18, probe.max_frame_bytes);
  PutLe32(bytes, 22, probe.max_payload_bytes);
  if (size >= 30) PutLe32(bytes, 26, probe.clock_hz);
  return bytes;
}

Result<UvcProbe> UnpackUvcProbe(Bytes bytes) {
  if (bytes.size() < 26) {
    return Err(DataLoss(
        fmt::format("UVC probe: the camera answers {} bytes instead of 26", bytes.size())));
  }
  UvcProbe probe;
  probe.format = bytes[2];
  probe.frame = bytes[3];
  probe.interval = Le32(bytes, 4);
  probe.max_frame_bytes = Le32(bytes, 18);
  probe.max_payload_bytes = Le32(bytes, 22);
  if (bytes.size() >= 30) probe.clock_hz = Le32(bytes, 26);
  return probe;
}

}  // namespace isotherm
