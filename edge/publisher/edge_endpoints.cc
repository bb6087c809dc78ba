#include "edge/publisher/edge_endpoints.h"

namespace isotherm {

Status EdgeEndpoints::Open(const Participant& participant, RefusalCounter& refusals) {
  ISOTHERM_RETURN_IF_ERROR(depth.Open(participant));
  ISOTHERM_RETURN_IF_ERROR(thermal.Open(participant));
  ISOTHERM_RETURN_IF_ERROR(pieces.Open(participant));
  ISOTHERM_RETURN_IF_ERROR(backfill_depth.Open(participant));
  ISOTHERM_RETURN_IF_ERROR(backfill_thermal.Open(participant));
  ISOTHERM_RETURN_IF_ERROR(external_odometry.Open(participant));
  ISOTHERM_RETURN_IF_ERROR(rig.Open(participant));
  ISOTHERM_RETURN_IF_ERROR(status.Open(participant));
  ISOTHERM_RETURN_IF_ERROR(result.Open(participant));
  ISOTHERM_RETURN_IF_ERROR(hello.Open(participant));
  ISOTHERM_RETURN_IF_ERROR(commands.Open(participant, &refusals));
  ISOTHERM_RETURN_IF_ERROR(receipts.Open(participant, &refusals));
  ISOTHERM_RETURN_IF_ERROR(piece_reports.Open(participant, &refusals));
  ISOTHERM_RETURN_IF_ERROR(feedback.Open(participant, &refusals));
  ISOTHERM_RETURN_IF_ERROR(peers.Open(participant, &refusals));
  ISOTHERM_RETURN_IF_ERROR(announced.Open(participant));
  ISOTHERM_RETURN_IF_ERROR(wait_set.Open(participant));
  ISOTHERM_RETURN_IF_ERROR(wait_set.Attach(commands));
  ISOTHERM_RETURN_IF_ERROR(wait_set.Attach(receipts));
  ISOTHERM_RETURN_IF_ERROR(wait_set.Attach(piece_reports));
  ISOTHERM_RETURN_IF_ERROR(wait_set.Attach(feedback));
  return wait_set.Attach(peers);
}

}  // namespace isotherm
