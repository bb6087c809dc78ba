#include "edge/thermal_camera/p3_protocol.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace isotherm {
namespace {

// Words of the metadata rows.
constexpr std::size_t kFrameCounter = 64;
constexpr std::size_t kZeroWhileCorrecting[] = {169, 170};

/// Nullopt if `bytes` does not begin with a marker.
std::optional<UvcPayloadHeader> ParseMarker(Bytes bytes) {
  // End of header, source clock and time stamp are always there; error bits never.
  if (bytes.size() < kP3MarkerBytes || bytes[0] != kP3MarkerBytes) return std::nullopt;
  if ((bytes[1] & 0xFC) != 0x8C || (Le16(bytes, 10) & 0xF800) != 0) return std::nullopt;
  return ParseUvcPayloadHeader(bytes);
}

std::uint16_t Crc16(Bytes bytes) {
  std::uint16_t crc = 0;
  for (const std::uint8_t byte : bytes) {
    crc = static_cast<std::uint16_t>(crc ^ byte << 8);
    for (int bit = 0; bit < 8; ++bit) {
      crc = static_cast<std::uint16_t>((crc & 0x8000) != 0 ? crc << 1 ^ 0x1021 : crc << 1);
    }
  }
  return crc;
}

}  // namespace

Result<P3Frame> ParseP3Frame(Bytes data, const P3Layout& layout) {
  if (data.size() != layout.data_bytes()) {
    return Err(DataLoss(
        fmt::format("a P3 frame of {} bytes instead of {}", data.size(), layout.data_bytes())));
  }
  const std::size_t row_bytes = 2 * static_cast<std::size_t>(layout.width);
  const std::size_t image_bytes = row_bytes * static_cast<std::size_t>(layout.height);
  const Bytes metadata = data.subspan(image_bytes, 2 * row_bytes);
  const Bytes thermal = data.subspan(image_bytes + 2 * row_bytes);
  P3Frame frame;
  frame.counts.Resize(layout.width, layout.height);
  for (std::size_t i = 0; i < frame.counts.size(); ++i) {
    frame.counts.data()[i] = Le16(thermal, 2 * i);
  }
  frame.metadata.frame_counter = Le16(metadata, 2 * kFrameCounter);
  frame.metadata.correcting =
      std::all_of(std::begin(kZeroWhileCorrecting), std::end(kZeroWhileCorrecting),
                  [metadata](std::size_t word) { return Le16(metadata, 2 * word) == 0; });
  return frame;
}

void P3Assembler::AddTransfer(Bytes bytes, const HostStamp& stamp) {
  if (bytes.empty()) return;
  const std::optional<UvcPayloadHeader> marker = ParseMarker(bytes);
  if (marker && marker->end_of_frame && bytes.size() == kP3MarkerBytes) return Finish(*marker);
  // Data could look like a marker by accident; temperatures below 500 K cannot.
  if (marker && !marker->end_of_frame && bytes.size() > kP3MarkerBytes) {
    if (in_frame_) Conclude();
    frame_.bytes.resize(data_bytes_);
    frame_.presentation_time = marker->presentation_time;
    frame_.first_packet = stamp;
    in_frame_ = true;
    bytes = bytes.subspan(kP3MarkerBytes);
  }
  if (!in_frame_) return;
  frame_.last_packet = stamp;
  const std::size_t room = data_bytes_ - frame_.received;
  if (bytes.size() > room) frame_.incomplete = true;
  const std::size_t taken = std::min(room, bytes.size());
  std::copy_n(bytes.begin(), taken,
              frame_.bytes.begin() + static_cast<std::ptrdiff_t>(frame_.received));
  frame_.received += taken;
}

void P3Assembler::Finish(const UvcPayloadHeader& end) {
  if (!in_frame_) return;
  if (end.presentation_time != frame_.presentation_time) frame_.incomplete = true;
  Conclude();
}

void P3Assembler::Conclude() {
  in_frame_ = false;
  if (frame_.received != data_bytes_) frame_.incomplete = true;
  const bool first = !std::exchange(seen_a_frame_, true);
  if (!(first && frame_.incomplete)) finished_.Push(std::move(frame_));
  frame_ = {};
}

std::array<std::uint8_t, 18> PackP3Command(std::uint16_t type, std::uint16_t parameter,
                                           std::uint16_t reg, std::uint16_t answer_bytes) {
  std::array<std::uint8_t, 18> command{};
  PutLe16(command, 0, type);
  PutLe16(command, 2, parameter);
  PutLe16(command, 4, reg);
  PutLe16(command, 12, answer_bytes);
  PutLe16(command, 16, Crc16(Bytes(command).first(16)));
  return command;
}

std::string P3Text(Bytes bytes) {
  const auto end = std::find(bytes.begin(), bytes.end(), 0);
  return std::string(bytes.begin(), end);
}

}  // namespace isotherm
