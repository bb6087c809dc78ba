#include "edge/thermal_camera/lepton_protocol.h"

#include <fmt/format.h>

namespace isotherm {
namespace {

// Telemetry rows A, B and C of 80 words each.
constexpr int kTelemetryWords = 240;
constexpr std::size_t kRowC = 160;

// Words of the telemetry; numbers of two words have the low word first.
constexpr std::size_t kUptime = 1;
constexpr std::size_t kStatus = 3;
constexpr std::size_t kFrameCounter = 20;
constexpr std::size_t kFpaTemperature = 24;
constexpr std::size_t kHousingTemperature = 26;
constexpr std::size_t kUptimeAtFfc = 30;
constexpr std::size_t kTlinearEnable = kRowC + 48;
constexpr std::size_t kTlinearResolution = kRowC + 49;

LeptonTelemetry ParseTelemetry(Bytes bytes) {
  const auto word = [bytes](std::size_t index) { return Le16(bytes, 2 * index); };
  const auto number = [bytes](std::size_t index) { return Le32(bytes, 2 * index); };
  const std::uint32_t status = number(kStatus);
  LeptonTelemetry telemetry;
  telemetry.uptime_ms = number(kUptime);
  telemetry.uptime_at_ffc_ms = number(kUptimeAtFfc);
  telemetry.frame_counter = number(kFrameCounter);
  telemetry.fpa_centikelvin = word(kFpaTemperature);
  telemetry.housing_centikelvin = word(kHousingTemperature);
  telemetry.ffc_desired = (status >> 3 & 1) != 0;
  telemetry.ffc_state = static_cast<std::uint8_t>(status >> 4 & 3);
  telemetry.shutter_locked_out = (status >> 15 & 1) != 0;
  telemetry.tlinear = word(kTlinearEnable) != 0;
  telemetry.fine_resolution = word(kTlinearResolution) != 0;
  return telemetry;
}

}  // namespace

int LeptonTelemetryRows(int width) { return (kTelemetryWords + width - 1) / width; }

Result<LeptonFrame> ParseLeptonFrame(Bytes bytes, int width, int height) {
  const auto row_bytes = 2 * static_cast<std::size_t>(width);
  const std::size_t image_bytes = row_bytes * static_cast<std::size_t>(height);
  const std::size_t expected =
      image_bytes + row_bytes * static_cast<std::size_t>(LeptonTelemetryRows(width));
  if (bytes.size() != expected) {
    return Err(
        DataLoss(fmt::format("a Lepton frame of {} bytes instead of {}", bytes.size(), expected)));
  }
  LeptonFrame frame;
  frame.counts.Resize(width, height);
  for (std::size_t i = 0; i < frame.counts.size(); ++i) {
    frame.counts.data()[i] = Le16(bytes, 2 * i);
  }
  frame.telemetry = ParseTelemetry(bytes.subspan(image_bytes));
  return frame;
}

PixelEncoding LeptonEncoding(const LeptonTelemetry& telemetry) {
  if (!telemetry.tlinear) return {};
  return {true, telemetry.fine_resolution ? 0.01 : 0.1, 0.0};
}

CameraNuc LeptonNuc(const LeptonTelemetry& telemetry) {
  CameraNuc nuc;
  nuc.source = NucSource::kInBand;
  switch (telemetry.ffc_state) {
    case 1:
      nuc.state = NucState::kImminent;
      break;
    case 2:
      nuc.state = NucState::kInProgress;
      break;
    case 3:
      nuc.state = telemetry.ffc_desired ? NucState::kDesired : NucState::kIdle;
      break;
    default:
      nuc.state = NucState::kUnknown;
  }
  const bool wants_one = nuc.state == NucState::kDesired || nuc.state == NucState::kImminent;
  if (telemetry.shutter_locked_out && wants_one) nuc.state = NucState::kBlocked;
  const bool corrected = telemetry.ffc_state != 0 && telemetry.uptime_at_ffc_ms != 0;
  if (corrected && telemetry.uptime_ms >= telemetry.uptime_at_ffc_ms) {
    nuc.seconds_since = (telemetry.uptime_ms - telemetry.uptime_at_ffc_ms) / 1000.0;
  }
  return nuc;
}

}  // namespace isotherm
