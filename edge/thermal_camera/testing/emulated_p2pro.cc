#include "edge/thermal_camera/testing/emulated_p2pro.h"

#include <algorithm>
#include <cstdlib>

namespace isotherm {
namespace {

constexpr int kWidth = 256;
constexpr int kHeight = 192;
constexpr int kFramesOfCorrection = 20;  // 0.8 s.

UvcCameraLayout Layout(std::uint32_t bulk_payload_bytes = 0) {
  UvcCameraLayout layout;
  layout.four_characters = "YUY2";
  layout.sizes = {{kWidth, kHeight}, {kWidth, 2 * kHeight}};
  layout.interval = 400'000;
  layout.packet_fields = {1024};
  if (bulk_payload_bytes == 0) return layout;
  layout.bulk = true;
  layout.packet_fields = {512};
  layout.bulk_payload_bytes = bulk_payload_bytes;
  return layout;
}

EmulatedIdentity Identity() {
  EmulatedIdentity identity;
  identity.vendor_id = 0x0BDA;
  identity.product_id = 0x5830;
  identity.product = "USB Camera";
  identity.high_speed = true;
  return identity;
}

}  // namespace

EmulatedP2Pro::EmulatedP2Pro(std::string_view script)
    : EmulatedUvcCamera(Identity(), Layout(), 12, script), frame_(4 * kWidth * kHeight) {}

EmulatedP2Pro::EmulatedP2Pro(std::string_view script, std::uint32_t bulk_payload_bytes)
    : EmulatedUvcCamera(Identity(), Layout(bulk_payload_bytes), 12, script),
      frame_(4 * kWidth * kHeight) {}

std::vector<std::uint8_t> EmulatedP2Pro::MakeFrame(const FaultStep& step) {
  closed_ = step.fault == "nuc" || ordered_frames_ > 0;
  if (ordered_frames_ > 0) --ordered_frames_;
  if (closed_ || step.fault == "silent" || step.fault == "freeze") return frame_;
  for (int i = 0; i < kWidth * kHeight; ++i) {
    noise_ = noise_ * 1'664'525 + 1'013'904'223;
    const int count = kFirstCount + i % kWidth + static_cast<int>((noise_ >> 24) % kNoise);
    const auto at = 2 * static_cast<std::size_t>(kWidth * kHeight + i);
    PutLe16(frame_, at, static_cast<std::uint16_t>(step.fault == "cold" ? 0x8000 : count));
  }
  return frame_;
}

std::optional<std::vector<std::uint8_t>> EmulatedP2Pro::VendorControl(const UsbControl& control,
                                                                      Bytes data,
                                                                      std::size_t read_bytes) {
  const bool writes = control.request_type == 0x41 && control.request == 0x45;
  const bool reads = control.request_type == 0xC1 && control.request == 0x44;
  if (control.value != 0x78 || (!writes && !reads)) return std::nullopt;
  if (writes) {
    TakeCommand(control.index, data);
    return std::vector<std::uint8_t>();
  }
  std::vector<std::uint8_t> answer(read_bytes);
  if (answer.empty()) return answer;
  if (control.index == 0x0200) answer[0] = busy_-- > 0 ? 1 : 0;
  if (control.index == 0x1D08) answer[0] = closed_ ? 1 : 0;
  // A parameter, high byte first; only the gain is kept.
  if (control.index == 0x1D10) answer.back() = static_cast<std::uint8_t>(gain_.load());
  return answer;
}

void EmulatedP2Pro::TakeCommand(std::uint16_t index, Bytes data) {
  busy_ = 1;
  if (data.size() != 8) return;
  if (index == 0x9D00) {
    long_command_.assign(data.begin(), data.end());
    return;
  }
  // Long: word, parameter and value, high byte first, and done with the second half.
  if (index == 0x1D08 && long_command_.size() == 8 && Le16(long_command_, 0) == 0xC514) {
    if (long_command_[3] == 3) emissivity_ = long_command_[7];
    if (long_command_[3] == 5) gain_ = long_command_[7];
    return;
  }
  if (index != 0x1D00) return;
  const std::uint16_t word = Le16(data, 0);
  if (word == 0xC10D) {
    ++corrections_;
    ordered_frames_ = kFramesOfCorrection;
  }
  if (word == 0x410C) automatic_ = data[5];
  // What would damage the camera must never be sent.
  if (word == 0x8201 || word == 0x0805 || word == 0x010A) std::abort();
}

}  // namespace isotherm
