#include "ground/experiment/experiment_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>
#include <system_error>

#include "common/base/output_file.h"
#include "ground/json/json.h"
#include "ground/renderer/png.h"

namespace isotherm {
namespace {

std::string Number(double value) {
  // Whole numbers below it are counts; others are measured, three digits of them.
  constexpr double kMaxCount = 1e9;
  if (std::isnan(value)) return "-";
  if (value == std::round(value) && std::abs(value) < kMaxCount)
    return fmt::format("{:.0f}", value);
  return fmt::format("{:.3g}", value);
}

/// Columns of a terminal; UTF-8 continuation bytes take none.
std::size_t Width(std::string_view text) {
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char c) { return (c & 0xC0) != 0x80; }));
}

std::string Padded(const std::string& text, std::size_t width, bool to_the_right) {
  const std::string blanks(width - std::min(width, Width(text)), ' ');
  return to_the_right ? blanks + text : text + blanks;
}

std::string TableText(const ExperimentTable& table) {
  std::vector<std::vector<std::string>> lines(1);
  lines.front().push_back(table.rows_are);
  for (const std::string& column : table.columns) lines.front().push_back(column);
  for (const ExperimentTable::Row& row : table.rows) {
    std::vector<std::string>& line = lines.emplace_back();
    line.push_back(row.label);
    for (const double value : row.values) line.push_back(Number(value));
  }
  std::vector<std::size_t> widths(lines.front().size(), 0);
  for (const auto& line : lines) {
    for (std::size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], Width(line[i]));
  }
  std::string text;
  for (const auto& line : lines) {
    text += " ";
    for (std::size_t i = 0; i < line.size(); ++i) text += " " + Padded(line[i], widths[i], i > 0);
    text += "\n";
  }
  return text;
}

std::string RequirementText(const Requirement& r) {
  const std::string unit = r.unit.empty() ? "" : " " + r.unit;
  return fmt::format("{}  {}: {} {} {}{}, measured {}{}", r.IsMet() ? "met    " : "NOT MET", r.what,
                     r.role == Requirement::Role::kNegativeControl ? "must miss" : "required",
                     r.sense == Requirement::Sense::kAtMost ? "<=" : ">=", Number(r.limit), unit,
                     Number(r.measured), unit);
}

std::string CsvField(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

Json ToJson(const Experiment& experiment, const ExperimentReport& report) {
  Json json;
  json["experiment"] = experiment.name;
  json["figure"] = experiment.figure;
  json["claim"] = experiment.claim;
  json["all_met"] = report.AllMet();
  for (const Requirement& r : report.requirements) {
    Json requirement;
    requirement["what"] = r.what;
    requirement["sense"] = r.sense == Requirement::Sense::kAtMost ? "at most" : "at least";
    requirement["limit"] = r.limit;
    requirement["measured"] = r.measured;
    requirement["unit"] = r.unit;
    requirement["role"] =
        r.role == Requirement::Role::kNegativeControl ? "negative control" : "limit";
    requirement["met"] = r.IsMet();
    json["requirements"].push_back(std::move(requirement));
  }
  for (const ExperimentTable::Row& row : report.table.rows) {
    Json line;
    line[report.table.rows_are] = row.label;
    for (std::size_t i = 0; i < row.values.size(); ++i)
      line[report.table.columns[i]] = row.values[i];
    json["table"].push_back(std::move(line));
  }
  return json;
}

}  // namespace

std::string ToText(const Experiment& experiment, const ExperimentReport& report) {
  std::string text =
      fmt::format("{} ({})\n{}\n", experiment.name, experiment.figure, experiment.claim);
  text += TableText(report.table);
  for (const Requirement& requirement : report.requirements)
    text += RequirementText(requirement) + "\n";
  if (!report.HasNegativeControl()) text += "NOT MET  there is no negative control\n";
  return text;
}

std::string ToCsv(const ExperimentTable& table) {
  std::string text = CsvField(table.rows_are);
  for (const std::string& column : table.columns) text += "," + CsvField(column);
  text += "\n";
  for (const ExperimentTable::Row& row : table.rows) {
    text += CsvField(row.label);
    for (const double value : row.values)
      text += std::isnan(value) ? std::string(",") : fmt::format(",{}", value);
    text += "\n";
  }
  return text;
}

Status WriteExperiment(const Experiment& experiment, const ExperimentReport& report,
                       const std::filesystem::path& dir) {
  std::error_code error;
  std::filesystem::create_directories(dir, error);
  if (error)
    return IoError(fmt::format("{}: cannot be created: {}", dir.string(), error.message()));
  const std::string name(experiment.name);
  ISOTHERM_RETURN_IF_ERROR(WriteFile(dir / (name + ".csv"), ToCsv(report.table)));
  ISOTHERM_RETURN_IF_ERROR(WriteFile(dir / (name + ".json"), JsonText(ToJson(experiment, report))));
  for (const ExperimentRendering& rendering : report.renderings) {
    const Result<std::vector<std::uint8_t>> png = EncodePng(rendering.rendering);
    if (!png) return png.error();
    ISOTHERM_RETURN_IF_ERROR(WriteFile(dir / fmt::format("{}_{}.png", name, rendering.name),
                                       std::as_bytes(std::span(*png))));
  }
  return OkStatus();
}

}  // namespace isotherm
