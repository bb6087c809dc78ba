#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include "common/frame/frame.h"
#include "common/messages/frame_piece.h"
#include "common/time/time_types.h"

namespace isotherm {

/// Decides how fast pieces are sent, and which frames are sent at all while they are new. A link
/// that is too narrow shows by pieces that wait before it, long before any are lost: then the rate
/// is lowered, to what arrives if that is less; while none wait, it is raised. Of the cameras'
/// frames as many are taken as the rate has room for: every one, every second depth frame, and so
/// on to every sixteenth of both. Where nothing is heard of what was sent, a frame now and then.
/// What is left comes from the recording. Pure: time enters through arguments. Thread-compatible.
class PiecePace {
 public:
  /// Pieces that wait longer than this before a link have filled it. More than a radio varies by
  /// for several of them, less than buffers hold. Not tuned.
  static constexpr Nanoseconds kFullQueue = std::chrono::milliseconds(50);
  /// After this long without a report nothing arrives any more.
  static constexpr Nanoseconds kSilence = std::chrono::milliseconds(900);
  /// A frame that is sent all the same.
  static constexpr Nanoseconds kProbeInterval = std::chrono::milliseconds(500);
  static constexpr double kFirstRate_bit_s = 10e6;
  static constexpr double kMinRate_bit_s = 1e6;
  static constexpr double kMaxRate_bit_s = 200e6;

  void BeginSession() { *this = PiecePace(); }

  /// Says whether the next frame of a stream is to be sent, rather than left for later; so many
  /// newer frames wait behind it.
  bool TakesNext(Sensor sensor, std::size_t newer, SteadyTime now);
  /// Enters that a frame was sent: in so many pieces of so many bytes, parity and what the network
  /// adds included.
  void OnSent(Sensor sensor, std::size_t pieces, std::size_t piece_bytes, SteadyTime now);
  /// The next report is another ground's.
  void ForgetReports() { had_.clear(); }
  /// Enters what the ground has.
  void OnReport(const PieceReport& report, SteadyTime now);

  /// Pieces are sent at this rate, evenly.
  double rate_bit_s() const { return rate_bit_s_; }
  /// Returns of how many frames of the stream one is sent.
  int stride(Sensor sensor) const { return kSteps.at(step_).at(static_cast<std::size_t>(sensor)); }
  /// Returns whether frames are left, if it is asked at all.
  bool leaves_frames() const { return step_ > 0; }

 private:
  /// By step and Sensor. Depth first: geometry is seen from many views, and the thermal camera has
  /// fewer pixels.
  static constexpr std::array<std::array<int, 2>, 10> kSteps = {
      {{1, 1}, {2, 1}, {2, 2}, {3, 3}, {4, 4}, {6, 6}, {8, 8}, {10, 10}, {12, 12}, {16, 16}}};

  /// Pieces, as a report says.
  struct Had {
    SteadyTime time;
    std::uint64_t received, sent;
  };
  /// One stream, as it comes from the camera.
  struct Stream {
    SteadyTime counted_since{};
    int frames = 0;        ///< Since then.
    double rate_hz = 0.0;  ///< 0: not known.
    double bits = 0.0;     ///< A frame's with its parity, smoothed. 0: not known.
    int waiting = 0;       ///< Frames since one was sent, with the next one.
    SteadyTime sent_at{};
  };

  Stream& Of(Sensor sensor) { return streams_.at(static_cast<std::size_t>(sensor)); }
  static void Count(Stream* stream, SteadyTime now);
  /// Returns what both streams take at a step, bit/s.
  double LoadAt(std::size_t step, SteadyTime now) const;
  void ChooseStep(SteadyTime now);
  /// Returns what of pieces counted by `count` there was in the newest fraction of a second, bit/s.
  double RateOf(std::uint64_t Had::*count) const;
  void Lower(SteadyTime now);
  bool IsSilent(SteadyTime now) const;

  std::array<Stream, 2> streams_;  ///< By Sensor.
  std::size_t step_ = 0;
  double rate_bit_s_ = kFirstRate_bit_s;
  bool was_full_ = false;  ///< Ever: until then the rate is raised quickly.
  SteadyTime lowered_at_{};
  double piece_bits_ = 0.0;  ///< Smoothed. 0: not known.
  std::deque<Had> had_;      ///< In the newest fraction of a second.
  std::optional<SteadyTime> report_at_;
  std::optional<SteadyTime> sent_since_;  ///< The first frame that was sent after that.
};

}  // namespace isotherm
