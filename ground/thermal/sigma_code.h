#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace isotherm {

/// A standard uncertainty in 8 bits, as records, kernels and model files have it: the upper bits of
/// a single-precision number, four of its exponent and four of its mantissa. So a step is 3 to 6 %
/// of the value, codes are in the order of their values, and a shift makes one. 0 = not known, 1 to
/// 255 = 1/128 K to 480 K; what lies outside gets the code at the end.
struct SigmaCode {
  static constexpr int kMantissaBits = 4;
  static constexpr int kShift = std::numeric_limits<float>::digits - 1 - kMantissaBits;
  static constexpr float kMin_k = 0.0078125F;
  static constexpr float kMax_k = 480.0F;
  /// Temperatures agree that are no further apart than this many standard uncertainties of their
  /// difference.
  static constexpr float kAgree = 3.0F;
  /// The upper bits of kMin_k exceed its code by this.
  static constexpr std::uint32_t kBias = (std::bit_cast<std::uint32_t>(kMin_k) >> kShift) - 1;

  /// `sigma_k` must not be NaN.
  static std::uint8_t Of(float sigma_k) {
    // Rounds to the nearest code instead of down.
    constexpr std::uint32_t kHalfStep = 1U << (kShift - 1);
    const auto bits = std::bit_cast<std::uint32_t>(std::clamp(sigma_k, kMin_k, kMax_k));
    return static_cast<std::uint8_t>(((bits + kHalfStep) >> kShift) - kBias);
  }
  /// Kelvin; NaN = not known.
  static float Kelvin(std::uint8_t code) {
    return code == 0 ? std::numeric_limits<float>::quiet_NaN()
                     : std::bit_cast<float>((code + kBias) << kShift);
  }
};
static_assert((std::bit_cast<std::uint32_t>(SigmaCode::kMax_k) >> SigmaCode::kShift) -
                  SigmaCode::kBias ==
              255U);

}  // namespace isotherm
