#pragma once

#include <map>
#include <optional>

#include "common/messages/messages.h"
#include "ground/feedback/advice.h"
#include "ground/feedback/scan_coverage.h"
#include "ground/feedback/view_planner.h"
#include "ground/options/ground_options.pb.h"
#include "ground/renderer/view_maps.h"
#include "ground/scan/depth_report.h"
#include "ground/scan/scan_model.h"

namespace isotherm {

/// Holds what a message of feedback is about.
struct FeedbackMoment {
  FrameHeader header;  ///< The newest depth frame's.
  DepthReport report;  ///< The pipeline's report on it.
  bool nuc_running = false;
  /// Say how the rig moved since the message before, and the time between two frames.
  double speed_m_s = 0.0;
  double rotation_rate_deg_s = 0.0;
  double frame_interval_s = 0.0;
  bool ground_is_behind = false;
  bool link_is_narrow = false;  ///< Frames are left for later, because it does not carry all.
};

/// Puts the feedback on a scan together from the model. What would take long is done a part at a
/// time after each message (ThinkAhead). Thread-bound.
class FeedbackMaker {
 public:
  FeedbackMaker(const GroundOptions& options, const RigDescription& rig);

  Feedback Make(const FeedbackMoment& moment, const ScanModel& scan);
  /// Goes on with the coverage of the whole model and with the search for the next view.
  void ThinkAhead(const ScanModel& scan);

  /// Surface that several sub-maps share counts once (ScanCoverage).
  SurfaceAreas areas() const { return coverage_.areas(); }
  /// Enough of the whole surface is measured well.
  bool done() const { return adviser_.done(); }
  std::uint64_t messages() const { return messages_; }

 private:
  /// The model as the depth camera saw it last, with what the thermal camera makes of it while the
  /// rig moves as it does.
  CoverageSummary LookAtView(const ScanModel& scan);
  /// The smear of each pixel of that view if it were measured now; empty while the motion is not
  /// known.
  Image<float> Smear(const ScanModel& scan) const;
  ScanSituation Situation(const FeedbackMoment& moment) const;
  /// Notes whether the rig came nearer to the next view since the message before. A track that is
  /// lost on the way there, or there, gives the view up.
  void NoteWay(const FeedbackMoment& moment, const ScanModel& scan);
  void AddNextPose(const DepthReport& report, const ScanModel& scan, Feedback& feedback) const;
  /// Returns the planner of the active sub-map, which works in its coordinates; nullptr without a
  /// calibrated thermal camera.
  ViewPlanner* Planner(const ScanModel& scan);
  /// Takes that the rig has looked from the next view, in turns, from which another sub-map was
  /// scanned. `planner` is that of the active one.
  void NoteViewElsewhere(const Atlas& atlas, ViewPlanner& planner);
  /// Returns the surface that no view was found for, in all sub-maps, square metres.
  double OutOfReach() const;
  /// Returns the surface that may be where nobody looked yet, square metres: in the sub-map where
  /// most of it may be.
  double Unseen() const;

  const GroundOptions options_;
  const Rig rig_;
  const std::uint64_t session_;
  const RigidTransform T_depth_thermal_;
  const ThermalOptions limits_;  ///< CompleteLimits of this rig.
  OperatorAdviser adviser_;
  ScanCoverage coverage_;
  std::map<int, ViewPlanner> planners_;  ///< By sub-map. None without a calibrated thermal camera.
  /// The sub-map and view that NoteViewElsewhere() takes next.
  struct {
    int map = 0;
    std::size_t view = 0;
  } next_view_elsewhere_;
  SurfaceMaps maps_;  ///< Every n-th pixel of the model's view.
  ViewMaps view_;
  /// How far the next view was with the last message, in seconds of walking, and until when the rig
  /// counts as on the way to it; nullopt if it was lost, or there was none.
  std::optional<double> way_s_;
  std::optional<CaptureTime> way_noted_at_, on_the_way_until_;
  bool is_on_the_way_ = false;
  bool is_measuring_ = false;  ///< With the last message: views can be gone to and measured.
  CaptureTime last_known_{};   ///< With the last message, in whatever sub-map.
  std::uint64_t messages_ = 0;
};

}  // namespace isotherm
