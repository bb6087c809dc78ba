#pragma once

#include <filesystem>
#include <future>
#include <memory>
#include <variant>

#include "common/base/status.h"
#include "common/concurrency/bounded_queue.h"
#include "common/recording/recording.h"
#include "common/transport/messages.h"
#include "ground/subscriber/received_frame.h"
#include "ground/subscriber/session_account.h"

namespace isotherm {

/// What became of a session's recording.
struct RecordingOutcome {
  RecordingStats stats;
  Status status;
};

/// A new session: both consumers get the same folder; the reconstruction learns what was recorded.
struct SessionStart {
  RigDescription rig;
  std::filesystem::path folder;
  std::shared_ptr<std::promise<RecordingOutcome>> recording_promise;
  std::shared_future<RecordingOutcome> recording;
};

using Item = std::variant<SessionStart, ReceivedDepth, ReceivedThermal, OutsidePoseSample,
                          SessionAccount, Feedback, ClockAccount>;
using ItemQueue = BoundedQueue<Item>;

inline bool IsFrame(const Item& item) {
  return std::holds_alternative<ReceivedDepth>(item) ||
         std::holds_alternative<ReceivedThermal>(item);
}

}  // namespace isotherm
