#include "edge/recording_server/recording_server.h"

#include <algorithm>
#include <utility>

#include "common/base/log.h"
#include "common/base/pause.h"
#include "common/base/processor_time.h"
#include "common/transport/poll_interval.h"

namespace isotherm {
namespace {

/// Requests that are taken before the rest is looked after. Not tuned.
constexpr int kRequestsPerRound = 8;
/// A checksum costs the disk what reading costs, and the link nothing. Not tuned.
constexpr double kChecksumCost = 0.1;
/// Any request costs this much at least: whoever asks again and again keeps the rig from nothing.
constexpr double kMinCost_bytes = 16'384.0;
/// Cameras, disk and link go first.
constexpr int kNiceness = 5;

}  // namespace

RecordingServer::RecordingServer(RecordingServerOptions options, const ServedState& state)
    : options_(std::move(options)), state_(state), shelf_(options_.record) {}

Result<std::unique_ptr<RecordingServer>> RecordingServer::Start(const Participant& participant,
                                                                RecordingServerOptions options,
                                                                const ServedState& state) {
  std::unique_ptr<RecordingServer> server(new RecordingServer(std::move(options), state));
  if (Status opened = server->Open(participant); !opened.ok()) return Err(std::move(opened));
  server->thread_ =
      std::jthread([self = server.get()](const std::stop_token& stop) { self->Run(stop); });
  return server;
}

Status RecordingServer::Open(const Participant& participant) {
  ISOTHERM_RETURN_IF_ERROR(requests_.Open(participant, &refusals_));
  ISOTHERM_RETURN_IF_ERROR(pieces_.Open(participant));
  ISOTHERM_RETURN_IF_ERROR(wait_set_.Open(participant));
  return wait_set_.Attach(requests_);
}

void RecordingServer::Run(const std::stop_token& stop) {
  NameThread("recordings");
  LowerThreadPriority(kNiceness);
  while (!stop.stop_requested()) {
    wait_set_.Wait(kPollInterval);
    requests_.Take(
        [this, &stop](Received<RecordingRequest>&& received) {
          if (received.edge_id == options_.edge_id) Serve(received.message, stop);
        },
        kRequestsPerRound);
  }
}

void RecordingServer::Serve(const RecordingRequest& request, const std::stop_token& stop) {
  if (stop.stop_requested()) return;
  const bool is_read = request.kind == RecordingRequestKind::kRead ||
                       request.kind == RecordingRequestKind::kChecksum;
  RecordingPiece piece{.asker = request.asker,
                       .number = request.number,
                       .outcome = RecordingOutcome::kBusy,
                       .recording = request.recording,
                       .offset = request.offset};
  // What is completed is changed by that: its size in the list would be wrong.
  const bool is_busy = state_.is_completing || (is_read && state_.is_scanning);
  if (!is_busy) piece = shelf_.Answer(request);
  // What does not arrive is asked for again.
  if (const Status written = pieces_.Write(options_.edge_id, piece); !written.ok()) {
    LOG(Recordings, Debug) << "a piece of a recording is not sent: " << written.message();
  }
  const bool is_checksum = request.kind == RecordingRequestKind::kChecksum;
  const double cost_bytes = !is_read || is_busy ? 0.0
                            : is_checksum       ? kChecksumCost * request.length
                                                : request.length;
  Pause(stop, FromSeconds(std::max(cost_bytes, kMinCost_bytes) / options_.bytes_per_s));
}

}  // namespace isotherm
