#include "common/codec/depth_values.h"

#include <algorithm>
#include <cstddef>

#include "common/frame/frame.h"

namespace isotherm::codec {
namespace {

/// With more values a table of them costs more than it saves.
constexpr std::size_t kMaxRanked = 2048;

/// First byte of a payload.
constexpr std::uint8_t kHoleIs65535 = 1;  ///< Otherwise it is 0.
constexpr std::uint8_t kRanked = 2;       ///< A table of the values follows.

}  // namespace

void DepthValues::Find(const Image<std::uint16_t>& image) {
  std::fill(occurs_.begin(), occurs_.end(), std::uint8_t{0});
  for (const std::uint16_t value : image.pixels()) occurs_[value] = 1;
  hole_ = kNoDepth;
  if (occurs_[kNoDepthSaturated] == 0) return;
  const auto saturated = std::ranges::count(image.pixels(), kNoDepthSaturated);
  if (saturated > std::ranges::count(image.pixels(), kNoDepth)) hole_ = kNoDepthSaturated;
}

void DepthValues::Put(const Image<std::uint16_t>& image, std::vector<std::uint8_t>& payload) {
  Find(image);
  occurs_[hole_] = 0;
  const auto distinct = static_cast<std::size_t>(std::count(occurs_.begin(), occurs_.end(), 1));
  const bool ranked = distinct <= kMaxRanked;
  payload.push_back(
      static_cast<std::uint8_t>((hole_ != 0 ? kHoleIs65535 : 0) | (ranked ? kRanked : 0)));
  mapping_[hole_] = 0;
  if (!ranked) {
    for (std::uint32_t value = 0; value < kValues; ++value)
      mapping_[value] = static_cast<std::uint16_t>(value - hole_);
    return;
  }
  PutVarint(static_cast<std::uint32_t>(distinct), payload);
  std::uint32_t previous = 0;
  std::uint16_t rank = 0;
  for (std::uint32_t value = 0; value < kValues; ++value) {
    if (occurs_[value] == 0) continue;
    mapping_[value] = ++rank;
    PutVarint(value - previous, payload);
    previous = value;
  }
}

std::optional<std::uint32_t> DepthValues::Get(PayloadReader& in) {
  const std::optional<std::uint8_t> flags = in.Byte();
  if (!flags || *flags > (kHoleIs65535 | kRanked)) return std::nullopt;
  hole_ = (*flags & kHoleIs65535) != 0 ? kNoDepthSaturated : kNoDepth;
  if ((*flags & kRanked) == 0) {
    for (std::uint32_t value = 0; value < kValues; ++value)
      mapping_[value] = static_cast<std::uint16_t>(value + hole_);
    return kValues;
  }
  const std::optional<std::uint32_t> distinct = in.Varint();
  if (!distinct || *distinct > kMaxRanked) return std::nullopt;
  mapping_[0] = hole_;
  std::uint32_t value = 0;
  for (std::uint32_t rank = 1; rank <= *distinct; ++rank) {
    const std::optional<std::uint32_t> gap = in.Varint();
    if (!gap || *gap >= kValues - value) return std::nullopt;
    value += *gap;
    mapping_[rank] = static_cast<std::uint16_t>(value);
  }
  return *distinct + 1;
}

}  // namespace isotherm::codec
