#include <fmt/format.h>

#include <cmath>

#include "common/base/escape_html.h"
#include "ground/camera_calibration/calibration_report.h"
#include "ground/camera_calibration/html_page.h"
#include "ground/camera_calibration/svg_plots.h"

namespace isotherm {
namespace {

std::string ParameterTable(const CalibratedCamera& report) {
  std::string html =
      "<table><tr><th>parameter</th><th>value</th><th>uncertainty</th><th>from resampled "
      "views</th><th>off by this, the error grows by 0.1 px</th><th>near borders only</th><th>near "
      "the middle only</th><th>OpenCV</th></tr>\n";
  const Eigen::VectorXd spread = report.bootstrap.Covariance().diagonal().cwiseSqrt();
  for (int i = 0; i < LensParameterCount(report.camera.kind); ++i) {
    const auto index = static_cast<std::size_t>(i);
    html +=
        fmt::format("<tr><td>{}</td><td>{:.7g}</td><td>{:.3g}</td><td>{:.3g}</td><td>{}</td>",
                    LensParameterName(report.camera.kind, i), report.camera.lens[index],
                    std::sqrt(report.covariance(i, i)), spread(i),
                    report.sensitivity.empty() ? std::string("-")
                                               : fmt::format("{:.3g}", report.sensitivity[index]));
    for (const CalibratedCamera::Subset& subset : report.subsets)
      html += fmt::format("<td>{:.6g} &plusmn; {:.2g}</td>", subset.camera.lens[index],
                          std::sqrt(subset.covariance(i, i)));
    for (std::size_t missing = report.subsets.size(); missing < 2; ++missing) html += "<td>-</td>";
    html += report.opencv ? fmt::format("<td>{:.6g}</td></tr>\n", report.opencv->lens[index])
                          : "<td>-</td></tr>\n";
  }
  return html + "</table>\n";
}

std::string CameraHtml(const CalibratedCamera& report) {
  constexpr double kMagnified = 100.0, kDistance_m = 0.6;
  std::string html = fmt::format("<h2>{} camera, {} lens</h2>\n", EscapeHtml(report.name),
                                 ToString(report.camera.kind));
  html += ParameterTable(report);
  if (report.infrared_shift_px.any()) {
    const Eigen::Vector2d written = report.WrittenPrincipalPoint();
    html += fmt::format(
        "<p>The rig file has the principal point of depth images: cx {:.2f}, cy {:.2f}, that is "
        "{:.2f} and {:.2f} px less than these infrared ones'.</p>\n",
        written.x(), written.y(), report.infrared_shift_px.x(), report.infrared_shift_px.y());
  }
  html += HtmlFigure(
      SvgMap(report.sigmas, "px"),
      fmt::format("Uncertainty of the projection (one standard deviation, after the best "
                  "rotation). 1 px is {:.2f} mm at {:.1f} m.",
                  1e3 * kDistance_m / report.camera.lens[0], kDistance_m));
  html +=
      HtmlFigure(SvgFeatures(report.features_px, report.residuals_px, report.size_px, kMagnified),
                 fmt::format("Features of all views, and what they are off, {:.0f} times as long.",
                             kMagnified));
  if (report.cross_validation) {
    html += HtmlFigure(
        SvgMap(report.cross_validation->difference, "px"),
        fmt::format("Difference between calibrations from two halves of the views: {:.2f} "
                    "times what is expected.",
                    report.cross_validation->Ratio()));
  }
  html += "<h3>From which views? (as in the thesis's figure 5.12)</h3>\n";
  for (int i = 0; i < LensParameterCount(report.camera.kind); ++i)
    html += HtmlFigure(SvgHistogram(report.bootstrap.values.col(i),
                                    report.camera.lens[static_cast<std::size_t>(i)],
                                    LensParameterName(report.camera.kind, i)),
                       "");
  if (!report.missing.empty()) {
    html += "<h3>What is missing</h3>\n<ul>\n";
    for (const std::string& missing : report.missing)
      html += fmt::format("<li>{}</li>\n", EscapeHtml(missing));
    html += "</ul>\n";
  }
  return html;
}

}  // namespace

std::string ReportHtml(const CalibrationReport& report) {
  std::string html = fmt::format("<p>{}, {}, from {}</p>\n<pre>{}</pre>\n", EscapeHtml(report.date),
                                 EscapeHtml(report.software), EscapeHtml(report.source),
                                 EscapeHtml(ReportText(report)));
  for (const CalibratedCamera& camera : report.cameras) html += CameraHtml(camera);
  return HtmlPage("Calibration", html);
}

}  // namespace isotherm
