#include "ground/renderer/png.h"

#include <opencv2/imgcodecs.hpp>
#include <string>

namespace isotherm {
namespace {

// Of zlib, 0..9: half the size that OpenCV's own choice (run lengths only) gives shaded surfaces.
constexpr int kCompression = 6;

}  // namespace

Result<std::vector<std::uint8_t>> EncodePng(const RgbImage& picture) {
  if (picture.empty()) return Err(InvalidArgument("a picture without pixels cannot become a PNG"));
  cv::Mat bgr(picture.height(), picture.width(), CV_8UC3);
  for (int y = 0; y < picture.height(); ++y) {
    std::uint8_t* out = bgr.ptr(y);
    for (const Rgb8& pixel : picture.Row(y)) {
      *out++ = pixel.b;
      *out++ = pixel.g;
      *out++ = pixel.r;
    }
  }
  try {
    std::vector<std::uint8_t> bytes;
    if (cv::imencode(".png", bgr, bytes, {cv::IMWRITE_PNG_COMPRESSION, kCompression})) return bytes;
  } catch (const cv::Exception& exception) {
    return Err(Internal(std::string("encoding a PNG: ") + exception.what()));
  }
  return Err(Internal("encoding a PNG failed"));
}

}  // namespace isotherm
