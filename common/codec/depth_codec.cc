#include <algorithm>

#include "common/codec/image_codecs.h"
#include "common/codec/predictive_decoder.h"
#include "common/codec/predictive_encoder.h"
#include "common/frame/frame.h"

namespace isotherm::codec {
namespace {

constexpr std::uint32_t kValues = 1U << 16;
/// With more values a table of them costs more than it saves.
constexpr std::size_t kMaxRanked = 2048;

/// First byte of a payload.
constexpr std::uint8_t kHoleIs65535 = 1;  ///< Otherwise it is 0.
constexpr std::uint8_t kRanked = 2;       ///< A table of the values follows.

}  // namespace

struct DepthCodec::Scratch {
  PredictiveEncoder<DepthModel> encoder;
  PredictiveDecoder<DepthModel> decoder;
  std::vector<std::uint8_t> occurs = std::vector<std::uint8_t>(kValues);
  std::vector<std::uint16_t> mapping = std::vector<std::uint16_t>(kValues);

  std::uint16_t hole = 0;

  void FindValues(const Image<std::uint16_t>& image) {
    std::fill(occurs.begin(), occurs.end(), std::uint8_t{0});
    for (const std::uint16_t value : image.pixels()) occurs[value] = 1;
    hole = 0;
    if (occurs[kNoDepthSaturated] == 0) return;
    const auto saturated = std::ranges::count(image.pixels(), kNoDepthSaturated);
    if (saturated > std::ranges::count(image.pixels(), kNoDepth)) hole = kNoDepthSaturated;
  }

  /// Fills `mapping` (pixel to coded value, holes to 0) and writes how to invert it.
  void PutMapping(std::vector<std::uint8_t>& payload) {
    occurs[hole] = 0;
    const auto distinct = static_cast<std::size_t>(std::count(occurs.begin(), occurs.end(), 1));
    const bool ranked = distinct <= kMaxRanked;
    payload.push_back(
        static_cast<std::uint8_t>((hole != 0 ? kHoleIs65535 : 0) | (ranked ? kRanked : 0)));
    mapping[hole] = 0;
    if (!ranked) {
      for (std::uint32_t value = 0; value < kValues; ++value) {
        mapping[value] = static_cast<std::uint16_t>(value - hole);
      }
      return;
    }
    PutVarint(static_cast<std::uint32_t>(distinct), payload);
    std::uint32_t previous = 0;
    std::uint16_t rank = 0;
    for (std::uint32_t value = 0; value < kValues; ++value) {
      if (occurs[value] == 0) continue;
      mapping[value] = ++rank;
      PutVarint(value - previous, payload);
      previous = value;
    }
  }

  /// Fills `mapping` (coded value to pixel); returns how many coded values there are, nullopt if
  /// damaged.
  std::optional<std::uint32_t> GetMapping(PayloadReader& in) {
    const std::optional<std::uint8_t> flags = in.Byte();
    if (!flags || *flags > (kHoleIs65535 | kRanked)) return std::nullopt;
    hole = (*flags & kHoleIs65535) != 0 ? kNoDepthSaturated : kNoDepth;
    if ((*flags & kRanked) == 0) {
      for (std::uint32_t value = 0; value < kValues; ++value) {
        mapping[value] = static_cast<std::uint16_t>(value + hole);
      }
      return kValues;
    }
    const std::optional<std::uint32_t> distinct = in.Varint();
    if (!distinct || *distinct > kMaxRanked) return std::nullopt;
    mapping[0] = hole;
    std::uint32_t value = 0;
    for (std::uint32_t rank = 1; rank <= *distinct; ++rank) {
      const std::optional<std::uint32_t> gap = in.Varint();
      if (!gap || *gap >= kValues - value) return std::nullopt;
      value += *gap;
      mapping[rank] = static_cast<std::uint16_t>(value);
    }
    return *distinct + 1;
  }
};

DepthCodec::DepthCodec() : scratch_(std::make_unique<Scratch>()) {}
DepthCodec::~DepthCodec() = default;

void DepthCodec::Encode(const Image<std::uint16_t>& image, std::vector<std::uint8_t>& payload) {
  Scratch& scratch = *scratch_;
  scratch.FindValues(image);
  scratch.PutMapping(payload);
  PaddedImage& padded = scratch.encoder.image();
  padded.Reset(image.width(), image.height());
  for (int y = 0; y < image.height(); ++y) {
    std::ranges::transform(image.Row(y), padded.Row(y) + 1,
                           [&](std::uint16_t value) { return scratch.mapping[value]; });
  }
  scratch.encoder.Encode(payload);
}

Status DepthCodec::Decode(std::span<const std::uint8_t> payload, Image<std::uint16_t>& image) {
  PayloadReader in(payload);
  const std::optional<std::uint32_t> values = scratch_->GetMapping(in);
  if (!values || !scratch_->decoder.Decode(in, image.width(), image.height())) {
    return DataLoss("depth image is damaged");
  }
  PaddedImage& padded = scratch_->decoder.image();
  std::uint32_t largest = 0;
  for (int y = 0; y < image.height(); ++y) {
    const std::span coded(padded.Row(y) + 1, static_cast<std::size_t>(image.width()));
    std::ranges::transform(coded, image.Row(y).begin(), [&](std::uint16_t value) {
      largest = std::max<std::uint32_t>(largest, value);
      return scratch_->mapping[value];
    });
  }
  return largest < *values ? OkStatus() : DataLoss("depth image is damaged");
}

}  // namespace isotherm::codec
