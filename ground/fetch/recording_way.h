#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/base/status.h"
#include "common/messages/recording_transfer.h"
#include "common/time/time_types.h"
#include "common/transport/participant.h"

namespace isotherm {

/// The way to a rig that answers about its recordings. Answers may come late, twice or never.
/// Thread-compatible.
class RecordingWay {
 public:
  virtual ~RecordingWay() = default;
  virtual Status Ask(const RecordingRequest& request) = 0;
  /// Returns what has arrived, after no longer than `timeout`.
  virtual std::vector<RecordingPiece> Await(Nanoseconds timeout) = 0;
};

/// Opens the way to the rig `edge_id` over the link. `participant` must outlive it.
Result<std::unique_ptr<RecordingWay>> OpenRecordingWay(const Participant& participant,
                                                       std::string edge_id);

}  // namespace isotherm
