#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "common/base/status.h"
#include "common/simulation/scenes.h"
#include "ground/experiment/measurable_surface.h"
#include "ground/experiment/scripted_operator.h"
#include "ground/options/ground_options.pb.h"

namespace isotherm {

/// Returns the rig of a scan in which somebody moves the cameras and looks at the feedback, so that
/// the next view is not known before. Depth and thermal frames are taken at the same times, twenty
/// times a second, to keep a scan of minutes affordable. The rig knows the detector's time
/// constant, by which smear is assessed; images are rendered sharp, since their temperatures are
/// not looked at.
Rig RigForClosedLoop();

/// Defaults, but for the limits of motion from frame to frame, which mean the same speed as the
/// defaults do at 30 Hz.
GroundOptions OptionsForClosedLoop();

/// Says what an operator is to scan, and how.
struct ClosedLoopSetup {
  const StagedScene& staged;
  const MeasurableSurface& surface;
  OperatorTraits traits;
  Obedience obedience;
  std::vector<Waypoint> path;
  std::uint64_t seed = 1;
  double max_duration_s = 120.0;
};

/// Holds how the scan went.
struct ClosedLoopLog {
  static constexpr double kSampleInterval_s = 30.0;
  static constexpr std::size_t kAdviceKinds = 8;  ///< Number of values of Advice.

  std::optional<double> done_s;  ///< When the feedback first said so, from the first frame.
  double end_s = 0.0;            ///< Done, the path complete, or no time left.
  bool path_complete = false;
  /// The truly measurable surface that is measured well, 0..1, every kSampleInterval_s; the last
  /// one is repeated by At().
  std::vector<double> measured_well;
  double measured_well_at_end = 0.0;
  double way_m = 0.0;  ///< Length of the rig's path.
  int depth_frames = 0, lost_frames = 0;
  int blocked_frames = 0;                  ///< The rig was nearer to something than a hand is wide.
  std::array<int, kAdviceKinds> advice{};  ///< Messages that say each.
  int messages = 0;

  double At(std::size_t sample) const {
    return sample < measured_well.size() ? measured_well[sample] : measured_well_at_end;
  }
};

/// Lets a scripted operator scan until the feedback says "done", a fixed path is complete or the
/// time is up. Runs on the calling thread only. The same each time.
Result<ClosedLoopLog> RunClosedLoop(const ClosedLoopSetup& setup);

}  // namespace isotherm
