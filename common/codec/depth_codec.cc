#include "common/codec/depth_values.h"
#include "common/codec/image_codecs.h"
#include "common/codec/strip_decoder.h"
#include "common/codec/strip_encoder.h"

namespace isotherm::codec {

struct DepthCodec::Scratch {
  DepthValues values;
  StripEncoder<DepthModel> encoder;
  StripDecoder<DepthModel> decoder;
};

DepthCodec::DepthCodec() : scratch_(std::make_unique<Scratch>()) {}
DepthCodec::~DepthCodec() = default;

void DepthCodec::Encode(const Image<std::uint16_t>& image, std::vector<std::uint8_t>& payload) {
  scratch_->values.Put(image, payload);
  scratch_->encoder.Encode(image, scratch_->values.mapping(), payload);
}

Status DepthCodec::Decode(std::span<const std::uint8_t> payload, Image<std::uint16_t>& image) {
  PayloadReader in(payload);
  const std::optional<std::uint32_t> values = scratch_->values.Get(in);
  if (!values) return DataLoss("depth image is damaged");
  const auto largest = scratch_->decoder.Decode(in, scratch_->values.mapping(), image);
  return largest && *largest < *values ? OkStatus() : DataLoss("depth image is damaged");
}

}  // namespace isotherm::codec
