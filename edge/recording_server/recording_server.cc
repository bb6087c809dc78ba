#include "edge/recording_server/recording_server.h"

#include <utility>

#include "common/base/log.h"
#include "common/base/pause.h"
#include "common/base/processor_time.h"
#include "common/transport/poll_interval.h"

namespace isotherm {
namespace {

/// Requests that are taken before the rest is looked after.
constexpr int kRequestsPerRound = 8;
/// A checksum costs the disk what reading costs, and the link nothing.
constexpr double kChecksumCost = 0.1;

}  // namespace

RecordingServer::RecordingServer(RecordingServerOptions options,
                                 const std::atomic<bool>& is_scanning)
    : options_(std::move(options)), is_scanning_(is_scanning), shelf_(options_.record) {}

Result<std::unique_ptr<RecordingServer>> RecordingServer::Start(
    const Participant& participant, RecordingServerOptions options,
    const std::atomic<bool>& is_scanning) {
  std::unique_ptr<RecordingServer> server(new RecordingServer(std::move(options), is_scanning));
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
  const bool is_read = request.kind != RecordingRequestKind::kList;
  RecordingPiece piece{.asker = request.asker,
                       .number = request.number,
                       .outcome = RecordingOutcome::kBusy,
                       .recording = request.recording,
                       .offset = request.offset};
  if (!is_read || !is_scanning_) piece = shelf_.Answer(request);
  // What does not arrive is asked for again.
  if (const Status written = pieces_.Write(options_.edge_id, piece); !written.ok()) {
    LOG(Recordings, Debug) << "a piece of a recording is not sent: " << written.message();
  }
  if (!is_read || piece.outcome != RecordingOutcome::kDone) return;
  const double cost =
      request.length * (request.kind == RecordingRequestKind::kChecksum ? kChecksumCost : 1.0);
  Pause(stop, FromSeconds(cost / options_.bytes_per_s));
}

}  // namespace isotherm
