#include "ground/service/health.h"

#include <fmt/format.h>

namespace isotherm {

std::optional<std::string> Health::Problem(SteadyTime now) const {
  struct Assessed {
    const char* what;
    const ThreadProgress& thread;
    Nanoseconds limit;
  };
  for (const auto& [what, thread, limit] :
       {Assessed{"reception", receive, kFrameLimit},
        Assessed{"the reconstruction", reconstruction, kFrameLimit},
        Assessed{"reading the earlier recording (is the disk stuck?)", reading, disk_limit_},
        Assessed{"the recording (is the disk stuck?)", recording, disk_limit_},
        Assessed{"writing results (is the disk stuck?)", results, disk_limit_}}) {
    const Nanoseconds at_it = thread.AtItFor(now);
    if (at_it > limit)
      return fmt::format("{} has not gone on for {:.0f} s", what, ToSeconds(at_it));
  }
  return std::nullopt;
}

std::optional<GroundThread> Health::StuckBeforeEnd(GroundThread awaited, SteadyTime now) const {
  // The longest step of writing results is the surface of a large model. Somebody waits for the
  // end.
  constexpr Nanoseconds kLimit = std::chrono::seconds(30);
  // One step of the recording writes a message or its last chunk; a disk that takes longer hangs.
  constexpr Nanoseconds kRecordingLimit = std::chrono::milliseconds(1500);
  const auto is_stuck = [&](const ThreadProgress& thread, Nanoseconds limit) {
    return thread.AtItFor(now) > limit;
  };
  bool stuck = false;
  switch (awaited) {
    case GroundThread::kReception:
      stuck = is_stuck(receive, kLimit);
      break;
    case GroundThread::kReconstruction:
      // Idle: it waits until there is room for its last scan.
      if (reconstruction.AtItFor(now) == Nanoseconds(0) && is_stuck(results, kLimit))
        return GroundThread::kResults;
      stuck = is_stuck(reconstruction, kLimit) || is_stuck(reading, kLimit);
      break;
    case GroundThread::kResults:
      stuck = is_stuck(results, kLimit);
      break;
    case GroundThread::kRecording:
      stuck = is_stuck(recording, kRecordingLimit);
      break;
  }
  return stuck ? std::optional(awaited) : std::nullopt;
}

}  // namespace isotherm
