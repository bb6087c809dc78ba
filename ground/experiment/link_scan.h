#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "common/base/status.h"
#include "ground/evaluation/result_evaluation.h"
#include "ground/link_emulator/packet_path.h"

namespace isotherm {

/// A recorded scan with truth, which is carried over a poor link.
struct LinkScanSetup {
  std::filesystem::path recording;
  std::filesystem::path surface;
  std::filesystem::path folder;     ///< For results and logs; made, and emptied before.
  std::string policy = "LOSSLESS";  ///< The edge's link.policy.
  PathProperties to_ground, to_edge;
  bool backfill = true;  ///< The edge sends again what does not arrive.
  bool pieces = true;    ///< The edge's link.expert.pieces.
  double emissivity = 0.96;
  double ambient_celsius = 23.0;
  std::uint64_t seed = 1;
};

/// Holds what came of it.
struct LinkScanOutcome {
  double captured = 0.0;         ///< Frames of both cameras.
  double missing = 0.0;          ///< The ground has not got so many, even in the end.
  double late = 0.0;             ///< So many came from the rig's recording.
  double most_lacking = 0.0;     ///< The largest number of frames that the ground lacked at once.
  double feedback_p50_ms = 0.0;  ///< From a depth frame's capture to its feedback on the edge.
  double feedback_p99_ms = 0.0;
  double sent_mbit_s = 0.0;  ///< By the edge, all packets, on average until the scan was over.
  double scan_s = 0.0;       ///< Until the edge has left: the ground had all that it got.
  EvaluationReport evaluation;
};

/// Has `isotherm-edge` play the recording in real time on one computer of an emulated network, and
/// `isotherm-ground` reconstruct it on the other, as they ship, with the profile for a radio. Takes
/// what EmulatedHost takes. The daemons' times are those of this computer: no two runs are alike.
Result<LinkScanOutcome> RunLinkScan(const LinkScanSetup& setup);

}  // namespace isotherm
