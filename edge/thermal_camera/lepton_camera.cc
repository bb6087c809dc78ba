#include "edge/thermal_camera/lepton_camera.h"

#include <fmt/format.h>

#include <array>
#include <iterator>
#include <string_view>
#include <utility>

#include "edge/thermal_camera/lepton_protocol.h"
#include "edge/thermal_camera/open_uvc_camera.h"

namespace isotherm {
namespace {

struct Size {
  int width = 0;
  int height = 0;
};
constexpr Size kSizes[] = {{160, 120}, {80, 60}};  // Lepton 3.x and 2.x.
// Images leave the camera at this rate: it has 26 Hz inside, of which export rules let every third
// image out.
constexpr double kRate_hz = 8.7;
// So the frame counter of images that follow each other differs by 3.
constexpr int kCounterStep = 3;

// Extension units of the firmware; GUIDs are plain text.
constexpr UvcGuid kSysUnit = {'p', 't', '1', '-', 'l', 'e', 'p', '-',
                              's', 'y', 's', '-', '0', '0', '0', '0'};
constexpr std::uint8_t kGainMode = 19;
constexpr std::size_t kGainModeBytes = 4;
constexpr std::uint8_t kFfcMode = 16;
constexpr std::size_t kFfcModeBytes = 32;
constexpr std::uint8_t kRunFfc = 17;

float CelsiusOf(std::uint16_t centikelvin) {
  return centikelvin == 0 ? kUnknown_celsius : kCentikelvin.Celsius(centikelvin);
}

std::string_view LeptonGainName(std::uint32_t mode) {
  constexpr std::string_view kNames[] = {"high", "low", "automatic"};
  return mode < std::size(kNames) ? kNames[mode] : "unknown";
}

/// Returns what a gain measures, by the data sheet; automatic gain may become low at any time.
MeasuringRange LeptonRange(std::uint32_t mode) {
  return mode == 0 ? MeasuringRange{-10.0, 140.0} : MeasuringRange{-10.0, 550.0};
}

UvcMode ModeOf(const Size& size) {
  return {"Y16 ", size.width, size.height + LeptonTelemetryRows(size.width)};
}

}  // namespace

LeptonCamera::LeptonCamera(std::string bus_port, const Clock& clock) : clock_(clock) {
  info_.driver = kDriver;
  info_.bus_port = std::move(bus_port);
  info_.rate_hz = kRate_hz;
  info_.counter_step = kCounterStep;
}

LeptonCamera::~LeptonCamera() = default;

Status LeptonCamera::Open() {
  Close();
  Result<std::unique_ptr<UvcCamera>> camera = OpenUvcCamera(clock_, info_);
  if (!camera) return camera.error();
  camera_ = std::move(*camera);
  uptime_.Reset();
  counter_.Reset();
  const Status started = StartBestMode();
  if (!started.ok()) Close();
  return started;
}

Status LeptonCamera::StartBestMode() {
  for (const Size& size : kSizes) {
    if (!camera_->Has(ModeOf(size))) continue;
    info_.width = size.width;
    info_.height = size.height;
    // This mode turns automatic gain off and telemetry on.
    return camera_->Start(ModeOf(size));
  }
  return FailedPrecondition(
      fmt::format("the Lepton at {} offers no 16-bit images with telemetry; its firmware must be "
                  "1.2.2 or later",
                  info_.bus_port));
}

Result<std::optional<RawThermalFrame>> LeptonCamera::Read(Nanoseconds timeout) {
  if (Status open = CheckOpen(); !open.ok()) return Err(std::move(open));
  Result<std::optional<UvcFrame>> received = camera_->Read(timeout);
  if (!received) return Err(received.error());
  if (!*received) return std::optional<RawThermalFrame>();
  const UvcFrame& frame = **received;
  RawThermalFrame raw = BeginFrame(frame);
  // The telemetry comes last: of an incomplete frame nothing can be known.
  if (raw.incomplete) return std::optional(std::move(raw));
  Result<LeptonFrame> parsed = ParseLeptonFrame(frame.bytes, info_.width, info_.height);
  if (!parsed) return Err(parsed.error());
  const LeptonTelemetry& telemetry = parsed->telemetry;
  raw.counts = std::move(parsed->counts);
  raw.encoding = LeptonEncoding(telemetry);
  raw.nuc = LeptonNuc(telemetry);
  raw.shutter_closed = telemetry.ffc_state == 2;
  raw.device_ticks = DeviceTicks(
      std::chrono::milliseconds(static_cast<std::int64_t>(uptime_.Process(telemetry.uptime_ms))));
  raw.device_counter = counter_.Process(telemetry.frame_counter);
  raw.housekeeping.fpa_celsius = CelsiusOf(telemetry.fpa_centikelvin);
  raw.housekeeping.housing_celsius = CelsiusOf(telemetry.housing_centikelvin);
  return std::optional(std::move(raw));
}

void LeptonCamera::Close() { camera_.reset(); }

Status LeptonCamera::CheckOpen() const {
  return camera_ ? OkStatus() : Unavailable("the Lepton at " + info_.bus_port + " is not open");
}

Status LeptonCamera::TriggerNuc() {
  ISOTHERM_RETURN_IF_ERROR(CheckOpen());
  // One byte runs the command.
  constexpr std::array<std::uint8_t, 1> kRun = {0};
  return camera_->SetControl(kSysUnit, kRunFfc, kRun).WithContext("starting a correction");
}

Status LeptonCamera::SetAutomaticNuc(bool on) {
  ISOTHERM_RETURN_IF_ERROR(CheckOpen());
  Result<std::vector<std::uint8_t>> mode = camera_->GetControl(kSysUnit, kFfcMode, kFfcModeBytes);
  if (!mode) return mode.error().WithContext("reading the mode of corrections");
  if (mode->size() != kFfcModeBytes) {
    return DataLoss(fmt::format("the mode of corrections has {} bytes instead of {}", mode->size(),
                                kFfcModeBytes));
  }
  PutLe32(*mode, 0, on ? 1 : 0);
  return camera_->SetControl(kSysUnit, kFfcMode, *mode)
      .WithContext("setting the mode of corrections");
}

Status LeptonCamera::SetGain(ThermalGain gain) {
  ISOTHERM_RETURN_IF_ERROR(CheckOpen());
  if (gain == ThermalGain::kKeep) {
    // A Lepton without this control has one range only.
    const Result<std::uint32_t> found = ReadGain();
    info_.settings = found ? fmt::format("gain {}", LeptonGainName(*found)) : "gain unknown";
    if (found) info_.range = LeptonRange(*found);
    return OkStatus();
  }
  const std::uint32_t wanted = gain == ThermalGain::kLow ? 1 : 0;
  const std::array<std::uint8_t, kGainModeBytes> mode = {static_cast<std::uint8_t>(wanted), 0, 0,
                                                         0};
  ISOTHERM_RETURN_IF_ERROR(
      camera_->SetControl(kSysUnit, kGainMode, mode).WithContext("setting the gain"));
  const Result<std::uint32_t> found = ReadGain();
  if (!found) return found.error().WithContext("reading the gain back");
  if (*found != wanted) {
    return FailedPrecondition(fmt::format("the Lepton at {} keeps its gain {} and was told {}",
                                          info_.bus_port, LeptonGainName(*found), NameOf(gain)));
  }
  info_.settings = fmt::format("gain {}", NameOf(gain));
  info_.range = LeptonRange(wanted);
  return OkStatus();
}

Result<std::uint32_t> LeptonCamera::ReadGain() {
  const auto mode = camera_->GetControl(kSysUnit, kGainMode, kGainModeBytes);
  if (!mode) return Err(mode.error());
  if (mode->size() != kGainModeBytes) {
    return Err(
        DataLoss(fmt::format("the gain has {} bytes instead of {}", mode->size(), kGainModeBytes)));
  }
  return Le32(*mode, 0);
}

}  // namespace isotherm
