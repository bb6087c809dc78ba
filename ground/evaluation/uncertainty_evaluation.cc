#include "ground/evaluation/uncertainty_evaluation.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "common/base/quantile.h"

namespace isotherm {
namespace {

constexpr double kNearlyAll = 0.95;

/// The last range that begins at or below `value`.
template <std::size_t N>
std::optional<std::size_t> RangeOf(const std::array<double, N>& from, double value) {
  const auto above = std::upper_bound(from.begin(), from.end(), value);
  if (std::isnan(value) || above == from.begin()) return std::nullopt;
  return static_cast<std::size_t>(above - from.begin()) - 1;
}

/// Errors and uncertainties of one cell of the table.
struct CellValues {
  std::vector<double> magnitudes_k;
  std::vector<double> sigmas_k;
};

ErrorCell Describe(CellValues& values) {
  ErrorCell cell;
  cell.count = values.magnitudes_k.size();
  if (cell.count == 0) return cell;
  cell.median_k = TakeMedian(values.magnitudes_k);
  cell.p95_k = TakeQuantile(values.magnitudes_k, kNearlyAll);
  if (!values.sigmas_k.empty()) cell.median_sigma_k = TakeMedian(values.sigmas_k);
  return cell;
}

ErrorTable MakeTable(std::span<const AssessedError> errors) {
  constexpr std::size_t kRows = ErrorTable::kFrom_m.size();
  constexpr std::size_t kColumns = ErrorTable::kFrom_deg.size();
  std::array<std::array<CellValues, kColumns>, kRows> values;
  for (const AssessedError& error : errors) {
    const auto row = RangeOf(ErrorTable::kFrom_m, error.distance_m);
    const auto column = RangeOf(ErrorTable::kFrom_deg, error.angle_deg);
    if (!row || !column) continue;
    CellValues& cell = values[*row][*column];
    cell.magnitudes_k.push_back(std::abs(error.error_k));
    if (!std::isnan(error.sigma_k)) cell.sigmas_k.push_back(error.sigma_k);
  }
  ErrorTable table;
  for (std::size_t row = 0; row < kRows; ++row) {
    for (std::size_t column = 0; column < kColumns; ++column)
      table.cells[row][column] = Describe(values[row][column]);
  }
  return table;
}

}  // namespace

void Histogram::Add(double value) {
  if (value < -kEnd) {
    ++below;
  } else if (value >= kEnd) {
    ++above;
  } else {
    ++counts[std::min(static_cast<std::size_t>((value + kEnd) / kWidth), kBins - 1)];
  }
}

UncertaintyReport EvaluateUncertainty(std::span<const AssessedError> errors) {
  UncertaintyReport report;
  report.table = MakeTable(errors);
  std::vector<double> sigmas_k;
  for (const AssessedError& error : errors) {
    if (!(error.sigma_k > 0.0)) {
      ++report.unknown;
      continue;
    }
    const double ratio = error.error_k / std::hypot(error.sigma_k, error.expected_sigma_k);
    sigmas_k.push_back(error.sigma_k);
    report.ratios.Add(ratio);
    report.coverage.Add(ratio);
  }
  if (sigmas_k.empty()) return report;
  report.median_sigma_k = TakeMedian(sigmas_k);
  report.p95_sigma_k = TakeQuantile(sigmas_k, kNearlyAll);
  return report;
}

}  // namespace isotherm
