#pragma once

#include "common/base/status.h"
#include "common/frame/frame.h"
#include "common/messages/frame_piece.h"
#include "common/messages/messages.h"
#include "common/transport/announced_peers.h"
#include "common/transport/endpoints.h"
#include "common/transport/participant.h"
#include "common/transport/refusal.h"
#include "common/transport/wait_set.h"

namespace isotherm {

/// Holds an edge's ends of all topics, and the wait set that wakes for each reader.
struct EdgeEndpoints {
  /// `refusals`, which must outlive the readers, gets the samples that cannot be decoded.
  Status Open(const Participant& participant, RefusalCounter& refusals);

  Writer<EncodedDepthFrame> depth;
  Writer<EncodedThermalFrame> thermal;
  Writer<FramePiece> pieces;
  Writer<Backfilled<EncodedDepthFrame>> backfill_depth;
  Writer<Backfilled<EncodedThermalFrame>> backfill_thermal;
  Writer<ExternalOdometrySample> external_odometry;
  Writer<RigDescription> rig;
  Writer<EdgeStatus> status;
  Writer<CommandResult> result;
  Writer<Hello> hello;
  Reader<Command> commands;
  Reader<Receipt> receipts;
  Reader<PieceReport> piece_reports;
  Reader<Feedback> feedback;
  Reader<Hello> peers;
  AnnouncedPeers announced;
  WaitSet wait_set;
};

}  // namespace isotherm
