#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

namespace isotherm::codec {

/// Image with one column of padding on either side: cells 0 and width + 1 of each row. It has an
/// upper and a lower half that do not depend on each other; a row of zeros stands above each. Keeps
/// its memory. Thread-compatible.
class PaddedImage {
 public:
  void Reset(int width, int height) {
    width_ = width;
    height_ = height;
    cells_.resize((static_cast<std::size_t>(height) + 1) * stride());
    std::fill_n(cells_.begin(), stride(), std::uint16_t{0});
  }
  int width() const { return width_; }
  int height() const { return height_; }
  int FirstRow(int half) const { return half == 0 ? 0 : (height_ + 1) / 2; }
  int EndRow(int half) const { return half == 0 ? FirstRow(1) : height_; }

  std::uint16_t* Row(int y) { return cells_.data() + (static_cast<std::size_t>(y) + 1) * stride(); }
  /// The row that predicts row `y`.
  const std::uint16_t* RowAbove(int y) {
    return y == FirstRow(1) ? cells_.data() : Row(y) - stride();
  }
  /// Call this before a row is coded.
  void PadLeft(int y) { Row(y)[0] = RowAbove(y)[1]; }
  /// Call this when a row is complete.
  void PadRight(int y) { Row(y)[width_ + 1] = Row(y)[width_]; }

 private:
  std::size_t stride() const { return static_cast<std::size_t>(width_) + 2; }

  int width_ = 0;
  int height_ = 0;
  std::vector<std::uint16_t> cells_;
};

}  // namespace isotherm::codec
