#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/messages/messages.h"
#include "common/rig/rig.h"
#include "common/time/kernel_clock.h"
#include "common/time/time_types.h"
#include "edge/source/frame_source.h"
#include "edge/spool/recording_files.h"

namespace isotherm {

class EdgeOptions;

/// Returns the rig as it is published and recorded: capture times already contain the thermal
/// delay, and the thermal scale is that of the frames.
std::optional<Rig> AsPublished(std::optional<Rig> rig, const FrameSource& source);
/// Gives the rig the scale that the frames of its thermal camera have.
void TakeScale(const RadiometricScale& scale, Rig& rig);

/// Returns a number that no other scan has, of this rig or another one: by chance, since clocks of
/// two rigs may say the same, and one that was set back repeats itself. Never 0.
std::uint64_t NewSession();

/// Holds what was found out before anything starts.
struct EdgeSession {
  CaptureTime time;
  std::vector<CameraDescription> cameras;
  std::optional<Rig> rig;            ///< As published and recorded.
  double rig_thermal_delay_s = 0.0;  ///< As calibrated.
  KernelClock clock{};
  std::uint64_t resumed_session = 0;  ///< It goes on from a process before; 0: a new one.
  std::array<std::uint64_t, 2> first_numbers{};  ///< The next frames', by Sensor.
  std::uint64_t new_session = NewSession();

  /// One per start of a scan.
  std::uint64_t session() const { return resumed_session != 0 ? resumed_session : new_session; }
};

/// Returns what the link says of the session.
RigDescription DescribeRig(const EdgeOptions& options, const EdgeSession& start);
/// Returns what a recording says of the cameras.
std::map<std::string, std::string> CameraMetadata(const std::vector<CameraDescription>& cameras);
/// Returns what the recording says of the session.
RecordingDescription::Metadata RecordingMetadata(const EdgeOptions& options,
                                                 const EdgeSession& start);

}  // namespace isotherm
