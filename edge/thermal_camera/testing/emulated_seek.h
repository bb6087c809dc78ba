#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "edge/thermal_camera/seek_protocol.h"
#include "edge/usb/testing/emulated_device.h"
#include "edge/usb/testing/fault_script.h"

namespace isotherm {

/// A Seek Compact or CompactPro: sends a frame when asked, nine per second. After a start come its
/// first frame, one of its own business and one of the shutter, and then what the script says.
/// Faults: nuc (a frame of the shutter), other (a frame of its own business), freeze, skip, short
/// (the end is missing), cut (the first 512 bytes are missing), late (the second half comes after
/// 1.3 s), and the steps of FaultScript.
class EmulatedSeek final : public EmulatedDevice {
 public:
  /// Says which camera is played and how it misbehaves at the start.
  struct Setup {
    SeekModel model = kSeekCompact;
    bool left_running = false;  ///< It refuses to be woken before it was put to sleep.
    int first_frames_cut = 0;   ///< So many starts come with a first frame without beginning.
  };
  explicit EmulatedSeek(std::string_view script) : EmulatedSeek(script, Setup()) {}
  EmulatedSeek(std::string_view script, Setup setup);

  static constexpr int kNoise = 8;  ///< Counts 0..kNoise-1 are added to the ramp.
  static constexpr std::string_view kChipIdText = "000102030405060708090a0b";

  EmulatedIdentity identity() const override;
  std::optional<std::vector<std::uint8_t>> Control(const UsbControl& control, Bytes data,
                                                   std::size_t read_bytes) override;
  void SetAlternate(int, int) override {}
  EmulatedPacket Isochronous(std::uint8_t, Nanoseconds, std::size_t) override { return {}; }
  std::optional<std::vector<std::uint8_t>> Bulk(std::uint8_t endpoint, Nanoseconds time,
                                                std::size_t most) override;
  std::optional<Unplugged> TakeUnplugged() override;

  /// Say whether it is awake, and how often it was started. Thread-safe.
  bool running() const { return running_; }
  int starts() const { return starts_; }
  /// The opcodes that came since it was plugged in, in order; not thread-safe.
  const std::vector<int>& opcodes() const { return opcodes_; }
  /// Returns whether a detector is dead in all frames.
  static bool IsDead(int x, int y);

 private:
  /// Holds a part of a frame and when it can be read first.
  struct Piece {
    std::vector<std::uint8_t> bytes;
    Nanoseconds not_before{0};
  };
  std::optional<std::vector<std::uint8_t>> Answer(int opcode, Bytes data, std::size_t read_bytes);
  /// Makes what was asked for; false if nothing is due.
  bool Serve(Nanoseconds time);
  std::vector<std::uint8_t> MakeFrame(int id, const FaultStep& step);
  void Send(std::vector<std::uint8_t> frame, const FaultStep& step, Nanoseconds time);

  const Setup setup_;
  FaultScript script_;
  std::atomic<bool> running_;
  std::atomic<int> starts_{0};
  std::vector<int> opcodes_;
  std::deque<int> start_frames_;  ///< Ids that come before the script.
  bool asked_ = false;
  bool stalled_ = false;
  std::optional<Nanoseconds> next_frame_at_;
  std::deque<Piece> pieces_;
  std::size_t sent_ = 0;  ///< Bytes of the first piece that are sent.
  std::optional<Unplugged> unplug_after_;
  std::optional<Unplugged> unplugged_;
  std::vector<std::uint8_t> last_;
  std::uint16_t counter_ = 0;
  std::uint32_t noise_ = 1;
};

}  // namespace isotherm
