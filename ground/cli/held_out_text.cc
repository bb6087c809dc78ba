#include "ground/cli/held_out_text.h"

#include <fmt/format.h>

#include <limits>
#include <nlohmann/json.hpp>

namespace isotherm {
namespace {

double Ratio(double part, std::uint64_t whole) {
  return whole == 0 ? std::numeric_limits<double>::quiet_NaN() : part / static_cast<double>(whole);
}

double Ratio(std::uint64_t part, std::uint64_t whole) {
  return Ratio(static_cast<double>(part), whole);
}

}  // namespace

std::string ToText(const HeldOutReport& report) {
  std::string text = fmt::format("held-out views: {} thermal frames predicted", report.frames);
  if (report.without_pose > 0) text += fmt::format(", {} without a pose", report.without_pose);
  if (report.wrong_size > 0) text += fmt::format(", {} of another size", report.wrong_size);
  if (report.undecodable > 0)
    text += fmt::format("; {} damaged ones could not be held out", report.undecodable);
  text += fmt::format(
      "\n  {:<26}{:.2f} % of {} pixels have a predicted temperature ({:.2f} % of those that show "
      "the model's surface)\n",
      "assigned", 100.0 * Ratio(report.assigned, report.pixels), report.pixels,
      100.0 * Ratio(report.assigned, report.on_surface));
  text += fmt::format("  {:<26}mean of |error| {:.3f} °C, mean {:+.3f} °C\n", "shown - predicted",
                      Ratio(report.sum_of_magnitudes_k, report.assigned),
                      Ratio(report.sum_k, report.assigned));
  if (report.coverage.count() == 0) return text;
  return text + fmt::format(
                    "  {:<26}{:.1f} % within sigma, {:.1f} % within 1.96 sigma, mean {:+.2f} "
                    "sigma\n",
                    "error / sigma", 100.0 * report.coverage.within_68(),
                    100.0 * report.coverage.within_95(), report.coverage.mean());
}

Json ToJson(const HeldOutReport& report) {
  Json json;
  json["frames"] = report.frames;
  json["without_pose"] = report.without_pose;
  json["wrong_size"] = report.wrong_size;
  json["undecodable"] = report.undecodable;
  json["pixels"] = report.pixels;
  json["pixels_on_surface"] = report.on_surface;
  json["pixels_assigned"] = report.assigned;
  json["assigned_fraction"] = Ratio(report.assigned, report.pixels);
  json["mean_absolute_error_kelvin"] = Ratio(report.sum_of_magnitudes_k, report.assigned);
  json["mean_error_kelvin"] = Ratio(report.sum_k, report.assigned);
  json["within_1_sigma"] = report.coverage.within_68();
  json["within_1_96_sigma"] = report.coverage.within_95();
  json["mean_error_over_sigma"] = report.coverage.mean();
  return json;
}

}  // namespace isotherm
