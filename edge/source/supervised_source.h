#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
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
/// A camera with another serial number than the calibration's or the first one's is not used: the
/// calibration is not its own. Nor is one that sends counts where the scan began with temperatures,
/// or the other way round. Reports each frame through `on_frame` before it is checked and each
/// refused one through `on_rejected`. Thread-bound.
class SupervisedSource final : public FrameSource {
 public:
  using FrameCallback = std::function<void(Sensor)>;
  /// True: frames come (again). False: the source failed and waits to be opened again.
  using WorksCallback = std::function<void(bool works)>;
  using OpenedCallback = std::function<void(const CameraDescription&)>;
  /// Says how frames that the camera counted were lost on their way here.
  enum class Loss {
    kLeftOut,   ///< Captured, and left out because the source was not read in time.
    kInCamera,  ///< Only their numbers are missing: lost in the camera or its library.
  };
  using LossCallback = std::function<void(Sensor, Loss, std::uint64_t frames)>;

  /// `clock` must outlive the source. `longest_pause` bounds one Read while waiting.
  SupervisedSource(std::unique_ptr<FrameSource> source, const FrameCheckOptions& options,
                   const Clock& clock, FrameCallback on_frame, FrameCallback on_rejected,
                   Nanoseconds longest_pause = kReadWait);

  std::string_view name() const override { return source_->name(); }
  /// The first opening is not retried by itself: a wrong path or an absent camera at start ends the
  /// program with a sentence.
  Status Open() override;
  /// To be called after an Open that failed, to go on all the same: the source is tried again as if
  /// it had failed later.
  void KeepTrying(const Status& reason);
  Result<SourceItem> Read(std::stop_token stop) override;
  void Close() override;
  /// A source that cannot restart its thermal camera alone is closed and opened again.
  std::optional<Status> Control(const CameraControl& control) override;
  std::vector<ControlAnswer> TakeControlAnswers() override { return source_->TakeControlAnswers(); }
  std::optional<Rig> rig() const override { return source_->rig(); }
  std::vector<CameraDescription> cameras() const override { return source_->cameras(); }

  /// Expected sizes and serial numbers, from a calibration that overrides the source's own.
  void Expect(const Rig& rig);
  /// While idle, frames are read, so that the camera keeps going, and thrown away uncounted.
  /// Numbers start from 0 with the first frame after it.
  void SetIdle(bool idle) { idle_ = idle; }
  void OnWorks(WorksCallback on_works) { on_works_ = std::move(on_works); }
  /// Called for each camera whenever it was opened and is used.
  void OnOpened(OpenedCallback on_opened) { on_opened_ = std::move(on_opened); }
  /// Reports lost frames of sources that number theirs from 0.
  void OnLoss(LossCallback on_loss) { on_loss_ = std::move(on_loss); }
  std::uint64_t reopened() const { return reopened_; }

 private:
  /// Numbers, counts and checks a frame; too many bad ones in a row schedule a reopening.
  SourceItem Handle(RawFrame frame);
  void CountLeftOut();
  /// Counts the numbers that are missing before this one.
  void CountMissing(Sensor sensor, std::uint64_t number);
  SourceItem ReopenWhenDue(const std::stop_token& stop);
  void ScheduleReopen(const Status& reason);
  /// Opens, and refuses a camera that was not calibrated or is not the one from the start.
  Status OpenAndCheckIdentity();
  Status CheckIdentity(const CameraDescription& camera);
  Status CheckSerial(const CameraDescription& camera) const;
  void ReportState(bool works);

  /// A camera, its process or a recording, as edge/daemon/make_source.cc and make_camera.cc say.
  const std::unique_ptr<FrameSource> source_;
  const Clock& clock_;
  const FrameCallback on_frame_;
  const FrameCallback on_rejected_;
  WorksCallback on_works_;
  OpenedCallback on_opened_;
  LossCallback on_loss_;
  std::optional<bool> works_;  ///< As told last.
  std::string failure_;        ///< As logged last; empty while it works.
  const int max_bad_in_a_row_;
  const Nanoseconds retry_min_;
  const Nanoseconds retry_max_;
  const Nanoseconds longest_pause_;
  FrameCheck check_;
  bool sizes_are_calibrated_ = false;
  bool idle_ = false;
  std::array<std::uint64_t, 2> thrown_away_{};  ///< By Sensor: frame numbers before the first.
  std::array<std::uint64_t, 2> expected_numbers_{};
  std::array<std::uint64_t, 2> left_out_{};  ///< Frames whose missing numbers are still to come.
  std::array<std::string, 2> calibrated_serials_;  ///< By Sensor; empty: any.
  std::array<std::string, 2> serials_;  ///< By Sensor, of the cameras from the start; empty: any.
  /// Says whether the thermal camera sends counts only, known from the start; a scan that begins
  /// without a camera takes temperatures.
  std::optional<bool> counts_only_;
  std::array<int, 2> bad_in_a_row_{};  ///< By Sensor: one camera may fail while the other works.
  std::array<bool, 2> is_first_{};  ///< By Sensor: no frame yet since the camera was opened again.
  std::uint64_t reopened_ = 0;
  Nanoseconds next_wait_;
  std::optional<SteadyTime> reopen_at_;  ///< Set while waiting.
};

}  // namespace isotherm
