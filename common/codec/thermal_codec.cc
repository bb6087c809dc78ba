#include "common/codec/image_codecs.h"
#include "common/codec/strip_decoder.h"
#include "common/codec/strip_encoder.h"

namespace isotherm::codec {

struct ThermalCodec::Scratch {
  StripEncoder<ThermalModel> encoder;
  StripDecoder<ThermalModel> decoder;
};

ThermalCodec::ThermalCodec() : scratch_(std::make_unique<Scratch>()) {}
ThermalCodec::~ThermalCodec() = default;

void ThermalCodec::Encode(const Image<std::uint16_t>& image, std::vector<std::uint8_t>& payload) {
  scratch_->encoder.Encode(image, nullptr, payload);
}

Status ThermalCodec::Decode(std::span<const std::uint8_t> payload, Image<std::uint16_t>& image) {
  PayloadReader in(payload);
  return scratch_->decoder.Decode(in, nullptr, image) ? OkStatus()
                                                      : DataLoss("thermal image is damaged");
}

}  // namespace isotherm::codec
