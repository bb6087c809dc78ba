#include "ground/radiometric_calibration/set_point_table.h"

#include <fmt/format.h>

#include <string>
#include <utility>

#include "common/dataset/text_lines.h"
#include "common/radiometry/radiometry.h"

namespace isotherm {
namespace {

constexpr std::size_t kMaxRows = 1000;

std::string_view Trimmed(std::string_view text) {
  constexpr std::string_view kSpace = " \t";
  const std::size_t from = text.find_first_not_of(kSpace);
  if (from == std::string_view::npos) return {};
  return text.substr(from, text.find_last_not_of(kSpace) - from + 1);
}

std::vector<std::string_view> Columns(std::string_view line) {
  std::vector<std::string_view> columns;
  while (true) {
    const std::size_t comma = line.find(',');
    columns.push_back(Trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) return columns;
    line.remove_prefix(comma + 1);
  }
}

bool IsRadiometric(double celsius) {
  return celsius >= kMinRadiometric_celsius && celsius <= kMaxRadiometric_celsius;
}

/// The message says what is wrong with the line.
Result<SetPointRow> ParseRow(std::string_view line, const std::filesystem::path& folder) {
  const std::vector<std::string_view> columns = Columns(line);
  if (columns.size() < 2 || columns.size() > 3 || columns[1].empty()) {
    return Err(InvalidArgument(
        "need \"black body °C, reading °C or file[, uncertainty K]\", separated by commas"));
  }
  SetPointRow row;
  const Result<double> body = ParseNumber(columns[0]);
  if (!body || !IsRadiometric(*body)) {
    return Err(
        InvalidArgument(fmt::format("the black body's temperature must be {} to {} °C, got \"{}\"",
                                    kMinRadiometric_celsius, kMaxRadiometric_celsius, columns[0])));
  }
  row.body_celsius = *body;
  if (const Result<double> reading = ParseNumber(columns[1]); !reading) {
    row.images = folder / std::string(columns[1]);
  } else if (!IsRadiometric(*reading)) {
    return Err(
        InvalidArgument(fmt::format("a reading must be {} to {} °C, got \"{}\"",
                                    kMinRadiometric_celsius, kMaxRadiometric_celsius, columns[1])));
  } else {
    row.reading_celsius = *reading;
  }
  if (columns.size() == 3) {
    const Result<double> sigma = ParseNumber(columns[2]);
    if (!sigma || !(*sigma >= 0.0 && *sigma <= 10.0)) {
      return Err(
          InvalidArgument(fmt::format("an uncertainty must be 0 to 10 K, got \"{}\"", columns[2])));
    }
    row.sigma_k = *sigma;
  }
  return row;
}

}  // namespace

Result<std::vector<SetPointRow>> ParseSetPoints(std::string_view text, std::string_view source_name,
                                                const std::filesystem::path& folder) {
  std::vector<SetPointRow> rows;
  for (const TextLine& line : ContentLines(text)) {
    Result<SetPointRow> row = ParseRow(line.text, folder);
    if (!row) return Err(row.error().WithContext(At(source_name, line)));
    if (rows.size() == kMaxRows) {
      return Err(
          InvalidArgument(fmt::format("{}: more than {} rows", At(source_name, line), kMaxRows)));
    }
    row->line = line.number;
    rows.push_back(std::move(*row));
  }
  if (rows.empty()) return Err(FailedPrecondition(fmt::format("{}: there is no row", source_name)));
  return rows;
}

}  // namespace isotherm
