#include "ground/radiometric_calibration/recorded_thermal.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "common/codec/codec.h"
#include "common/recording/recording.h"

namespace isotherm {
namespace {

/// The camera of a recording has to be that of the calibration, or of the recordings before.
Status TakeRig(Result<Rig> recorded, std::optional<Rig>& rig) {
  if (!recorded) return OkStatus();
  if (!rig) {
    rig = std::move(*recorded);
    return OkStatus();
  }
  const std::string &found = recorded->thermal_serial, &expected = rig->thermal_serial;
  if (found.empty() || expected.empty() || found == expected) return OkStatus();
  return FailedPrecondition(fmt::format(
      "is of the thermal camera with serial number {}, the calibration or the recordings before "
      "of one with {}",
      found, expected));
}

/// nullopt: the image of a valid frame cannot be decoded.
std::optional<ThermalFrame> FrameOf(const EncodedThermalFrame& encoded) {
  ThermalFrame frame;
  frame.header = encoded.header;
  frame.scale = encoded.scale;
  frame.seconds_since_nuc = encoded.seconds_since_nuc;
  frame.housekeeping = encoded.housekeeping;
  frame.valid = encoded.valid;
  if (!frame.valid) return frame;
  Result<Image<std::uint16_t>> image = DecodeTemperatures(encoded.image);
  if (!image) return std::nullopt;
  frame.temperature_raw = std::move(*image);
  return frame;
}

}  // namespace

Status ReadThermalFrames(const std::filesystem::path& recording, std::optional<Rig>& rig,
                         const std::function<void(double)>& progress,
                         const std::function<Status(const ThermalFrame&)>& take) {
  const Result<std::unique_ptr<RecordingReader>> reader = RecordingReader::Open(recording);
  if (!reader) return reader.error();
  if (Status status = TakeRig((*reader)->ReadRig(), rig); !status.ok())
    return status.WithContext(recording.string());
  std::uint64_t total = 0, read = 0;
  for (const auto& [topic, count] : (*reader)->info().messages_by_topic) total += count;
  while (true) {
    const Result<std::optional<RecordedItem>> item = (*reader)->Next();
    if (item && !*item) return OkStatus();
    if (++read, total > 0)
      progress(std::min(1.0, static_cast<double>(read) / static_cast<double>(total)));
    if (!item) continue;  // What of a damaged recording cannot be read is not needed either.
    const auto* thermal = std::get_if<RecordedThermal>(&**item);
    if (thermal == nullptr) continue;
    const std::optional<ThermalFrame> frame = FrameOf(thermal->frame);
    if (!frame) continue;
    if (frame->valid && frame->temperature_raw.empty()) {
      return FailedPrecondition(fmt::format(
          "{}: its camera tells counts, not temperatures: there are no readings to calibrate",
          recording.string()));
    }
    if (Status status = take(*frame); !status.ok()) return status.WithContext(recording.string());
  }
}

}  // namespace isotherm
