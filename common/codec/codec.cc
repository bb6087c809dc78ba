#include "common/codec/codec.h"

#include <fmt/format.h>

#include <utility>

#include "common/codec/halves_decoders.h"
#include "common/codec/image_codecs.h"
#include "common/png/png.h"

namespace isotherm {
namespace {

Status DecodeRaw(std::span<const std::uint8_t> payload, Image<std::uint16_t>& image) {
  const std::uint8_t* byte = payload.data();
  for (std::uint16_t& pixel : image.pixels()) {
    // Little-endian whatever the computer; compilers make one load of it.
    pixel = static_cast<std::uint16_t>(byte[0] | byte[1] << 8);
    byte += sizeof(pixel);
  }
  return OkStatus();
}

/// An image cannot be larger than its payload allows: a guard against allocating much for a few
/// bytes. The codes need no bits for a pixel that is certain, so the bound is loose for them.
Status CheckSizes(const EncodedImage& encoded, std::size_t max_pixels) {
  if (encoded.width <= 0 || encoded.height <= 0 ||
      static_cast<std::size_t>(encoded.width) >
          max_pixels / static_cast<std::size_t>(encoded.height)) {
    return DataLoss(fmt::format("image of {} x {} pixels is impossible or exceeds the limit of {}",
                                encoded.width, encoded.height, max_pixels));
  }
  const std::size_t raw_bytes = static_cast<std::size_t>(encoded.width) *
                                static_cast<std::size_t>(encoded.height) * sizeof(std::uint16_t);
  if (IsRaw(encoded.encoding) && encoded.payload.size() != raw_bytes) {
    return DataLoss(fmt::format("raw image of {} x {} has {} bytes instead of {}", encoded.width,
                                encoded.height, encoded.payload.size(), raw_bytes));
  }
  return OkStatus();
}

template <typename Decoder>
Status DecodeWith(std::span<const std::uint8_t> payload, Image<std::uint16_t>& image) {
  thread_local Decoder decoder;
  return decoder.Decode(payload, image);
}

Status DecodePixels(const EncodedImage& encoded, Image<std::uint16_t>& image) {
  switch (encoded.encoding) {
    case Encoding::kRaw16:
    case Encoding::kCounts16:
    case Encoding::kScaledRaw16:
      return DecodeRaw(encoded.payload, image);
    case Encoding::kPng16:
      return DecodeGrey16Png(encoded.payload, image);
    // Their tables are large: they are kept for each thread that decodes.
    case Encoding::kDepthRans:
      return DecodeWith<codec::DepthHalvesDecoder>(encoded.payload, image);
    case Encoding::kThermalRans:
    case Encoding::kScaledThermalRans:
      return DecodeWith<codec::ThermalHalvesDecoder>(encoded.payload, image);
    case Encoding::kDepthStrips:
      return DecodeWith<codec::DepthCodec>(encoded.payload, image);
    case Encoding::kThermalStrips:
    case Encoding::kScaledThermalStrips:
      return DecodeWith<codec::ThermalCodec>(encoded.payload, image);
  }
  return DataLoss(
      fmt::format("encoding {} is unknown: update Isotherm", static_cast<int>(encoded.encoding)));
}

}  // namespace

struct DepthEncoder::Scratch {
  codec::DepthCodec codec;
};
struct ThermalEncoder::Scratch {
  codec::ThermalCodec codec;
};

DepthEncoder::DepthEncoder() : scratch_(std::make_unique<Scratch>()) {}
DepthEncoder::~DepthEncoder() = default;
ThermalEncoder::ThermalEncoder() : scratch_(std::make_unique<Scratch>()) {}
ThermalEncoder::~ThermalEncoder() = default;

Encoding TemperatureEncoding(const RadiometricScale& scale) {
  return scale == kCentikelvin ? Encoding::kThermalStrips : Encoding::kScaledThermalStrips;
}

EncodedImage DepthEncoder::Encode(const Image<std::uint16_t>& depth_raw) {
  EncodedImage encoded{.encoding = Encoding::kDepthStrips,
                       .width = depth_raw.width(),
                       .height = depth_raw.height(),
                       .payload = {}};
  scratch_->codec.Encode(depth_raw, encoded.payload);
  return encoded;
}

EncodedImage ThermalEncoder::Encode(const Image<std::uint16_t>& temperature_raw,
                                    const RadiometricScale& scale) {
  EncodedImage encoded{.encoding = TemperatureEncoding(scale),
                       .width = temperature_raw.width(),
                       .height = temperature_raw.height(),
                       .payload = {}};
  scratch_->codec.Encode(temperature_raw, encoded.payload);
  return encoded;
}

EncodedImage PackCounts(const Image<std::uint16_t>& counts) {
  EncodedImage packed{.encoding = Encoding::kCounts16,
                      .width = counts.width(),
                      .height = counts.height(),
                      .payload = {}};
  packed.payload.reserve(counts.size() * sizeof(std::uint16_t));
  for (const std::uint16_t count : counts.pixels()) {
    packed.payload.push_back(static_cast<std::uint8_t>(count));
    packed.payload.push_back(static_cast<std::uint8_t>(count >> 8));
  }
  return packed;
}

Result<Image<std::uint16_t>> DecodeTemperatures(const EncodedImage& encoded,
                                                std::size_t max_pixels) {
  Result<Image<std::uint16_t>> image = Decode(encoded, max_pixels);
  // Counts without a scale must not pass for temperatures.
  if (image && encoded.encoding == Encoding::kCounts16) return Image<std::uint16_t>();
  return image;
}

Result<Image<std::uint16_t>> Decode(const EncodedImage& encoded, std::size_t max_pixels) {
  if (Status status = CheckSizes(encoded, max_pixels); !status.ok()) return Err(std::move(status));
  Image<std::uint16_t> image(encoded.width, encoded.height);
  if (Status status = DecodePixels(encoded, image); !status.ok()) return Err(std::move(status));
  return image;
}

}  // namespace isotherm
