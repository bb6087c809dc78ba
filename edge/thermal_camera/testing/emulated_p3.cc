#include "edge/thermal_camera/testing/emulated_p3.h"

#include <algorithm>
#include <cstdlib>
#include <string>
#include <utility>

namespace isotherm {
namespace {

constexpr Nanoseconds kPeriod = std::chrono::milliseconds(40);
constexpr std::uint32_t kTicksPerFrame = 600'000;
constexpr int kFramesOfCorrection = 20;
constexpr std::string_view kSerial = "P3-SERIAL-7";

}  // namespace

EmulatedP3::EmulatedP3(std::string_view script, int width, int height, std::uint16_t product_id)
    : width_(width),
      height_(height),
      product_id_(product_id),
      script_(script),
      data_(row_bytes() * (2 * static_cast<std::size_t>(height) + 2)) {}

EmulatedIdentity EmulatedP3::identity() const {
  EmulatedIdentity identity;
  identity.vendor_id = 0x3474;
  identity.product_id = product_id_;
  identity.product = is_p3() ? "P3" : "P1";
  identity.serial = kSerial;
  identity.high_speed = true;
  identity.configuration = {9, 2, 50,   0, 2,    1,    0, 0x80, 50,  // Two interfaces:
                            9, 4, 0,    0, 0,    0xFF, 0, 0,    0,   // control,
                            9, 4, 1,    0, 0,    0xFF, 0, 0,    0,   // streaming off,
                            9, 4, 1,    1, 2,    0xFF, 0, 0,    0,   // streaming on.
                            7, 5, 0x81, 2, 0x00, 0x02, 0,            // Bulk, 512 bytes.
                            7, 5, 0x02, 2, 0x00, 0x02, 0};
  identity.configuration[2] = static_cast<std::uint8_t>(identity.configuration.size());
  return identity;
}

std::optional<std::vector<std::uint8_t>> EmulatedP3::Control(const UsbControl& control, Bytes data,
                                                             std::size_t read_bytes) {
  if (stalled_) return std::nullopt;
  if (control.request_type == 0x40 && control.request == 0xEE) {
    streaming_ = true;
    return std::vector<std::uint8_t>();
  }
  if (control.request_type == 0xC1 && control.request == 0x21) {
    answer_.resize(read_bytes);
    return answer_;
  }
  if (control.request_type == 0xC1 && control.request == 0x22) {
    return std::vector<std::uint8_t>{2};
  }
  if (control.request_type != 0x41 || control.request != 0x20 || data.size() != 18) {
    return std::nullopt;
  }
  const std::uint16_t type = Le16(data, 0);
  const std::uint16_t parameter = Le16(data, 2);
  answer_ = {1};
  if (type == 0x0101 && Le16(data, 4) == 7) answer_.assign(kSerial.begin(), kSerial.end());
  if (type == 0x2F01 && parameter == 0x41) gain_ = Le16(data, 4);
  if (type == 0x3601 && parameter == 0x43) {
    ++corrections_;
    ordered_frames_ = kFramesOfCorrection;
  }
  return std::vector<std::uint8_t>();
}

void EmulatedP3::SetAlternate(int interface, int alternate) {
  if (interface != 1) return;
  alternate_ = alternate;
  streaming_ = false;
  payloads_.clear();
  sent_ = 0;
  next_frame_at_.reset();
}

std::vector<std::uint8_t> EmulatedP3::Marker(bool end) const {
  std::vector<std::uint8_t> marker(12);
  marker[0] = 12;
  marker[1] = static_cast<std::uint8_t>(0x8C | (frame_id_ ? 1 : 0) | (end ? 2 : 0));
  PutLe32(marker, 2, stamp_);
  PutLe16(marker, 10, static_cast<std::uint16_t>(stamp_ / 15'000 & 0x7FF));
  return marker;
}

std::vector<std::uint8_t> EmulatedP3::MakeData(const FaultStep& step) {
  const bool correcting = step.fault == "nuc" || ordered_frames_ > 0;
  const bool frozen = correcting || step.fault == "freeze";
  if (ordered_frames_ > 0) --ordered_frames_;
  if (!frozen) counter_ = static_cast<std::uint16_t>(counter_ + (step.fault == "skip" ? 4 : 1));
  const std::size_t metadata = row_bytes() * static_cast<std::size_t>(height_);
  if (is_p3()) {
    PutLe16(data_, metadata + 2 * 64, counter_);
    PutLe16(data_, metadata + 2 * 169, correcting ? 0 : 1000);
    PutLe16(data_, metadata + 2 * 170, correcting ? 0 : 1001);
  }
  for (int i = 0; i < width_ * height_ && !frozen; ++i) {
    noise_ = noise_ * 1'664'525 + 1'013'904'223;
    const int count = kFirstCount + i % width_ + static_cast<int>((noise_ >> 24) % kNoise);
    PutLe16(data_, metadata + 2 * row_bytes() + 2 * static_cast<std::size_t>(i),
            static_cast<std::uint16_t>(count));
  }
  return data_;
}

void EmulatedP3::Begin(const FaultStep& step, Nanoseconds) {
  frame_id_ = !frame_id_;
  stamp_ += kTicksPerFrame;
  std::vector<std::uint8_t> payload = Marker(false);
  const std::vector<std::uint8_t> data = MakeData(step);
  payload.insert(payload.end(), data.begin(), data.end());
  if (step.fault == "head") payload[0] = 99;
  if (step.fault == "short") payload.resize(payload.size() / 2 + 1);
  if (step.fault == "partial") {
    payloads_.emplace_back(payload.begin(),
                           payload.begin() + 12 + static_cast<std::ptrdiff_t>(36 * row_bytes()));
  }
  if (step.what == "unplug") {
    unplug_after_.emplace();
    if (!step.fault.empty()) {
      unplug_after_->back_after = std::chrono::milliseconds(std::atoi(step.fault.c_str()));
    }
  }
  payloads_.push_back(std::move(payload));
  if (step.fault != "noend") payloads_.push_back(Marker(true));
}

std::optional<std::vector<std::uint8_t>> EmulatedP3::Bulk(std::uint8_t endpoint, Nanoseconds time,
                                                          std::size_t most) {
  if (endpoint != 0x81 || !streaming_ || unplugged_) return std::nullopt;
  if (!next_frame_at_) next_frame_at_ = time;
  if (payloads_.empty()) {
    if (time < *next_frame_at_) return std::nullopt;
    *next_frame_at_ += kPeriod;
    FaultStep step = script_.Next();
    while (step.what == "stall" || step.what == "unstall") {
      stalled_ = step.what == "stall";
      step = script_.Next();
    }
    if (step.what == "-") return std::nullopt;
    Begin(step, time);
  }
  std::vector<std::uint8_t>& payload = payloads_.front();
  const auto begin = payload.begin() + static_cast<std::ptrdiff_t>(sent_);
  const std::size_t size = std::min(most, payload.size() - sent_);
  std::vector<std::uint8_t> transfer(begin, begin + static_cast<std::ptrdiff_t>(size));
  sent_ += size;
  if (unplug_after_ && sent_ > payload.size() / 2) unplugged_ = std::exchange(unplug_after_, {});
  if (sent_ == payload.size()) {
    payloads_.pop_front();
    sent_ = 0;
  }
  return transfer;
}

std::optional<EmulatedDevice::Unplugged> EmulatedP3::TakeUnplugged() {
  return std::exchange(unplugged_, std::nullopt);
}

}  // namespace isotherm
