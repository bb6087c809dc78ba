#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "common/time/clock.h"
#include "edge/source/frame_check.h"
#include "edge/source/frame_source.h"

namespace isotherm {

class FrameCheckOptions;

/// Keeps a source running: drops bad frames, and closes and opens the source again when it fails or
/// delivers too many bad frames in a row, with a wait that doubles up to a limit. The one place
/// with retries.
///
///   open --(failure, too many bad frames)--> waiting --(wait over, Open succeeds)--> open
///
/// Reports each frame through `on_frame` before it is judged and each refused one through
/// `on_rejected`. Thread-bound.
class SupervisedSource final : public FrameSource {
 public:
  using FrameCallback = std::function<void(Sensor)>;

  /// `clock` must outlive the source. `longest_pause` bounds one Read while waiting.
  SupervisedSource(std::unique_ptr<FrameSource> source, const FrameCheckOptions& options,
                   const Clock& clock, FrameCallback on_frame, FrameCallback on_rejected,
                   Nanoseconds longest_pause = std::chrono::milliseconds(50));

  std::string_view name() const override { return source_->name(); }
  /// The first opening is not retried: a wrong path or an absent camera at start ends the program
  /// with a sentence.
  Status Open() override;
  Result<SourceItem> Read(std::stop_token stop) override;
  void Close() override { source_->Close(); }
  Status Control(const CameraControl& control) override { return source_->Control(control); }
  std::optional<Rig> rig() const override { return source_->rig(); }
  std::vector<CameraDescription> cameras() const override { return source_->cameras(); }

  /// Expected sizes, from a calibration that overrides the source's own.
  void Expect(const Rig& rig) { check_.Expect(rig); }
  std::uint64_t reopened() const { return reopened_; }

 private:
  SourceItem Judge(RawFrame frame);
  SourceItem ReopenWhenDue(const std::stop_token& stop);
  void ScheduleReopen(const Status& reason);

  const std::unique_ptr<FrameSource> source_;
  const Clock& clock_;
  const FrameCallback on_frame_;
  const FrameCallback on_rejected_;
  const int max_bad_in_a_row_;
  const Nanoseconds retry_min_;
  const Nanoseconds retry_max_;
  const Nanoseconds longest_pause_;
  FrameCheck check_;
  std::array<int, 2> bad_in_a_row_{};  ///< By Sensor: one camera may fail while the other works.
  std::uint64_t reopened_ = 0;
  Nanoseconds next_wait_;
  std::optional<SteadyTime> reopen_at_;  ///< Set while waiting.
};

}  // namespace isotherm
