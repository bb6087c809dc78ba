#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <limits>
#include <optional>

#include "common/base/mutex.h"
#include "common/base/stage_stats.h"
#include "common/frame/frame.h"
#include "common/messages/messages.h"
#include "common/stamping/stamp.h"
#include "common/time/time_types.h"
#include "edge/source/frame_source.h"

namespace isotherm {

/// Knows how the cameras are: their threads and the capture thread write it, the status reads it.
/// Thread-safe.
class CameraHealth {
 public:
  /// Frames come, or the camera failed.
  void SetWorks(Sensor sensor, bool works);
  /// The image shows (almost) nothing.
  void SetBlind(Sensor sensor, bool blind) { At(sensor).blind = blind; }
  /// Enters how long a frame took from its arrival to its capture time.
  void AddStamping(Sensor sensor, Nanoseconds latency);
  /// Takes note of a frame's stamp.
  void NoteStamp(Sensor sensor, const Stamp& stamp);

  /// Takes note of what a camera says of itself, each time that it is opened.
  void SetOpened(const CameraDescription& camera);

  CameraReport Get(Sensor sensor) const;
  /// The camera as it was opened last; nullopt if it never was.
  std::optional<CameraDescription> opened(Sensor sensor) const;

 private:
  /// Collects what the threads of one camera report; the thread that writes the status reads it.
  struct Entry {
    std::atomic<CameraState> state{CameraState::kNone};  ///< But for kBlind.
    std::atomic<bool> blind{false};
    std::atomic<std::uint32_t> failures{0};
    mutable Mutex mutex;
    std::optional<CameraDescription> opened GUARDED_BY(mutex);
    StageStats stamping_ms GUARDED_BY(mutex);
    double stamp_sigma_s GUARDED_BY(mutex) = std::numeric_limits<double>::quiet_NaN();
    std::uint64_t unsynchronised_frames GUARDED_BY(mutex) = 0;
  };
  Entry& At(Sensor sensor) { return entries_[static_cast<std::size_t>(sensor)]; }

  std::array<Entry, 2> entries_;
};

}  // namespace isotherm
