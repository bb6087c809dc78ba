#include "edge/spool/kept_part.h"

#include "edge/spool/recording_metadata.h"

namespace isotherm {
namespace {

constexpr std::array kFramesKeys = {"depth_frames", "thermal_frames"};
constexpr std::array kNextKeys = {"next_depth_frame", "next_thermal_frame"};

}  // namespace

std::map<std::string, std::string> ToMetadata(const RecordedBefore& before) {
  std::map<std::string, std::string> values;
  for (std::size_t i = 0; i < before.size(); ++i) {
    values[kFramesKeys.at(i)] = std::to_string(before.at(i).frames);
    values[kNextKeys.at(i)] = std::to_string(before.at(i).next);
  }
  return values;
}

std::optional<RecordedBefore> ReadRecordedBefore(const RecordingInfo& info) {
  RecordedBefore before;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const auto frames = MetadataNumber(info, kBeforeMetadata, kFramesKeys.at(i));
    const auto next = MetadataNumber(info, kBeforeMetadata, kNextKeys.at(i));
    if (!frames || !next || *frames > *next || *next > kMaxFrameNumber) return std::nullopt;
    before.at(i) = {*frames, *next};
  }
  return before;
}

}  // namespace isotherm
