#include "common/codec/codec.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <utility>

namespace isotherm {
namespace {

Result<Image<std::uint16_t>> DecodeRaw(const EncodedImage& encoded) {
  Image<std::uint16_t> image(encoded.width, encoded.height);
  if (encoded.payload.size() != image.size() * sizeof(std::uint16_t)) {
    return Err(DataLoss(fmt::format("raw image of {} x {} has {} bytes", encoded.width,
                                    encoded.height, encoded.payload.size())));
  }
  const std::uint8_t* bytes = encoded.payload.data();
  for (std::uint16_t& pixel : image.pixels()) {
    pixel = static_cast<std::uint16_t>(bytes[0] | bytes[1] << 8);
    bytes += sizeof(std::uint16_t);
  }
  return image;
}

EncodedImage EncodeRaw(const Image<std::uint16_t>& image) {
  EncodedImage encoded{.encoding = Encoding::kRaw16,
                       .width = image.width(),
                       .height = image.height(),
                       .payload = {}};
  encoded.payload.reserve(image.size() * sizeof(std::uint16_t));
  for (const std::uint16_t pixel : image.pixels()) {
    encoded.payload.push_back(static_cast<std::uint8_t>(pixel));
    encoded.payload.push_back(static_cast<std::uint8_t>(pixel >> 8));
  }
  return encoded;
}

}  // namespace

struct DepthEncoder::Scratch {};
struct ThermalEncoder::Scratch {};
DepthEncoder::DepthEncoder() : scratch_(std::make_unique<Scratch>()) {}
DepthEncoder::~DepthEncoder() = default;
ThermalEncoder::ThermalEncoder() : scratch_(std::make_unique<Scratch>()) {}
ThermalEncoder::~ThermalEncoder() = default;

EncodedImage DepthEncoder::Encode(const Image<std::uint16_t>& depth_raw) {
  return EncodeRaw(depth_raw);
}
EncodedImage ThermalEncoder::Encode(const Image<std::uint16_t>& centikelvin) {
  return EncodeRaw(centikelvin);
}

Result<Image<std::uint16_t>> Decode(const EncodedImage& encoded, std::size_t max_pixels) {
  if (encoded.width <= 0 || encoded.height <= 0 ||
      static_cast<std::size_t>(encoded.width) >
          max_pixels / static_cast<std::size_t>(encoded.height)) {
    return Err(
        DataLoss(fmt::format("image of {} x {} is impossible", encoded.width, encoded.height)));
  }
  if (encoded.encoding == Encoding::kRaw16) return DecodeRaw(encoded);
  return Err(DataLoss(fmt::format("encoding {} is unknown", static_cast<int>(encoded.encoding))));
}

}  // namespace isotherm
