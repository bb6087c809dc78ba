#include "edge/thermal_camera/testing/emulated_lepton.h"

#include <algorithm>

namespace isotherm {
namespace {

constexpr int kWidth = 160;
constexpr int kHeight = 120;
constexpr std::uint32_t kPeriodMs = 115;  // 8.7 Hz.
constexpr int kFramesOfCorrection = 8;    // 23 of 26 per second inside.
constexpr std::uint8_t kSysUnit = 6;
constexpr std::uint32_t kFlippedBit = 1U << 24U;

UvcCameraLayout Layout() {
  UvcCameraLayout layout;
  layout.units = {
      {kSysUnit, {'p', 't', '1', '-', 'l', 'e', 'p', '-', 's', 'y', 's', '-', '0', '0', '0', '0'}}};
  layout.four_characters = "Y16 ";
  layout.sizes = {{kWidth, kHeight}, {kWidth, kHeight + 2}};
  layout.interval = 1'150'000;
  layout.packet_fields = {642, 962};
  return layout;
}

EmulatedIdentity Identity(std::string_view serial) {
  EmulatedIdentity identity;
  identity.vendor_id = 0x1E4E;
  identity.product_id = 0x0100;
  identity.product = "PureThermal (fw:v1.3.0)";
  identity.serial = serial;
  return identity;
}

}  // namespace

EmulatedLepton::EmulatedLepton(std::string_view script, std::string_view serial)
    : EmulatedUvcCamera(Identity(serial), Layout(), 2, script),
      frame_(2 * kWidth * (kHeight + 2)) {}

std::vector<std::uint8_t> EmulatedLepton::MakeFrame(const FaultStep& step) {
  ++frames_;
  if (step.fault == "reset") uptime_ms_ = 0;
  uptime_ms_ += kPeriodMs;
  if (step.fault != "freeze") counter_ += step.fault == "skip" ? 12 : 3;
  const bool correcting = step.fault == "nuc" || ordered_frames_ > 0;
  if (ordered_frames_ > 0) --ordered_frames_;
  if (correcting) uptime_at_ffc_ms_ = uptime_ms_;
  for (int i = 0; i < kWidth * kHeight && step.fault != "freeze" && step.fault != "still"; ++i) {
    noise_ = noise_ * 1'664'525 + 1'013'904'223;
    const auto ramp = static_cast<std::uint32_t>(correcting ? 0 : i % kWidth);
    PutLe16(frame_, 2 * static_cast<std::size_t>(i),
            static_cast<std::uint16_t>(kFirstCentikelvin + ramp + (noise_ >> 24) % kNoise));
  }
  const std::span<std::uint8_t> telemetry = std::span(frame_).subspan(2 * kWidth * kHeight);
  const std::uint32_t state = correcting ? 2 : step.fault == "imminent" ? 1 : 3;
  PutLe16(telemetry, 0, 0x000E);
  PutLe32(telemetry, 2 * 1, uptime_ms_);
  PutLe32(telemetry, 2 * 3, state << 4);
  PutLe32(telemetry, 2 * 20, step.fault == "flip" ? counter_ ^ kFlippedBit : counter_);
  PutLe16(telemetry, 2 * 24, 30'815);
  PutLe16(telemetry, 2 * 26, 30'315);
  PutLe32(telemetry, 2 * 30, uptime_at_ffc_ms_);
  PutLe16(telemetry, 2 * (160 + 48), 1);
  PutLe16(telemetry, 2 * (160 + 49), 1);
  return frame_;
}

std::optional<std::vector<std::uint8_t>> EmulatedLepton::VendorControl(const UsbControl& control,
                                                                       Bytes data,
                                                                       std::size_t read_bytes) {
  constexpr std::uint16_t kFfcMode = 16 << 8;
  constexpr std::uint16_t kRunFfc = 17 << 8;
  constexpr std::uint16_t kGain = 19 << 8;
  if (control.index != (kSysUnit << 8)) return std::nullopt;
  const bool reads = control.request_type == 0xA1;
  if (control.value == kRunFfc && !reads && data.size() == 1) {
    ++corrections_;
    ordered_frames_ = kFramesOfCorrection;
    return std::vector<std::uint8_t>();
  }
  if (control.value == kGain && reads) {
    return std::vector<std::uint8_t>{static_cast<std::uint8_t>(gain_.load()), 0, 0, 0};
  }
  if (control.value == kGain && data.size() == 4) {
    if (!keeps_gain_) gain_ = data[0];
    return std::vector<std::uint8_t>();
  }
  if (control.value == kFfcMode && reads) {
    std::vector<std::uint8_t> mode(32);
    mode[0] = static_cast<std::uint8_t>(ffc_mode_.load());
    mode.resize(std::min(read_bytes, mode.size()));
    return mode;
  }
  if (control.value == kFfcMode && data.size() == 32) {
    ffc_mode_ = data[0];
    return std::vector<std::uint8_t>();
  }
  return std::nullopt;
}

}  // namespace isotherm
