#pragma once

#include <filesystem>
#include <memory>
#include <variant>
#include <vector>

#include "common/concurrency/bounded_queue.h"
#include "common/messages/messages.h"
#include "ground/service/folder_lock.h"
#include "ground/service/recording_tracker.h"
#include "ground/subscriber/received_frame.h"
#include "ground/subscriber/session_counters.h"

namespace isotherm {

/// A new session: both consumers get the same folder and the counters of what is recorded.
struct SessionStart {
  RigDescription rig;
  std::filesystem::path folder;
  // As ScanFolder says.
  std::vector<std::filesystem::path> earlier_files;
  std::shared_ptr<FolderLock> lock;
  bool is_complete = false;
  std::shared_ptr<RecordingTracker> recording;
};

/// An item on the line from the link to reconstruction and recording. A RigDescription describes
/// the session's rig anew: a camera came late.
using SessionItem =
    std::variant<SessionStart, RigDescription, ReceivedDepth, ReceivedThermal,
                 ExternalOdometrySample, SessionCounters, Feedback, SessionClock, SessionMark>;
using SessionQueue = BoundedQueue<SessionItem>;

inline bool IsFrame(const SessionItem& item) {
  return std::holds_alternative<ReceivedDepth>(item) ||
         std::holds_alternative<ReceivedThermal>(item);
}

}  // namespace isotherm
