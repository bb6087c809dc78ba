#include "edge/thermal_camera/p2pro_camera.h"

#include <fmt/format.h>

#include <utility>

#include "common/base/log.h"
#include "edge/thermal_camera/open_uvc_camera.h"

namespace isotherm {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr UvcMode kMode = {"YUY2", kP2ProWidth, 2 * kP2ProHeight};

// Vendor requests to the camera's processor.
constexpr std::uint8_t kWrite = 0x41;
constexpr std::uint8_t kWriteRequest = 0x45;
constexpr std::uint8_t kRead = 0xC1;
constexpr std::uint8_t kReadRequest = 0x44;
constexpr std::uint16_t kValue = 0x78;
constexpr std::uint16_t kCommandIndex = 0x1D00;
constexpr std::uint16_t kLongCommandIndex = 0x9D00;
constexpr std::uint16_t kDataIndex = 0x1D08;
constexpr std::uint16_t kLongDataIndex = 0x1D10;
constexpr std::uint16_t kStatusIndex = 0x0200;

// Measured by p2-viewer: after power-up the camera answers commands 2.9 s after streaming began,
// and shows uncorrected images for up to 8.75 s.
constexpr Nanoseconds kAnswersAfter = milliseconds(3000);
constexpr Nanoseconds kSettledAfter = seconds(9);
// Until the first frame: twice what the camera takes to answer.
constexpr Nanoseconds kStartTime = seconds(6);
// Each question costs some milliseconds of the camera's bus.
constexpr Nanoseconds kAskEvery = milliseconds(200);
constexpr Nanoseconds kTryAgainAfter = seconds(1);
constexpr int kMaxUnanswered = 5;
// A command takes some milliseconds.
constexpr int kStatusTries = 20;
constexpr Nanoseconds kStatusWait = milliseconds(1);
// The ground applies emissivity and transmission: the camera must not.
constexpr std::uint32_t kOne = 127;

}  // namespace

P2ProCamera::P2ProCamera(std::string bus_port, const Clock& clock) : clock_(clock) {
  info_.driver = kDriver;
  info_.bus_port = std::move(bus_port);
  info_.width = kP2ProWidth;
  info_.height = kP2ProHeight;
  info_.rate_hz = 25.0;
  info_.start_time = kStartTime;
}

P2ProCamera::~P2ProCamera() = default;

Status P2ProCamera::Open() {
  Close();
  Result<std::unique_ptr<UvcCamera>> camera = OpenUvcCamera(clock_, info_);
  if (!camera) return camera.error();
  camera_ = std::move(*camera);
  const Status started = camera_->Start(kMode);
  if (!started.ok()) {
    Close();
    return started;
  }
  shutter_ = {};
  opened_at_ = clock_.SteadyNow();
  next_command_at_ = opened_at_ + kAnswersAfter;
  configured_ = false;
  started_cold_ = false;
  unanswered_ = 0;
  return OkStatus();
}

Result<std::optional<RawThermalFrame>> P2ProCamera::Read(Nanoseconds timeout) {
  if (!camera_) return Err(Unavailable("the P2 Pro at " + info_.bus_port + " is not open"));
  Result<std::optional<UvcFrame>> received = camera_->Read(timeout);
  if (!received) return Err(received.error());
  const SteadyTime now = clock_.SteadyNow();
  // On the reading thread, between two images: a request takes milliseconds, an image 40.
  ConfigureWhenDue(now);
  AskShutterWhenDue(now);
  if (!*received) return std::optional<RawThermalFrame>();
  const UvcFrame& frame = **received;
  RawThermalFrame raw = BeginFrame(frame);
  raw.encoding = kInfirayEncoding;
  if (raw.incomplete) return std::optional(std::move(raw));
  Result<Image<std::uint16_t>> counts = ParseP2ProFrame(frame.bytes);
  if (!counts) return Err(counts.error());
  // There is no image yet, and those that follow are uncorrected for a while.
  if (IsP2ProColdStart(*counts)) {
    started_cold_ = true;
    return std::optional<RawThermalFrame>();
  }
  raw.counts = std::move(*counts);
  raw.nuc = shutter_.At(now);
  raw.shutter_closed = raw.nuc && raw.nuc->state == NucState::kInProgress;
  // A camera that was on already shows corrected images at once.
  if (!raw.shutter_closed && started_cold_ && now - opened_at_ < kSettledAfter) {
    raw.nuc = CameraNuc{NucState::kSettling, NucSource::kInferred, std::nullopt};
  }
  return std::optional(std::move(raw));
}

void P2ProCamera::Close() { camera_.reset(); }

void P2ProCamera::ConfigureWhenDue(SteadyTime now) {
  if (configured_ || now < next_command_at_) return;
  next_command_at_ = now + kTryAgainAfter;
  Status done = SetParameter(kP2ProEmissivity, kOne);
  if (done.ok()) done = SetParameter(kP2ProTransmission, kOne);
  if (done.ok()) done = ApplyGain();
  if (done.code() == StatusCode::kFailedPrecondition) {
    LOG(Thermal, Warning) << done.message();
    done = OkStatus();  // It keeps its range; asking again would not change that.
  }
  if (done.ok() && automatic_) done = Command(kP2ProAutoShutter, *automatic_ ? 1 : 0);
  if (done.ok()) {
    configured_ = true;
    next_command_at_ = now;
  } else if (++unanswered_ == kMaxUnanswered) {
    LOG(Thermal, Warning) << "the P2 Pro takes no commands: emissivity is what it was set to, the "
                             "shutter is inferred from the images: "
                          << done.message();
  }
}

void P2ProCamera::AskShutterWhenDue(SteadyTime now) {
  if (!configured_ || now < next_command_at_) return;
  next_command_at_ = now + kAskEvery;
  Status asked = Command(kP2ProShutterState, 0, 1);
  if (asked.ok()) {
    const Result<std::vector<std::uint8_t>> state = Receive(kDataIndex, 1);
    if (state && !state->empty()) {
      unanswered_ = 0;
      return shutter_.NoteState(state->front() == 1, now);
    }
  }
  // An old answer must not hold: "closed" would make the rest of the scan invalid.
  shutter_.ForgetState();
  // What does not answer is asked ever more seldom.
  if (++unanswered_ >= kMaxUnanswered) next_command_at_ = now + unanswered_ * kTryAgainAfter;
}

Status P2ProCamera::TriggerNuc() {
  ISOTHERM_RETURN_IF_ERROR(Command(kP2ProUpdateBackground, 0).WithContext("starting a correction"));
  shutter_.NoteOrder(clock_.SteadyNow());
  return OkStatus();
}

Status P2ProCamera::SetAutomaticNuc(bool on) {
  automatic_ = on;
  // Before it answers, it is done with the rest of the configuration.
  if (!configured_) return OkStatus();
  return Command(kP2ProAutoShutter, on ? 1 : 0).WithContext("setting the mode of corrections");
}

Status P2ProCamera::SetGain(ThermalGain gain) {
  gain_ = gain;
  info_.range = InfirayRange(gain);
  info_.settings = gain == ThermalGain::kKeep
                       ? "gain as found"
                       : fmt::format("gain {} when it answers", NameOf(gain));
  return configured_ ? ApplyGain() : OkStatus();
}

Status P2ProCamera::ApplyGain() {
  const bool keep = gain_ == ThermalGain::kKeep;
  const std::uint32_t wanted = gain_ == ThermalGain::kHigh ? 1 : 0;
  if (!keep) ISOTHERM_RETURN_IF_ERROR(SetParameter(kP2ProGain, wanted));
  const Result<std::uint16_t> found = GetParameter(kP2ProGain);
  // Firmware that cannot be asked must still work as it is.
  if (!found) return keep ? OkStatus() : found.error().WithContext("reading the gain back");
  const ThermalGain gain = *found != 0 ? ThermalGain::kHigh : ThermalGain::kLow;
  if (!keep && gain != gain_) {
    return FailedPrecondition(fmt::format("the P2 Pro at {} keeps its gain {} and was told {}",
                                          info_.bus_port, NameOf(gain), NameOf(gain_)));
  }
  info_.settings = fmt::format("gain {}", NameOf(gain));
  LOG(Thermal, Info) << "thermal camera " << kDriver << ": gain=" << NameOf(gain);
  return OkStatus();
}

Status P2ProCamera::Command(std::uint16_t word, std::uint32_t parameter, std::uint16_t length) {
  ISOTHERM_RETURN_IF_ERROR(Send(kCommandIndex, PackP2ProCommand(word, parameter, length)));
  return WaitUntilReady();
}

Status P2ProCamera::SetParameter(std::uint16_t parameter, std::uint32_t value) {
  const P2ProLongCommand command =
      PackP2ProLongCommand(kP2ProSetTemperatureParameter, parameter, value);
  ISOTHERM_RETURN_IF_ERROR(Send(kLongCommandIndex, command.first));
  ISOTHERM_RETURN_IF_ERROR(Send(kDataIndex, command.second));
  return WaitUntilReady();
}

Result<std::uint16_t> P2ProCamera::GetParameter(std::uint16_t parameter) {
  const P2ProLongCommand question = PackP2ProQuestion(kP2ProGetTemperatureParameter, parameter);
  Status asked = Send(kLongCommandIndex, question.first);
  if (asked.ok()) asked = Send(kDataIndex, question.second);
  if (asked.ok()) asked = WaitUntilReady();
  if (!asked.ok()) return Err(std::move(asked));
  const auto answer = Receive(kLongDataIndex, 2);
  if (!answer) return Err(answer.error());
  return ParseP2ProAnswer(*answer);
}

Status P2ProCamera::Send(std::uint16_t index, const std::vector<std::uint8_t>& bytes) {
  if (!camera_) return Unavailable("the P2 Pro at " + info_.bus_port + " is not open");
  return camera_->device().ControlOut({kWrite, kWriteRequest, kValue, index}, bytes);
}

Result<std::vector<std::uint8_t>> P2ProCamera::Receive(std::uint16_t index, std::size_t size) {
  return camera_->device().ControlIn({kRead, kReadRequest, kValue, index}, size);
}

Status P2ProCamera::WaitUntilReady() {
  for (int i = 0; i < kStatusTries; ++i) {
    const Result<std::vector<std::uint8_t>> status = Receive(kStatusIndex, 1);
    if (!status) return status.error();
    if (status->empty()) return DataLoss("the P2 Pro gives no status");
    switch (ParseP2ProStatus(status->front())) {
      case P2ProStatus::kReady:
        return OkStatus();
      case P2ProStatus::kError:
        return IoError(
            fmt::format("the P2 Pro refuses a command, status=0x{:02x}", status->front()));
      case P2ProStatus::kBusy:
        break;
    }
    ISOTHERM_RETURN_IF_ERROR(camera_->device().Pump(kStatusWait));
  }
  return Unavailable("the P2 Pro stays busy with a command");
}

}  // namespace isotherm
