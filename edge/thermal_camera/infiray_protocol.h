#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/base/status.h"
#include "common/frame/frame.h"
#include "common/time/time_types.h"
#include "edge/thermal_camera/thermal_camera.h"
#include "edge/usb/bytes.h"

namespace isotherm {

/// InfiRay P2 Pro, Topdon TC001, Tiny1-C: 256x384 words, an image for people on top, temperatures
/// below (LeoDJ/P2Pro-Viewer, mbuesch/p2pro-rs, vendor headers of Tiny1-C).
inline constexpr int kP2ProWidth = 256;
inline constexpr int kP2ProHeight = 192;
/// Kelvin = count / 64.
inline constexpr PixelEncoding kInfirayEncoding{true, 1.0 / 64.0, 0.0};

/// Returns what a gain measures; nullopt if it was left as it is. Low: the larger of what data
/// sheets say, 550 or 600 °C.
constexpr std::optional<MeasuringRange> InfirayRange(ThermalGain gain) {
  if (gain == ThermalGain::kHigh) return MeasuringRange{-20.0, 150.0};
  if (gain == ThermalGain::kLow) return MeasuringRange{0.0, 600.0};
  return std::nullopt;
}

/// The lower half. kDataLoss if `bytes` has not the size of a frame.
Result<Image<std::uint16_t>> ParseP2ProFrame(Bytes bytes);

/// For some seconds after power-up every count is 0x8000: there is no image yet.
bool IsP2ProColdStart(const Image<std::uint16_t>& counts);

/// A vendor command of eight bytes: word, parameter, length of data.
std::vector<std::uint8_t> PackP2ProCommand(std::uint16_t word, std::uint32_t parameter,
                                           std::uint16_t length);
/// The two halves of a long command, which sets a parameter to a value.
struct P2ProLongCommand {
  std::vector<std::uint8_t> first;
  std::vector<std::uint8_t> second;
};
P2ProLongCommand PackP2ProLongCommand(std::uint16_t word, std::uint16_t parameter,
                                      std::uint32_t value);
/// The same asking for a parameter, which is answered with two bytes, high byte first.
P2ProLongCommand PackP2ProQuestion(std::uint16_t word, std::uint16_t parameter);
/// kDataLoss for another size than two bytes.
Result<std::uint16_t> ParseP2ProAnswer(Bytes bytes);

/// Meaning of the status byte after a command.
enum class P2ProStatus { kReady, kBusy, kError };
P2ProStatus ParseP2ProStatus(std::uint8_t status);

// Command words: type in the low byte, what to do in the high one.
inline constexpr std::uint16_t kP2ProUpdateBackground = 0xC10D;  ///< Correct now.
inline constexpr std::uint16_t kP2ProAutoShutter = 0x410C;       ///< Parameter 1 on, 0 off.
inline constexpr std::uint16_t kP2ProShutterState = 0x830C;      ///< Answers 1 byte: 1 = closed.
inline constexpr std::uint16_t kP2ProGetTemperatureParameter = 0x8514;
inline constexpr std::uint16_t kP2ProSetTemperatureParameter = 0xC514;
inline constexpr std::uint16_t kP2ProEmissivity = 3;    ///< Parameter, in 1/127.
inline constexpr std::uint16_t kP2ProTransmission = 4;  ///< Parameter, in 1/127.
inline constexpr std::uint16_t kP2ProGain = 5;          ///< Parameter: 1 high, 0 low.

/// Holds what is known about a shutter that is asked now and then instead of telling with each
/// frame. Thread-compatible.
class PolledShutter {
 public:
  /// Notes that a correction was ordered.
  void NoteOrder(SteadyTime now) { ordered_at_ = now; }
  void NoteState(bool closed, SteadyTime now);
  /// Forgets the shutter's state: to be called when the camera does not answer any more.
  void ForgetState() { closed_.reset(); }

  /// Nullopt if nothing is known.
  std::optional<CameraNuc> At(SteadyTime now) const;

 private:
  std::optional<SteadyTime> ordered_at_;
  std::optional<bool> closed_;
  std::optional<SteadyTime> last_closed_at_;
};

}  // namespace isotherm
