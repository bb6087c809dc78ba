#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "common/recording/recording.h"
#include "common/time/clock.h"
#include "edge/source/frame_source.h"

namespace isotherm {

class SourceOptions;

/// Plays a recording: the frames of both sensors and odometry poses, in the order of their
/// stamps in the file.
///
/// Times: device ticks and arrival are those recorded, so that the Timestamper has the same work as
/// live. Frames without a recorded arrival (imported data sets) get ticks and arrival equal to
/// their capture time, rounded down to a microsecond, which makes the Timestamper an identity.
/// Constant delays that the recorder knew (metadata "timing") are added to recorded arrivals: they
/// are already in the stamps, and in them only. With `rebase` in paced playback, all arrivals move
/// by one constant so that the first is now. Each loop continues the time line of the one before.
///
/// Reopening goes on behind the last frame, as a camera does. Thread-bound.
class ReplaySource final : public FrameSource {
 public:
  /// `clock` must outlive the source. `longest_pause` bounds one Read while the next frame is not
  /// due.
  ReplaySource(const SourceOptions& options, std::filesystem::path recording, const Clock& clock,
               Nanoseconds longest_pause = std::chrono::milliseconds(50));

  std::string_view name() const override { return name_; }
  Status Open() override;
  Result<SourceItem> Read(std::stop_token stop) override;
  void Close() override {}
  std::optional<Rig> rig() const override { return rig_; }

 private:
  using PlayedItem = std::variant<RawFrame, ExternalOdometry>;

  Result<std::optional<PlayedItem>> NextItem();
  /// Returns whether the item belongs to the same scan as the first one, by its time.
  bool IsInTime(const RecordedItem& item) const;
  RawFrame ToRawFrame(const RecordedDepth& recorded);
  RawFrame ToRawFrame(const RecordedThermal& recorded);
  RawFrame Prepare(Sensor sensor, const FrameHeader& header, const EncodedImage& image,
                   const std::optional<CaptureTime>& arrival);
  bool StartNextLoop();
  void PlaceInTime(PlayedItem& item);
  SteadyTime DueTime(const PlayedItem& item) const;

  const std::string name_;
  const std::filesystem::path path_;
  const Clock& clock_;
  const double rate_;
  const int loops_;
  const bool rebase_;
  const Nanoseconds longest_pause_;

  std::unique_ptr<RecordingReader> reader_;
  std::optional<Rig> rig_;
  std::array<Nanoseconds, 2> known_delay_{};  ///< Added to recorded arrivals, by Sensor.
  std::optional<NucEvent> last_nuc_event_;
  std::array<std::uint64_t, 2> frames_{};  ///< Delivered so far, by Sensor.
  std::uint64_t unreadable_ = 0;
  std::uint64_t counts_left_out_ = 0;  ///< Thermal frames without temperatures.
  int loops_played_ = 0;

  std::optional<PlayedItem> pending_;         ///< Read ahead, not due yet.
  std::optional<CaptureTime> first_arrival_;  ///< As recorded.
  CaptureTime last_arrival_{};                ///< As recorded, with the loops before.
  Nanoseconds loop_offset_{0};
  Nanoseconds rebase_offset_{0};
  SteadyTime started_at_{};
};

}  // namespace isotherm
