#pragma once

#include <array>
#include <cstdint>

namespace isotherm {

/// Counts how long a stage took, over any number of calls in constant memory: a histogram with bins
/// 1 % wide from 100 ns to about three hours. Percentiles are right to 0.5 %. Thread-compatible.
class StageStats {
 public:
  /// Durations that are negative or not finite are bugs of the caller's clock; they are counted as
  /// 0.
  void Add(double ms);
  /// Adds to the processor time that the calls so far took on all threads together.
  void AddProcessorTime(double ms) { processor_ms_ += ms; }

  std::uint64_t count() const { return count_; }
  /// All 0 before the first Add.
  double mean_ms() const { return count_ == 0 ? 0.0 : total_ms_ / static_cast<double>(count_); }
  double total_ms() const { return total_ms_; }
  /// 0 where nobody counts it.
  double processor_ms() const { return processor_ms_; }
  double min_ms() const { return min_ms_; }
  double max_ms() const { return max_ms_; }
  /// The duration that `percent` of the calls (0..100, nearest rank) did not exceed.
  double Percentile(double percent) const;

 private:
  /// ln(1e11) / ln(1.01): 100 ns to three hours in steps of a percent.
  static constexpr int kBins = 2560;
  static int BinOf(double ms);

  std::array<std::uint32_t, kBins> bins_{};
  std::uint64_t count_ = 0;
  double total_ms_ = 0.0;
  double processor_ms_ = 0.0;
  double min_ms_ = 0.0;
  double max_ms_ = 0.0;
};

}  // namespace isotherm
