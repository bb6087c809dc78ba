#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/codec/strip_kernel.h"

namespace isotherm::codec {

/// The row of all strips that is coded, and the one above it, interleaved as the kernels take them.
/// Keeps its memory. Thread-compatible.
template <typename Model>
class StripRowPair {
 public:
  /// Begins an image.
  void Reset(int width) {
    width_ = width;
    is_first_ = true;
    for (std::vector<std::uint16_t>& cells : cells_)
      cells.resize((static_cast<std::size_t>(width) + 1) * kStrips);
  }
  /// The row that is coded now.
  StripRow Get() {
    constexpr std::size_t kFilled = Model::kHasHoles ? 2 : 0;
    return {.width = width_,
            .is_first = is_first_,
            .row = cells_[now_].data(),
            .filled = cells_[kFilled + now_].data(),
            .above = cells_[1 - now_].data(),
            .filled_above = cells_[kFilled + 1 - now_].data()};
  }
  /// Goes on to the row below.
  void Next() {
    now_ = 1 - now_;
    is_first_ = false;
  }

 private:
  int width_ = 0;
  bool is_first_ = true;
  std::size_t now_ = 0;
  /// Two rows, and for models with holes the same without them.
  std::array<std::vector<std::uint16_t>, Model::kHasHoles ? 4 : 2> cells_;
};

}  // namespace isotherm::codec
