#include "edge/thermal_camera/testing/emulated_seek.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace isotherm {
namespace {

constexpr Nanoseconds kPeriod = std::chrono::milliseconds(111);
constexpr Nanoseconds kLate = std::chrono::milliseconds(1'300);
constexpr int kShutterLevel = 8'000;  // Counts.
constexpr std::size_t kCutBytes = 512;

// Ids of frames.
constexpr int kShutter = 1;
constexpr int kImage = 3;
constexpr int kFirst = 4;
constexpr int kOther = 8;

/// Detectors differ by this much.
int PatternAt(int x, int y) { return (7 * x + 13 * y) % 50; }

}  // namespace

EmulatedSeek::EmulatedSeek(std::string_view script, Setup setup)
    : setup_(setup), script_(script), running_(setup.left_running) {}

bool EmulatedSeek::IsDead(int x, int y) {
  const bool in_cluster = x < 3 && y < 3;
  return in_cluster || (x % 15 == 7 && y % 11 == 5);
}

EmulatedIdentity EmulatedSeek::identity() const {
  EmulatedIdentity identity;
  identity.vendor_id = 0x289D;
  identity.product_id = setup_.model.name == kSeekCompactPro.name ? 0x0011 : 0x0010;
  identity.high_speed = true;
  identity.configuration = {9, 2, 32,   0, 1,    1,    0, 0x80, 50,  // One interface, bulk.
                            9, 4, 0,    0, 2,    0xFF, 0, 0,    0,   //
                            7, 5, 0x81, 2, 0x00, 0x02, 0,            //
                            7, 5, 0x02, 2, 0x00, 0x02, 0};
  return identity;
}

std::optional<std::vector<std::uint8_t>> EmulatedSeek::Control(const UsbControl& control,
                                                               Bytes data, std::size_t read_bytes) {
  const bool known = control.request_type == 0x41 || control.request_type == 0xC1;
  if (stalled_ || !known || control.value != 0 || control.index != 0) return std::nullopt;
  opcodes_.push_back(control.request);
  return Answer(control.request, data, read_bytes);
}

std::optional<std::vector<std::uint8_t>> EmulatedSeek::Answer(int opcode, Bytes data,
                                                              std::size_t read_bytes) {
  std::vector<std::uint8_t> answer(read_bytes);
  switch (opcode) {
    case 84:
      if (running_) return std::nullopt;
      break;
    case 60:
      if (data.size() != 2) return std::nullopt;
      running_ = data[0] == 1;
      pieces_.clear();
      sent_ = 0;
      asked_ = false;
      start_frames_ = {kFirst, kOther, kShutter};
      if (running_) ++starts_;
      break;
    case 54:
      for (std::size_t i = 0; i < answer.size(); ++i) answer[i] = static_cast<std::uint8_t>(i);
      break;
    case 83:
      if (!running_ || data.size() != 4 || Le32(data, 0) != setup_.model.words()) {
        return std::nullopt;
      }
      asked_ = true;
      break;
    default:
      break;
  }
  return answer;
}

std::vector<std::uint8_t> EmulatedSeek::MakeFrame(int id, const FaultStep& step) {
  if (step.fault == "freeze" && !last_.empty()) return last_;
  counter_ = static_cast<std::uint16_t>(counter_ + (step.fault == "skip" ? 4 : 1));
  const SeekModel& model = setup_.model;
  std::vector<std::uint8_t> frame(model.frame_bytes(), 0x55);
  for (int y = 0; y < model.height; ++y) {
    for (int x = 0; x < model.width; ++x) {
      noise_ = noise_ * 1'664'525 + 1'013'904'223;
      int count = kShutterLevel + PatternAt(x, y);
      if (id == kImage) count += x + static_cast<int>((noise_ >> 24) % kNoise);
      if (IsDead(x, y)) count = 0;
      const int word = (model.top + y) * model.raw_width + model.left + x;
      PutLe16(frame, 2 * static_cast<std::size_t>(word), static_cast<std::uint16_t>(count));
    }
  }
  PutLe16(frame, 2 * model.id_word, static_cast<std::uint16_t>(id));
  PutLe16(frame, 2 * model.counter_word, counter_);
  last_ = frame;
  return frame;
}

void EmulatedSeek::Send(std::vector<std::uint8_t> frame, const FaultStep& step, Nanoseconds time) {
  if (step.fault == "short") frame.resize(frame.size() * 3 / 4 + 100);
  if (step.fault == "cut") frame.erase(frame.begin(), frame.begin() + kCutBytes);
  const std::size_t half = frame.size() / 2;
  for (std::size_t at = 0; at < frame.size(); at += setup_.model.read_bytes) {
    const std::size_t size = std::min(setup_.model.read_bytes, frame.size() - at);
    const auto begin = frame.begin() + static_cast<std::ptrdiff_t>(at);
    const bool late = step.fault == "late" && at >= half;
    pieces_.push_back({{begin, begin + static_cast<std::ptrdiff_t>(size)},
                       time + (late ? kLate : Nanoseconds(0))});
  }
  if (step.what != "unplug") return;
  unplug_after_.emplace();
  if (!step.fault.empty()) {
    unplug_after_->back_after = std::chrono::milliseconds(std::atoi(step.fault.c_str()));
  }
}

bool EmulatedSeek::Serve(Nanoseconds time) {
  if (!asked_) return false;
  if (!next_frame_at_) next_frame_at_ = time;
  if (time < *next_frame_at_) return false;
  *next_frame_at_ = std::max(*next_frame_at_ + kPeriod, time);
  FaultStep step{"f", ""};
  int id = kImage;
  if (!start_frames_.empty()) {
    id = start_frames_.front();
    start_frames_.pop_front();
    if (id == kFirst && starts_ <= setup_.first_frames_cut) step.fault = "cut";
  } else {
    step = script_.Next();
    while (step.what == "stall" || step.what == "unstall") {
      stalled_ = step.what == "stall";
      step = script_.Next();
    }
    if (step.fault == "nuc") id = kShutter;
    if (step.fault == "other") id = kOther;
  }
  if (step.what == "-") return false;
  asked_ = false;
  Send(MakeFrame(id, step), step, time);
  return true;
}

std::optional<std::vector<std::uint8_t>> EmulatedSeek::Bulk(std::uint8_t endpoint, Nanoseconds time,
                                                            std::size_t most) {
  if (endpoint != 0x81 || !running_ || unplugged_) return std::nullopt;
  if (pieces_.empty() && !Serve(time)) return std::nullopt;
  Piece& piece = pieces_.front();
  if (time < piece.not_before) return std::nullopt;
  const std::size_t size = std::min(most, piece.bytes.size() - sent_);
  const auto begin = piece.bytes.begin() + static_cast<std::ptrdiff_t>(sent_);
  std::vector<std::uint8_t> transfer(begin, begin + static_cast<std::ptrdiff_t>(size));
  sent_ += size;
  if (sent_ == piece.bytes.size()) {
    pieces_.pop_front();
    sent_ = 0;
  }
  // After the second of the frame's parts.
  const std::size_t parts = setup_.model.frame_bytes() / setup_.model.read_bytes;
  if (unplug_after_ && pieces_.size() + 2 <= parts) {
    running_ = false;
    unplugged_ = std::exchange(unplug_after_, {});
  }
  return transfer;
}

std::optional<EmulatedDevice::Unplugged> EmulatedSeek::TakeUnplugged() {
  const std::optional<Unplugged> unplugged = std::exchange(unplugged_, std::nullopt);
  if (unplugged) pieces_.clear();
  return unplugged;
}

}  // namespace isotherm
