#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "common/frame/image.h"

namespace isotherm {

/// Names what depth cameras and their drivers leave out or get wrong. It is done to a finished
/// image.
enum class DepthDefect : std::uint8_t {
  kNone,
  /// Every third row and column is empty, as after registration to a camera of more pixels, and
  /// 19 % of the other pixels: 64 % have no depth.
  kGrid,
  kCoarseGrid,   ///< Two of five rows and columns are empty: 64 % have no depth.
  kRandom,       ///< 60 % have no depth, others in each frame.
  kRows,         ///< Every second row is empty, from the first on.
  kColumns,      ///< Every second column is empty, from the first on.
  kFlyingPixels  ///< 30 % of the pixels at depth edges lie between the surfaces.
};

/// All but kNone.
inline constexpr std::array kDepthDefects = {DepthDefect::kGrid,    DepthDefect::kCoarseGrid,
                                             DepthDefect::kRandom,  DepthDefect::kRows,
                                             DepthDefect::kColumns, DepthDefect::kFlyingPixels};

/// "coarse-grid", as command lines and recordings name it.
std::string_view ToString(DepthDefect defect);

/// Puts this fraction of the pixels at depth edges between the surfaces. The same `noise_stream`
/// gives the same ones.
void AddFlyingPixels(double fraction, std::uint64_t noise_stream, Image<std::uint16_t>& depth_raw);

/// The same `noise_stream` gives the same defects. 0 = no return, in and out.
void AddDefect(DepthDefect defect, std::uint64_t noise_stream, Image<std::uint16_t>& depth_raw);

}  // namespace isotherm
