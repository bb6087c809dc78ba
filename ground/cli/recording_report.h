#pragma once

#include <filesystem>

#include "common/doubts/doubts.h"
#include "ground/cli/recording_summary.h"
#include "ground/json/json.h"

namespace isotherm {

/// Everything that `isotherm inspect` says.
struct RecordingReport {
  std::string file;
  std::uint64_t file_bytes = 0;
  RecordingInfo info;
  RecordingSummary summary;
  std::optional<Rig> rig;
  std::string rig_problem;  ///< Why there is no rig.
  Doubts doubts;            ///< Contents that cannot be right.
};

RecordingReport MakeReport(RecordingReader& reader, const std::filesystem::path& path);

/// Returns whether programs that know only the common schemas show the images.
bool IsViewable(const RecordingSummary& summary);
/// The state of the clock that stamped the frames; empty if the recording does not say.
std::string ClockState(const RecordingInfo& info);

std::string ToText(const RecordingReport& report);
/// In recording_json.cc.
Json ToJson(const RecordingReport& report);

}  // namespace isotherm
