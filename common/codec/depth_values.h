#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/codec/byte_io.h"
#include "common/frame/image.h"

namespace isotherm::codec {

/// Says what the pixels of a depth image are packed as. A camera that measures disparity can tell
/// only some 300 depths between 0.4 and 1.4 m apart, so that pixels become their rank among the
/// values that occur; a hole becomes 0. With many values they stay as they are. Keeps its memory.
/// Thread-compatible.
class DepthValues {
 public:
  /// Finds what the pixels of an image become, and writes how to invert it.
  void Put(const Image<std::uint16_t>& image, std::vector<std::uint8_t>& payload);
  /// Reads how to invert it; returns how many packed values there are, nothing if it is damaged.
  std::optional<std::uint32_t> Get(PayloadReader& in);
  /// After Put the packed value of each pixel value; after Get the pixel value of each packed one.
  const std::uint16_t* mapping() const { return mapping_.data(); }

 private:
  static constexpr std::uint32_t kValues = 1U << 16;

  void Find(const Image<std::uint16_t>& image);

  std::uint16_t hole_ = 0;
  std::vector<std::uint8_t> occurs_ = std::vector<std::uint8_t>(kValues);
  std::vector<std::uint16_t> mapping_ = std::vector<std::uint16_t>(kValues);
};

}  // namespace isotherm::codec
