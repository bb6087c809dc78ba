#include <algorithm>
#include <array>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "common/codec/image_codecs.h"

namespace isotherm::codec {
namespace {

/// True if the payload starts like a 16-bit grey PNG of this size: checked before the decoder
/// allocates anything.
bool HasHeaderFor(std::span<const std::uint8_t> payload, const Image<std::uint16_t>& image) {
  constexpr std::array<std::uint8_t, 16> kStart = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n',
                                                   0,    0,   0,   13,  'I',  'H',  'D',  'R'};
  constexpr std::size_t kHeaderBytes = kStart.size() + 4 + 4 + 2;
  if (payload.size() < kHeaderBytes || !std::equal(kStart.begin(), kStart.end(), payload.begin())) {
    return false;
  }
  const auto number = [&payload](std::size_t at) {
    return std::uint32_t{payload[at]} << 24 | std::uint32_t{payload[at + 1]} << 16 |
           std::uint32_t{payload[at + 2]} << 8 | payload[at + 3];
  };
  constexpr std::uint8_t kBits = 16;
  constexpr std::uint8_t kGrey = 0;
  return number(16) == static_cast<std::uint32_t>(image.width()) &&
         number(20) == static_cast<std::uint32_t>(image.height()) && payload[24] == kBits &&
         payload[25] == kGrey;
}

/// OpenCV decodes truncated files to half an image: the end chunk must be there.
bool HasEnd(std::span<const std::uint8_t> payload) {
  constexpr std::array<std::uint8_t, 12> kEnd = {0,   0,   0,    0,    'I',  'E',
                                                 'N', 'D', 0xAE, 0x42, 0x60, 0x82};
  return payload.size() >= kEnd.size() &&
         std::equal(kEnd.begin(), kEnd.end(), payload.end() - kEnd.size());
}

}  // namespace

Status DecodePng(std::span<const std::uint8_t> payload, Image<std::uint16_t>& image) {
  if (!HasHeaderFor(payload, image))
    return DataLoss("is not a 16-bit grey PNG of the announced size");
  if (!HasEnd(payload)) return DataLoss("PNG is truncated");
  try {
    const cv::Mat bytes(1, static_cast<int>(payload.size()), CV_8UC1,
                        const_cast<std::uint8_t*>(payload.data()));
    cv::Mat pixels(image.height(), image.width(), CV_16UC1, image.data());
    const cv::Mat decoded = cv::imdecode(bytes, cv::IMREAD_UNCHANGED);
    if (decoded.size() != pixels.size() || decoded.type() != pixels.type()) {
      return DataLoss("PNG is damaged");
    }
    decoded.copyTo(pixels);
  } catch (const cv::Exception& error) {
    return DataLoss(error.what());
  }
  return OkStatus();
}

}  // namespace isotherm::codec
