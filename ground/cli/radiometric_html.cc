#include "ground/cli/radiometric_html.h"

#include <fmt/format.h>

#include <map>
#include <vector>

#include "common/base/escape_html.h"
#include "ground/camera_calibration/html_page.h"
#include "ground/camera_calibration/svg_plots.h"
#include "ground/cli/command.h"
#include "ground/cli/today.h"

namespace isotherm {
namespace {

/// By what readings are to be raised, and what each black body tells of it.
std::string CurveFigure(const RadiometricReport& report) {
  const RadiometricCorrection& table = report.curve.correction;
  GraphSeries curve{.name = "correction, two standard uncertainties", .is_line = true};
  for (std::size_t i = 0; i < table.readings_celsius.size(); ++i) {
    curve.points.emplace_back(table.readings_celsius[i], table.corrections_k[i]);
    curve.sigmas.push_back(table.sigmas_k[i]);
  }
  GraphSeries bodies{.name = "black bodies"};
  for (const RowReport& row : report.rows)
    bodies.points.emplace_back(row.own_celsius, row.apparent_celsius - row.own_celsius);
  return HtmlFigure(SvgGraph({curve, bodies}, "reading, °C", "to be raised by, K"),
                    "By what readings are to be raised. A point is one row of the table, without "
                    "what the rest of the scene adds.");
}

/// Shows what the black body reads through holes of several sizes; empty without them.
std::string HoleFigures(const RadiometricReport& report) {
  std::map<double, std::pair<GraphSeries, GraphSeries>> by_body;
  for (const RowReport& row : report.rows) {
    if (row.hole_radius_px <= 0.0) continue;
    auto& [measured, own] = by_body[row.row.body_celsius];
    measured.points.emplace_back(row.hole_radius_px, row.measured_celsius);
    own.points.emplace_back(row.hole_radius_px, row.own_celsius);
  }
  std::string html;
  for (auto& [celsius, series] : by_body) {
    series.first.name = "as measured";
    series.second.name = "without what the rest of the scene adds";
    html += HtmlFigure(
        SvgGraph({series.first, series.second}, "radius of the hole, px", "reading, °C"),
        fmt::format("The black body at {:g} °C through holes (as in the thesis's figures 5.6 to "
                    "5.9). A right camera reads the same through all.",
                    celsius));
  }
  return html;
}

}  // namespace

std::string RadiometricHtml(const RadiometricFindings& found, std::string_view text) {
  std::string html = fmt::format("<p>{}, {}</p>\n<pre>{}</pre>\n", EscapeHtml(Today()),
                                 EscapeHtml(SoftwareName()), EscapeHtml(text));
  if (found.readings) html += CurveFigure(*found.readings) + HoleFigures(*found.readings);
  return HtmlPage("Radiometric calibration", html);
}

}  // namespace isotherm
