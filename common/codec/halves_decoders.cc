#include "common/codec/halves_decoders.h"

#include <algorithm>
#include <optional>

namespace isotherm::codec {

Status DepthHalvesDecoder::Decode(std::span<const std::uint8_t> payload,
                                  Image<std::uint16_t>& image) {
  PayloadReader in(payload);
  const std::optional<std::uint32_t> values = values_.Get(in);
  if (!values || !decoder_.Decode(in, image.width(), image.height()))
    return DataLoss("depth image is damaged");
  PaddedImage& padded = decoder_.image();
  std::uint32_t largest = 0;
  for (int y = 0; y < image.height(); ++y) {
    const std::span coded(padded.Row(y) + 1, static_cast<std::size_t>(image.width()));
    std::ranges::transform(coded, image.Row(y).begin(), [&](std::uint16_t value) {
      largest = std::max<std::uint32_t>(largest, value);
      return values_.mapping()[value];
    });
  }
  return largest < *values ? OkStatus() : DataLoss("depth image is damaged");
}

Status ThermalHalvesDecoder::Decode(std::span<const std::uint8_t> payload,
                                    Image<std::uint16_t>& image) {
  PayloadReader in(payload);
  if (!decoder_.Decode(in, image.width(), image.height()))
    return DataLoss("thermal image is damaged");
  PaddedImage& padded = decoder_.image();
  for (int y = 0; y < image.height(); ++y)
    std::copy_n(padded.Row(y) + 1, image.width(), image.Row(y).begin());
  return OkStatus();
}

}  // namespace isotherm::codec
