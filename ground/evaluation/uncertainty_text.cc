#include "ground/evaluation/uncertainty_text.h"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>

namespace isotherm {
namespace {

Json TableJson(const ErrorTable& table) {
  Json json;
  json["distance_from_m"] = ErrorTable::kFrom_m;
  json["angle_from_deg"] = ErrorTable::kFrom_deg;
  for (const auto& row : table.cells) {
    Json cells;
    for (const ErrorCell& cell : row) {
      Json entry;
      entry["count"] = cell.count;
      entry["median_kelvin"] = cell.median_k;
      entry["p95_kelvin"] = cell.p95_k;
      entry["median_sigma_kelvin"] = cell.median_sigma_k;
      cells.push_back(std::move(entry));
    }
    json["rows"].push_back(std::move(cells));
  }
  return json;
}

std::string HistogramText(const Histogram& histogram, std::size_t points) {
  // The fullest bin of a right histogram holds 19 %, which is 38 marks: it fits a terminal.
  constexpr double kPercentPerMark = 0.5;
  std::string text = "  histogram of error / sigma, % of the points\n";
  const auto add = [&](const std::string& range, std::size_t count) {
    const double percent = 100.0 * static_cast<double>(count) / static_cast<double>(points);
    text += fmt::format("  {:>14} {:6.2f} {}\n", range, percent,
                        std::string(static_cast<std::size_t>(percent / kPercentPerMark), '#'));
  };
  add(fmt::format("below {:+.1f}", -Histogram::kEnd), histogram.below);
  for (std::size_t i = 0; i < Histogram::kBins; ++i) {
    const double from = static_cast<double>(i) * Histogram::kWidth - Histogram::kEnd;
    add(fmt::format("{:+.1f} to {:+.1f}", from, from + Histogram::kWidth), histogram.counts[i]);
  }
  add(fmt::format("above {:+.1f}", Histogram::kEnd), histogram.above);
  return text;
}

/// The name of the range that begins at `from[i]`.
template <std::size_t N>
std::string RangeName(const std::array<double, N>& from, std::size_t i, std::string_view unit) {
  if (i + 1 == N) return fmt::format("from {:g} {}", from[i], unit);
  return fmt::format("{:g} to {:g} {}", from[i], from[i + 1], unit);
}

/// No quantiles of a few points.
std::string CellText(const ErrorCell& cell) {
  // Below 20 values the 95 % quantile is the largest one.
  constexpr std::size_t kMinCount = 20;
  if (cell.count == 0) return "-";
  if (cell.count < kMinCount) return fmt::format("- ({})", cell.count);
  return fmt::format("{:.2f} / {:.2f} ({})", cell.median_k, cell.p95_k, cell.count);
}

std::string TableText(const ErrorTable& table) {
  std::string text = "  |error| by distance and angle: median / 95 % in K (points)\n";
  text += fmt::format("  {:>14}", "");
  for (std::size_t column = 0; column < ErrorTable::kFrom_deg.size(); ++column)
    text += fmt::format("{:>24}", RangeName(ErrorTable::kFrom_deg, column, "deg"));
  text += "\n";
  for (std::size_t row = 0; row < ErrorTable::kFrom_m.size(); ++row) {
    text += fmt::format("  {:>14}", RangeName(ErrorTable::kFrom_m, row, "m"));
    for (const ErrorCell& cell : table.cells[row]) text += fmt::format("{:>24}", CellText(cell));
    text += "\n";
  }
  return text;
}

}  // namespace

std::string ToText(const UncertaintyReport& report) {
  if (report.coverage.count() == 0) {
    return "  uncertainty               the cloud has none (scalar_temperature_sigma)\n" +
           TableText(report.table);
  }
  std::string text = fmt::format(
      "  {:<26}{} points  sigma median {:.3f}  95 % {:.3f} K\n"
      "  {:<26}{:.1f} % within sigma (68.3 if it is right), {:.1f} % within 1.96 sigma (95.0)\n",
      "uncertainty", report.coverage.count(), report.median_sigma_k, report.p95_sigma_k,
      "  coverage", 100.0 * report.coverage.within_68(), 100.0 * report.coverage.within_95());
  return text + HistogramText(report.ratios, report.coverage.count()) + TableText(report.table);
}

Json ToJson(const UncertaintyReport& report) {
  Json json;
  json["count"] = report.coverage.count();
  json["not_known"] = report.unknown;
  json["within_1_sigma"] = report.coverage.within_68();
  json["within_1_96_sigma"] = report.coverage.within_95();
  json["mean_error_over_sigma"] = report.coverage.mean();
  json["median_sigma_kelvin"] = report.median_sigma_k;
  json["p95_sigma_kelvin"] = report.p95_sigma_k;
  Json& histogram = json["error_over_sigma"];
  histogram["from"] = -Histogram::kEnd;
  histogram["width"] = Histogram::kWidth;
  histogram["counts"] = report.ratios.counts;
  histogram["below"] = report.ratios.below;
  histogram["above"] = report.ratios.above;
  json["absolute_error"] = TableJson(report.table);
  return json;
}

}  // namespace isotherm
