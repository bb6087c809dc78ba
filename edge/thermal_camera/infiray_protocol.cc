#include "edge/thermal_camera/infiray_protocol.h"

#include <fmt/format.h>

#include <algorithm>

namespace isotherm {
namespace {

constexpr std::size_t kFrameBytes = std::size_t{4} * kP2ProWidth * kP2ProHeight;
// The image stands still for 0.8 s when the camera corrects itself.
constexpr Nanoseconds kCorrectionTime = std::chrono::milliseconds(1000);

// Published programs disagree about the byte order of a command's length: the viewer of LeoDJ,
// which works with cameras of several owners, has the high byte first. One line to change.
constexpr bool kLengthHighByteFirst = true;
constexpr std::uint8_t kAnswerBytes = 2;

void Append(std::vector<std::uint8_t>& bytes, std::uint32_t value, int count) {
  for (int i = count - 1; i >= 0; --i) bytes.push_back(static_cast<std::uint8_t>(value >> 8 * i));
}

std::vector<std::uint8_t> Begin(std::uint16_t word) {
  return {static_cast<std::uint8_t>(word), static_cast<std::uint8_t>(word >> 8)};
}

}  // namespace

Result<Image<std::uint16_t>> ParseP2ProFrame(Bytes bytes) {
  if (bytes.size() != kFrameBytes) {
    return Err(DataLoss(
        fmt::format("a P2 Pro frame of {} bytes instead of {}", bytes.size(), kFrameBytes)));
  }
  const Bytes lower = bytes.subspan(kFrameBytes / 2);
  Image<std::uint16_t> counts(kP2ProWidth, kP2ProHeight);
  for (std::size_t i = 0; i < counts.size(); ++i) counts.data()[i] = Le16(lower, 2 * i);
  return counts;
}

bool IsP2ProColdStart(const Image<std::uint16_t>& counts) {
  const auto pixels = counts.pixels();
  return std::all_of(pixels.begin(), pixels.end(),
                     [](std::uint16_t count) { return count == 0x8000; });
}

std::vector<std::uint8_t> PackP2ProCommand(std::uint16_t word, std::uint32_t parameter,
                                           std::uint16_t length) {
  std::vector<std::uint8_t> bytes = Begin(word);
  Append(bytes, parameter, 4);
  Append(bytes, length, 2);
  if (!kLengthHighByteFirst) std::swap(bytes[6], bytes[7]);
  return bytes;
}

P2ProLongCommand PackP2ProLongCommand(std::uint16_t word, std::uint16_t parameter,
                                      std::uint32_t value) {
  P2ProLongCommand command{Begin(word), {}};
  Append(command.first, parameter, 2);
  Append(command.first, value, 4);
  Append(command.second, 0, 4);
  Append(command.second, 0, 4);
  return command;
}

P2ProLongCommand PackP2ProQuestion(std::uint16_t word, std::uint16_t parameter) {
  P2ProLongCommand command = PackP2ProLongCommand(word, parameter, 0);
  command.second.back() = kAnswerBytes;
  return command;
}

Result<std::uint16_t> ParseP2ProAnswer(Bytes bytes) {
  if (bytes.size() != kAnswerBytes) {
    return Err(DataLoss(
        fmt::format("a P2 Pro parameter of {} bytes instead of {}", bytes.size(), kAnswerBytes)));
  }
  return static_cast<std::uint16_t>(bytes[0] << 8 | bytes[1]);
}

P2ProStatus ParseP2ProStatus(std::uint8_t status) {
  if ((status & 0x03) == 0) return P2ProStatus::kReady;
  return (status & 0xFC) != 0 ? P2ProStatus::kError : P2ProStatus::kBusy;
}

void PolledShutter::NoteState(bool closed, SteadyTime now) {
  closed_ = closed;
  if (closed) last_closed_at_ = now;
}

std::optional<CameraNuc> PolledShutter::At(SteadyTime now) const {
  CameraNuc nuc;
  if (closed_ && *closed_) {
    nuc.state = NucState::kInProgress;
    nuc.source = NucSource::kPolled;
    return nuc;
  }
  const bool ordered = ordered_at_ && now - *ordered_at_ < kCorrectionTime;
  if (!ordered && !closed_) return std::nullopt;
  nuc.state = ordered ? NucState::kInProgress : NucState::kIdle;
  nuc.source = ordered ? NucSource::kCommanded : NucSource::kPolled;
  if (!ordered && last_closed_at_) nuc.seconds_since = ToSeconds(now - *last_closed_at_);
  return nuc;
}

}  // namespace isotherm
