#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace isotherm {

/// Says how a board differs from its drawing: its warp, a polynomial of the degrees 2 to 4 of the
/// place on the board, and where each feature was really put. `a` and `b` are -1 and 1 at the
/// outermost features.
struct BoardShape {
  static constexpr int kWarpTerms = 12;
  /// Metres, of a^2, ab, b^2, a^3, a^2 b, ab^2, b^3, a^4, a^3 b, a^2 b^2, ab^3, b^4.
  std::array<double, kWarpTerms> warp_m{};
  std::vector<Eigen::Vector2d> offsets_m;  ///< In the plane, of each feature.

  static constexpr int DegreeOf(int term) { return term < 3 ? 2 : term < 7 ? 3 : 4; }

  template <typename T>
  static T WarpZ(const T* warp, const T& a, const T& b) {
    const T a2 = a * a, ab = a * b, b2 = b * b;
    return warp[0] * a2 + warp[1] * ab + warp[2] * b2 + a * (warp[3] * a2 + warp[4] * ab) +
           b * (warp[5] * ab + warp[6] * b2) + a2 * (warp[7] * a2 + warp[8] * ab + warp[9] * b2) +
           b2 * (warp[10] * ab + warp[11] * b2);
  }
  double Z(double a, double b) const { return WarpZ(warp_m.data(), a, b); }
};

}  // namespace isotherm
