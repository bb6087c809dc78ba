#include "ground/fetch/recording_way.h"

#include <utility>

#include "common/transport/endpoints.h"
#include "common/transport/poll_interval.h"
#include "common/transport/wait_set.h"

namespace isotherm {
namespace {

/// A second. Not tuned.
constexpr int kMatchPolls = 50;

class LinkRecordingWay final : public RecordingWay {
 public:
  explicit LinkRecordingWay(std::string edge_id) : edge_id_(std::move(edge_id)) {}

  Status Open(const Participant& participant) {
    ISOTHERM_RETURN_IF_ERROR(pieces_.Open(participant, &refusals_));
    ISOTHERM_RETURN_IF_ERROR(requests_.Open(participant));
    ISOTHERM_RETURN_IF_ERROR(wait_set_.Open(participant));
    return wait_set_.Attach(pieces_);
  }
  Status Ask(const RecordingRequest& request) override {
    // What is written before the rig's reader is known gets lost.
    for (int i = 0; requests_.matched_readers() == 0 && i < kMatchPolls; ++i)
      wait_set_.Wait(kPollInterval);
    return requests_.Write(edge_id_, request);
  }
  std::vector<RecordingPiece> Await(Nanoseconds timeout) override {
    wait_set_.Wait(timeout);
    std::vector<RecordingPiece> pieces;
    pieces_.Take([&](Received<RecordingPiece>&& received) {
      if (received.edge_id == edge_id_) pieces.push_back(std::move(received.message));
    });
    return pieces;
  }

 private:
  const std::string edge_id_;
  RefusalCounter refusals_;
  Reader<RecordingPiece> pieces_;
  Writer<RecordingRequest> requests_;
  WaitSet wait_set_;
};

}  // namespace

Result<std::unique_ptr<RecordingWay>> OpenRecordingWay(const Participant& participant,
                                                       std::string edge_id) {
  auto way = std::make_unique<LinkRecordingWay>(std::move(edge_id));
  if (Status opened = way->Open(participant); !opened.ok()) return Err(std::move(opened));
  return way;
}

}  // namespace isotherm
