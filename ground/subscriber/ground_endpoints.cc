#include "ground/subscriber/ground_endpoints.h"

namespace isotherm {

Status GroundEndpoints::Open(const Participant& participant, StreamRefusals& refusals) {
  self = participant.peer();
  ISOTHERM_RETURN_IF_ERROR(depth.Open(participant, &refusals.depth));
  ISOTHERM_RETURN_IF_ERROR(thermal.Open(participant, &refusals.thermal));
  ISOTHERM_RETURN_IF_ERROR(pieces.Open(participant, &refusals.all));
  ISOTHERM_RETURN_IF_ERROR(backfill_depth.Open(participant, &refusals.depth));
  ISOTHERM_RETURN_IF_ERROR(backfill_thermal.Open(participant, &refusals.thermal));
  ISOTHERM_RETURN_IF_ERROR(external_odometry.Open(participant, &refusals.all));
  ISOTHERM_RETURN_IF_ERROR(rig.Open(participant, &refusals.all));
  ISOTHERM_RETURN_IF_ERROR(status.Open(participant, &refusals.all));
  ISOTHERM_RETURN_IF_ERROR(results.Open(participant, &refusals.all));
  ISOTHERM_RETURN_IF_ERROR(peers.Open(participant, &refusals.all));
  ISOTHERM_RETURN_IF_ERROR(command.Open(participant));
  ISOTHERM_RETURN_IF_ERROR(receipt.Open(participant));
  ISOTHERM_RETURN_IF_ERROR(piece_report.Open(participant));
  ISOTHERM_RETURN_IF_ERROR(feedback.Open(participant));
  ISOTHERM_RETURN_IF_ERROR(hello.Open(participant));
  ISOTHERM_RETURN_IF_ERROR(announced.Open(participant));
  ISOTHERM_RETURN_IF_ERROR(wait_set.Open(participant));
  ISOTHERM_RETURN_IF_ERROR(wait_set.Attach(depth));
  ISOTHERM_RETURN_IF_ERROR(wait_set.Attach(thermal));
  ISOTHERM_RETURN_IF_ERROR(wait_set.Attach(pieces));
  ISOTHERM_RETURN_IF_ERROR(wait_set.Attach(backfill_depth));
  ISOTHERM_RETURN_IF_ERROR(wait_set.Attach(backfill_thermal));
  ISOTHERM_RETURN_IF_ERROR(wait_set.Attach(external_odometry));
  ISOTHERM_RETURN_IF_ERROR(wait_set.Attach(rig));
  ISOTHERM_RETURN_IF_ERROR(wait_set.Attach(status));
  ISOTHERM_RETURN_IF_ERROR(wait_set.Attach(results));
  return wait_set.Attach(peers);
}

}  // namespace isotherm
