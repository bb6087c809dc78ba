#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

namespace isotherm {

/// Tells whether standard uncertainties are right: of normal errors over them, 68.3 % lie within 1
/// and 95 % within 1.96 (GUM 6.3.3), and their mean is 0.
class SigmaCoverage {
 public:
  static constexpr double kExpected68 = 0.6827;
  static constexpr double kExpected95 = 0.95;
  static constexpr double kSigmasOf95 = 1.96;

  /// Takes an error over its standard uncertainty, with its sign.
  void Add(double ratio) {
    ++count_;
    sum_ += ratio;
    within_68_ += std::abs(ratio) <= 1.0 ? 1 : 0;
    within_95_ += std::abs(ratio) <= kSigmasOf95 ? 1 : 0;
  }

  std::uint64_t count() const { return count_; }
  // NaN of nothing.
  double within_68() const { return PerCount(static_cast<double>(within_68_)); }
  double within_95() const { return PerCount(static_cast<double>(within_95_)); }
  double mean() const { return PerCount(sum_); }

 private:
  double PerCount(double sum) const {
    return count_ == 0 ? std::numeric_limits<double>::quiet_NaN()
                       : sum / static_cast<double>(count_);
  }

  std::uint64_t count_ = 0, within_68_ = 0, within_95_ = 0;
  double sum_ = 0.0;
};

}  // namespace isotherm
