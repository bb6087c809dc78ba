#pragma once

#include <atomic>
#include <deque>
#include <optional>
#include <string_view>
#include <vector>

#include "edge/usb/testing/emulated_device.h"
#include "edge/usb/testing/fault_script.h"

namespace isotherm {

/// A Thermal Master P3 (256x192) at high speed: bulk transfers with markers. Faults:
/// freeze, nuc, skip, short, head (the start marker is damaged), partial (a piece of a frame comes
/// first), noend (no end marker), and the steps of FaultScript.
class EmulatedP3 : public EmulatedDevice {
 public:
  explicit EmulatedP3(std::string_view script) : EmulatedP3(script, 256, 192, 0x45A2) {}

  static constexpr std::uint16_t kFirstCount = 18'560;  // 290 K.
  static constexpr int kNoise = 8;

  EmulatedIdentity identity() const override;
  std::optional<std::vector<std::uint8_t>> Control(const UsbControl& control, Bytes data,
                                                   std::size_t read_bytes) override;
  void SetAlternate(int interface, int alternate) override;
  EmulatedPacket Isochronous(std::uint8_t, Nanoseconds, std::size_t) override { return {}; }
  std::optional<std::vector<std::uint8_t>> Bulk(std::uint8_t endpoint, Nanoseconds time,
                                                std::size_t most) override;
  std::optional<Unplugged> TakeUnplugged() override;

  /// Thread-safe.
  int corrections() const { return corrections_; }
  int gain() const { return gain_; }  ///< 0 low, 1 high, -1 never set.
  int alternate() const { return alternate_; }

 protected:
  /// The metadata of a P3 is known; rows of others hold nothing.
  EmulatedP3(std::string_view script, int width, int height, std::uint16_t product_id);

 private:
  bool is_p3() const { return product_id_ == 0x45A2; }
  std::size_t row_bytes() const { return 2 * static_cast<std::size_t>(width_); }
  void Begin(const FaultStep& step, Nanoseconds time);
  std::vector<std::uint8_t> Marker(bool end) const;
  std::vector<std::uint8_t> MakeData(const FaultStep& step);

  const int width_;
  const int height_;
  const std::uint16_t product_id_;
  FaultScript script_;
  bool stalled_ = false;
  bool streaming_ = false;
  std::optional<Unplugged> unplugged_;
  std::optional<Unplugged> unplug_after_;  ///< The first half of the frame.
  std::vector<std::uint8_t> answer_;
  std::optional<Nanoseconds> next_frame_at_;
  std::deque<std::vector<std::uint8_t>> payloads_;  ///< Each ends with a short packet.
  std::size_t sent_ = 0;                            ///< Bytes of the first payload that are sent.
  std::vector<std::uint8_t> data_;
  std::uint16_t counter_ = 0;
  std::uint32_t stamp_ = 0;
  bool frame_id_ = false;
  std::uint32_t noise_ = 1;
  int ordered_frames_ = 0;
  std::atomic<int> corrections_{0};
  std::atomic<int> gain_{-1};
  std::atomic<int> alternate_{0};
};

/// A Thermal Master P1 (160x120).
class EmulatedP1 final : public EmulatedP3 {
 public:
  explicit EmulatedP1(std::string_view script) : EmulatedP3(script, 160, 120, 0x45C2) {}
};

}  // namespace isotherm
