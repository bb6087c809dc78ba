#include "edge/thermal_camera/seek_protocol.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace isotherm {
namespace {

// Vendor requests (libseek-thermal, DeviceCommand).
enum Opcode : std::uint8_t {
  kReadChipId = kSeekReadChipId,
  kSetOperationMode = 60,
  kGetOperationMode = 61,
  kSetImageProcessingMode = 62,
  kGetFirmwareInfo = 78,
  kStartTransfer = 83,
  kTargetPlatform = 84,
  kSetFirmwareInfoFeatures = 85,
  kSetFactorySettingsFeatures = 86,
  kGetFactorySettings = 88,
};

constexpr std::size_t kChipIdBytes = 12;
// The detectors have 14 bits.
constexpr std::size_t kRawValues = 0x4000;

/// Asks for `words` 16-bit words of the factory settings from `address` on, and reads them.
void AppendFactorySettings(std::uint8_t words, std::uint16_t address,
                           std::vector<SeekRequest>& requests) {
  requests.push_back({kSetFactorySettingsFeatures,
                      {words, 0, static_cast<std::uint8_t>(address),
                       static_cast<std::uint8_t>(address >> 8), 0, 0},
                      0});
  requests.push_back({kGetFactorySettings, {}, std::size_t{2} * words});
}

void AppendFirmwareInfo(std::uint8_t what, std::vector<SeekRequest>& requests) {
  requests.push_back({kSetFirmwareInfoFeatures, {what, 0}, 0});
  requests.push_back({kGetFirmwareInfo, {}, 64});
}

// The requests and their order are those of libseek-thermal; what each does is not documented.
void AppendCompact(std::vector<SeekRequest>& requests) {
  AppendFactorySettings(0x20, 0x30, requests);
  AppendFactorySettings(0x20, 0x50, requests);
  AppendFactorySettings(0x0C, 0x70, requests);
  AppendFactorySettings(0x06, 0x08, requests);
  requests.push_back({kSetImageProcessingMode, {0x08, 0x00}, 0});
  requests.push_back({kGetOperationMode, {}, 2});
  requests.push_back({kSetImageProcessingMode, {0x08, 0x00}, 0});
  requests.push_back({kSetOperationMode, {0x01, 0x00}, 0});
  requests.push_back({kGetOperationMode, {}, 2});
}

void AppendCompactPro(std::vector<SeekRequest>& requests) {
  constexpr std::uint16_t kSettingsEnd = 2560;
  constexpr std::uint16_t kStep = 32;
  AppendFactorySettings(0x06, 0x08, requests);
  AppendFirmwareInfo(0x17, requests);
  AppendFactorySettings(0x01, 0x0600, requests);
  AppendFactorySettings(0x01, 0x0601, requests);
  for (std::uint16_t address = 0; address < kSettingsEnd; address += kStep) {
    AppendFactorySettings(0x20, address, requests);
  }
  AppendFirmwareInfo(0x15, requests);
  requests.push_back({kSetImageProcessingMode, {0x08, 0x00}, 0});
  requests.push_back({kSetOperationMode, {0x01, 0x00}, 0});
}

SeekFrameKind KindOf(std::uint16_t id) {
  switch (id) {
    case 1:
      return SeekFrameKind::kShutter;
    case 3:
      return SeekFrameKind::kImage;
    case 4:
      return SeekFrameKind::kFirst;
    default:
      return SeekFrameKind::kOther;
  }
}

/// Detectors below it do not work: as far below the most frequent value as the largest is above
/// (libseek-thermal, SeekCam.cpp). Zeroes are not counted, since most dead detectors have them.
int DeadBelow(const Image<std::uint16_t>& first) {
  std::array<int, kRawValues> histogram{};
  int largest = 0;
  for (const std::uint16_t value : first.pixels()) {
    if (value == 0) continue;
    largest = std::max<int>(largest, value);
    ++histogram[std::min<std::size_t>(value, kRawValues - 1)];
  }
  const auto most = std::max_element(histogram.begin(), histogram.end());
  const int frequent = static_cast<int>(most - histogram.begin());
  return std::max(2 * frequent - largest, 0);
}

/// Indices of the up to four pixels beside, above and below `pixel`.
std::vector<std::uint32_t> Neighbours(std::uint32_t pixel, int width, int height) {
  const auto row = static_cast<std::uint32_t>(width);
  const std::uint32_t x = pixel % row;
  const std::uint32_t y = pixel / row;
  std::vector<std::uint32_t> neighbours;
  if (x > 0) neighbours.push_back(pixel - 1);
  if (x + 1 < row) neighbours.push_back(pixel + 1);
  if (y > 0) neighbours.push_back(pixel - row);
  if (y + 1 < static_cast<std::uint32_t>(height)) neighbours.push_back(pixel + row);
  return neighbours;
}

/// `raw` against `shutter`; 0 is kept for "no value".
Image<std::uint16_t> Against(const Image<std::uint16_t>& raw, const Image<std::uint16_t>& shutter) {
  Image<std::uint16_t> counts(raw.width(), raw.height());
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const int count = raw.pixels()[i] + kSeekMiddle - shutter.pixels()[i];
    counts.pixels()[i] = static_cast<std::uint16_t>(std::clamp(count, 1, 0xFFFF));
  }
  return counts;
}

}  // namespace

SeekRequest SeekWakeRequest() { return {kTargetPlatform, {0x01}, 0}; }
SeekRequest SeekSleepRequest() { return {kSetOperationMode, {0x00, 0x00}, 0}; }

std::vector<SeekRequest> SeekStartRequests(const SeekModel& model) {
  std::vector<SeekRequest> requests = {{kSetOperationMode, {0x00, 0x00}, 0},
                                       {kGetFirmwareInfo, {}, 4},
                                       {kReadChipId, {}, kChipIdBytes}};
  if (model.name == kSeekCompactPro.name) {
    AppendCompactPro(requests);
  } else {
    AppendCompact(requests);
  }
  return requests;
}

SeekRequest SeekFrameRequest(const SeekModel& model) {
  std::vector<std::uint8_t> words(4);
  PutLe32(words, 0, static_cast<std::uint32_t>(model.words()));
  return {kStartTransfer, std::move(words), 0};
}

Result<SeekRawFrame> ParseSeekFrame(Bytes bytes, const SeekModel& model) {
  if (bytes.size() != model.frame_bytes()) {
    return Err(DataLoss(fmt::format("a {} frame of {} bytes instead of {}", model.name,
                                    bytes.size(), model.frame_bytes())));
  }
  SeekRawFrame frame;
  frame.kind = KindOf(Le16(bytes, 2 * model.id_word));
  frame.counter = Le16(bytes, 2 * model.counter_word);
  frame.raw.Resize(model.width, model.height);
  for (int y = 0; y < model.height; ++y) {
    const int first = (model.top + y) * model.raw_width + model.left;
    for (int x = 0; x < model.width; ++x) {
      frame.raw.At(x, y) = Le16(bytes, 2 * static_cast<std::size_t>(first + x));
    }
  }
  return frame;
}

void SeekAssembler::Begin() {
  bytes_.clear();
  first_stamp_ = {};
}

void SeekAssembler::Add(Bytes bytes, const HostStamp& stamp) {
  if (bytes.empty()) return;
  if (bytes_.empty()) first_stamp_ = stamp;
  const std::size_t taken = std::min(bytes.size(), model_->frame_bytes() - bytes_.size());
  bytes_.insert(bytes_.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(taken));
}

std::size_t SeekAssembler::wanted_bytes() const {
  return std::min(model_->read_bytes, model_->frame_bytes() - bytes_.size());
}

Result<SeekDeadPixels> SeekDeadPixels::Find(const Image<std::uint16_t>& first) {
  const int dead_below = DeadBelow(first);
  std::vector<bool> dead(first.size());
  std::vector<std::uint32_t> left;
  for (std::uint32_t i = 0; i < first.size(); ++i) {
    dead[i] = first.pixels()[i] == 0 || first.pixels()[i] < dead_below;
    if (dead[i]) left.push_back(i);
  }
  if (2 * left.size() > first.size()) {
    return Err(DataLoss(fmt::format("{} of {} detectors are dark in the camera's first frame",
                                    left.size(), first.size())));
  }
  SeekDeadPixels result;
  result.width_ = first.width();
  result.height_ = first.height();
  // From the border of a dead patch inwards: each round fills those that have a neighbour by now.
  // It ends, since at least half of the detectors work.
  while (!left.empty()) {
    std::vector<std::uint32_t> amid_others;
    const std::size_t round = result.dead_.size();
    for (const std::uint32_t pixel : left) {
      std::vector<std::uint32_t> neighbours = Neighbours(pixel, first.width(), first.height());
      std::erase_if(neighbours, [&dead](std::uint32_t other) { return dead[other]; });
      if (neighbours.empty()) {
        amid_others.push_back(pixel);
      } else {
        result.dead_.push_back({pixel, std::move(neighbours)});
      }
    }
    // Those of this round serve only the next one, so that the order within it does not matter.
    for (std::size_t i = round; i < result.dead_.size(); ++i) dead[result.dead_[i].pixel] = false;
    left = std::move(amid_others);
  }
  return result;
}

void SeekDeadPixels::Fill(Image<std::uint16_t>& counts) const {
  if (counts.width() != width_ || counts.height() != height_) return;
  for (const Dead& dead : dead_) {
    std::uint32_t sum = 0;
    for (const std::uint32_t neighbour : dead.neighbours) sum += counts.pixels()[neighbour];
    counts.pixels()[dead.pixel] =
        static_cast<std::uint16_t>(sum / static_cast<std::uint32_t>(dead.neighbours.size()));
  }
}

Result<std::optional<SeekImage>> SeekImageMaker::Process(SeekRawFrame frame) {
  const bool is_shutter = frame.kind == SeekFrameKind::kShutter;
  if (!dead_pixels_) {
    if (frame.kind != SeekFrameKind::kFirst) {
      return Err(DataLoss("the camera does not begin with its first frame"));
    }
    Result<SeekDeadPixels> found = SeekDeadPixels::Find(frame.raw);
    if (!found) return Err(found.error());
    dead_pixels_ = std::move(*found);
  }
  // Before the first shutter frame there is nothing to measure an image against.
  const bool shows = is_shutter || frame.kind == SeekFrameKind::kImage;
  if (!shows || (!is_shutter && shutter_.empty())) return std::optional<SeekImage>();
  SeekImage image;
  image.counts = Against(frame.raw, shutter_.empty() ? frame.raw : shutter_);
  image.counter = frame.counter;
  image.shutter_closed = is_shutter;
  dead_pixels_->Fill(image.counts);
  if (is_shutter) shutter_ = std::move(frame.raw);
  return std::optional(std::move(image));
}

}  // namespace isotherm
