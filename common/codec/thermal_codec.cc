#include <algorithm>
#include <bit>

#include "common/codec/image_codecs.h"
#include "common/codec/predictive_coder.h"

namespace isotherm::codec {
namespace {

std::uint32_t Distance(std::uint32_t a, std::uint32_t b) { return a > b ? a - b : b - a; }

/// Median edge detector (Weinberger, Seroussi, Sapiro, "LOCO-I", 2000): the plane through the
/// neighbours or, at an edge, the neighbour on the pixel's side. The context is how much the
/// neighbours differ: it tells flat areas, where the difference is the camera's noise, from edges.
struct ThermalModel {
  static constexpr std::uint32_t kContexts = 12;
  static constexpr bool kHasHoles = false;

  static Prediction Predict(std::uint32_t w, std::uint32_t n, std::uint32_t nw, std::uint32_t ne) {
    const std::uint32_t least = std::min(w, n);
    const std::uint32_t most = std::max(w, n);
    const std::uint32_t plane = w + n - std::clamp(nw, least, most);
    const std::uint32_t activity = Distance(w, nw) + Distance(n, nw) + Distance(n, ne);
    return {
        .value = plane,
        .context = std::min(static_cast<std::uint32_t>(std::bit_width(activity)), kContexts - 1)};
  }
};

}  // namespace

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
  scratch_->encoder.Encode(image.width(), image.height(), payload);
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
