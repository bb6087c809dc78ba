#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <stop_token>
#include <string>
#include <thread>

#include "common/base/status.h"
#include "common/messages/recording_transfer.h"
#include "common/transport/endpoints.h"
#include "common/transport/participant.h"
#include "common/transport/wait_set.h"
#include "edge/recording_server/recording_shelf.h"

namespace isotherm {

/// Says what a server serves, and how fast.
struct RecordingServerOptions {
  std::string edge_id;
  std::filesystem::path record;  ///< As spool.record.
  double bytes_per_s = 8e6;
};

/// Tells what an edge is at, for who serves its recordings. Thread-safe.
struct ServedState {
  std::atomic<bool> is_scanning{false};
  std::atomic<bool> is_completing{false};  ///< Recordings that break off get their index.
};

/// Gives an edge's recordings to whoever asks over the link, while no scan is under way: a scan has
/// link and disk for itself. Answers on a thread of its own, from its construction on. Nothing of
/// it is called by others.
class RecordingServer {
 public:
  /// `participant` and `state` must outlive it.
  static Result<std::unique_ptr<RecordingServer>> Start(const Participant& participant,
                                                        RecordingServerOptions options,
                                                        const ServedState& state);

 private:
  RecordingServer(RecordingServerOptions options, const ServedState& state);
  Status Open(const Participant& participant);
  void Run(const std::stop_token& stop);
  void Serve(const RecordingRequest& request, const std::stop_token& stop);

  const RecordingServerOptions options_;
  const ServedState& state_;
  RecordingShelf shelf_;
  RefusalCounter refusals_;
  Reader<RecordingRequest> requests_;
  Writer<RecordingPiece> pieces_;
  WaitSet wait_set_;
  std::jthread thread_;
};

}  // namespace isotherm
