#pragma once

#include <cstdint>
#include <optional>

#include "common/base/status.h"
#include "common/frame/frame.h"
#include "edge/thermal_camera/thermal_camera.h"
#include "edge/usb/bytes.h"

namespace isotherm {

/// FLIR Lepton behind a PureThermal board: 16-bit images with three rows of telemetry below
/// (Lepton Engineering Datasheet 500-0659-00-09; groupgets/purethermal1-firmware).
struct LeptonTelemetry {
  std::uint32_t uptime_ms = 0;
  std::uint32_t uptime_at_ffc_ms = 0;  ///< 0 = none since power-up.
  std::uint32_t frame_counter = 0;     ///< Counts at the 26 Hz inside; 3 per sent image.
  std::uint16_t fpa_centikelvin = 0;
  std::uint16_t housing_centikelvin = 0;
  bool ffc_desired = false;
  std::uint8_t ffc_state = 0;  ///< 0 never, 1 imminent, 2 in progress, 3 complete.
  bool shutter_locked_out = false;
  bool tlinear = false;          ///< Counts are temperatures.
  bool fine_resolution = false;  ///< 0.01 K per count instead of 0.1 K.
};

/// Image of `width` x `height` (160x120 or 80x60) followed by 240 words of telemetry.
struct LeptonFrame {
  Image<std::uint16_t> counts;
  LeptonTelemetry telemetry;
};

/// Rows that the telemetry takes below an image of this width.
int LeptonTelemetryRows(int width);
/// kDataLoss if `bytes` has not the size of such a frame.
Result<LeptonFrame> ParseLeptonFrame(Bytes bytes, int width, int height);
PixelEncoding LeptonEncoding(const LeptonTelemetry& telemetry);
CameraNuc LeptonNuc(const LeptonTelemetry& telemetry);

}  // namespace isotherm
