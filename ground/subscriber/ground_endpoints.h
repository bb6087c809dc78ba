#pragma once

#include "common/base/status.h"
#include "common/frame/frame.h"
#include "common/messages/frame_piece.h"
#include "common/messages/messages.h"
#include "common/transport/announced_peers.h"
#include "common/transport/endpoints.h"
#include "common/transport/participant.h"
#include "common/transport/wait_set.h"
#include "ground/subscriber/stream_refusals.h"

namespace isotherm {

/// Holds a ground station's ends of all topics, and the wait set that wakes for each reader.
struct GroundEndpoints {
  /// `refusals`, which must outlive the readers, get the samples that cannot be decoded.
  Status Open(const Participant& participant, StreamRefusals& refusals);

  PeerHandle self = 0;  ///< As the rig knows this ground.
  Reader<EncodedDepthFrame> depth;
  Reader<EncodedThermalFrame> thermal;
  Reader<FramePiece> pieces;
  Reader<Backfilled<EncodedDepthFrame>> backfill_depth;
  Reader<Backfilled<EncodedThermalFrame>> backfill_thermal;
  Reader<ExternalOdometrySample> external_odometry;
  Reader<RigDescription> rig;
  Reader<EdgeStatus> status;
  Reader<CommandResult> results;
  Reader<Hello> peers;
  Writer<Command> command;
  Writer<Receipt> receipt;
  Writer<PieceReport> piece_report;
  Writer<Feedback> feedback;
  Writer<Hello> hello;
  AnnouncedPeers announced;
  WaitSet wait_set;
};

}  // namespace isotherm
