#include "common/base/stage_stats.h"

#include <algorithm>
#include <cmath>

namespace isotherm {
namespace {

/// Durations below 100 ns are not told apart.
constexpr double kMin_ms = 1e-4;
/// Each bin is a percent wider than the one before, so that quantiles are right within half a
/// percent; kBins of them reach from 100 ns to three hours.
constexpr double kBinRatio = 1.01;

}  // namespace

int StageStats::BinOf(double ms) {
  if (ms <= kMin_ms) return 0;
  const int bin = static_cast<int>(std::log(ms / kMin_ms) / std::log(kBinRatio)) + 1;
  return std::min(bin, kBins - 1);
}

void StageStats::Add(double ms) {
  if (!std::isfinite(ms) || ms < 0.0) ms = 0.0;
  min_ms_ = count_ == 0 ? ms : std::min(min_ms_, ms);
  max_ms_ = std::max(max_ms_, ms);
  total_ms_ += ms;
  ++count_;
  ++bins_[static_cast<std::size_t>(BinOf(ms))];
}

double StageStats::Percentile(double percent) const {
  if (count_ == 0) return 0.0;
  const double fraction = std::clamp(percent, 0.0, 100.0) / 100.0;
  const auto rank = std::max<std::uint64_t>(
      1, static_cast<std::uint64_t>(std::ceil(fraction * static_cast<double>(count_))));
  if (rank == count_) return max_ms_;
  std::uint64_t seen = 0;
  int bin = 0;
  for (; bin < kBins - 1; ++bin) {
    seen += bins_[static_cast<std::size_t>(bin)];
    if (seen >= rank) break;
  }
  // Bin b > 0 covers [kBinRatio^(b-1), kBinRatio^b) times the smallest; its geometric middle halves
  // the error.
  const double middle_ms = kMin_ms * std::pow(kBinRatio, bin - 0.5);
  return std::clamp(middle_ms, min_ms_, max_ms_);
}

}  // namespace isotherm
