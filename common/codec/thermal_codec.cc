#include <algorithm>

#include "common/codec/image_codecs.h"
#include "common/codec/predictive_decoder.h"
#include "common/codec/predictive_encoder.h"

namespace isotherm::codec {
struct ThermalCodec::Scratch {
  PredictiveEncoder<ThermalModel> encoder;
  PredictiveDecoder<ThermalModel> decoder;
};

ThermalCodec::ThermalCodec() : scratch_(std::make_unique<Scratch>()) {}
ThermalCodec::~ThermalCodec() = default;

void ThermalCodec::Encode(const Image<std::uint16_t>& image, std::vector<std::uint8_t>& payload) {
  PaddedImage& padded = scratch_->encoder.image();
  padded.Reset(image.width(), image.height());
  for (int y = 0; y < image.height(); ++y) std::ranges::copy(image.Row(y), padded.Row(y) + 1);
  scratch_->encoder.Encode(payload);
}

Status ThermalCodec::Decode(std::span<const std::uint8_t> payload, Image<std::uint16_t>& image) {
  PayloadReader in(payload);
  if (!scratch_->decoder.Decode(in, image.width(), image.height())) {
    return DataLoss("thermal image is damaged");
  }
  PaddedImage& padded = scratch_->decoder.image();
  for (int y = 0; y < image.height(); ++y) {
    std::copy_n(padded.Row(y) + 1, image.width(), image.Row(y).begin());
  }
  return OkStatus();
}

}  // namespace isotherm::codec
