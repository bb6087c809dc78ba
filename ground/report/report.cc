#include "ground/report/report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "common/base/base64.h"
#include "common/base/escape_html.h"
#include "ground/json/message_json.h"
#include "ground/measuring/shape_store.h"
#include "ground/report/report_table.h"

namespace isotherm {
namespace {

constexpr const char* kStyle = R"(
@page { size: A4; margin: 16mm 14mm; }
* { box-sizing: border-box; }
body { font: 10.5pt/1.4 system-ui, "Segoe UI", Roboto, "DejaVu Sans", sans-serif; color: #16202b; margin: 0 auto; max-width: 190mm; padding: 6mm 0; }
h1 { font-size: 22pt; margin: 0 0 1mm; }
h2 { font-size: 13pt; margin: 8mm 0 2mm; border-bottom: 2px solid #d9472b; padding-bottom: 1mm; break-after: avoid; }
p { margin: 0 0 2mm; }
table { border-collapse: collapse; width: 100%; font-size: 9.5pt; }
th, td { text-align: left; padding: 1.2mm 2mm; border-bottom: 1px solid #ccd5de; vertical-align: top; }
th { background: #eef2f6; }
td.n { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
tr { break-inside: avoid; }
tr.problem td { background: #fdecea; }
dl { display: grid; grid-template-columns: 45mm 1fr; margin: 0; }
dt { color: #56677a; padding: .8mm 0; }
dd { margin: 0; padding: .8mm 0; overflow-wrap: anywhere; }
.images { display: grid; grid-template-columns: 1fr 1fr; gap: 4mm; }
figure { margin: 0; break-inside: avoid; }
figure img { width: 100%; border: 1px solid #ccd5de; display: block; }
figcaption { font-size: 9pt; color: #56677a; }
.bar { display: flex; height: 6mm; border: 1px solid #8796a6; margin: 2mm 0; }
.bar span { display: block; }
.note { color: #56677a; font-size: 9pt; }
.blank { border-bottom: 1px dotted #8796a6; min-width: 60mm; display: inline-block; }
code { font-size: 8.5pt; }
)";

std::string Section(const std::string& title, const std::string& body) {
  return "<section><h2>" + EscapeHtml(title) + "</h2>\n" + body + "</section>\n";
}

std::string Facts(const std::vector<std::pair<std::string, std::string>>& facts) {
  std::string html = "<dl>";
  for (const auto& [name, value] : facts) {
    html += fmt::format("<dt>{}</dt><dd>{}</dd>", EscapeHtml(name),
                        value.empty() ? "<span class=\"blank\">&nbsp;</span>" : EscapeHtml(value));
  }
  return html + "</dl>\n";
}

std::string Images(const std::vector<ReportImage>& images) {
  std::string html = "<div class=\"images\">";
  for (const ReportImage& image : images) {
    html += fmt::format(
        "<figure><img alt=\"{0}\" src=\"data:image/png;base64,{1}\"><figcaption>{0}</figcaption>"
        "</figure>\n",
        EscapeHtml(image.title), EncodeBase64(image.png));
  }
  return html + "</div>\n";
}

std::string ObjectTable(const std::vector<ObjectRow>& rows) {
  if (rows.empty()) return "<p>No object was measured.</p>\n";
  std::string html =
      "<table><thead><tr><th>Object</th><th>max °C</th><th>mean °C</th><th>min °C</th>"
      "<th>± K</th><th>ΔT K</th><th>Size</th><th>Heat W</th><th>ε / refl. °C</th>"
      "<th>Measured</th><th>Assessment</th></tr></thead><tbody>\n";
  const auto cell = [](const std::string& text) {
    return "<td class=\"n\">" + EscapeHtml(text) + "</td>";
  };
  for (const ObjectRow& row : rows) {
    html += row.is_problem ? "<tr class=\"problem\">" : "<tr>";
    html += fmt::format("<td><b>{}</b><br>{}{}</td>", EscapeHtml(row.name), EscapeHtml(row.kind),
                        row.remark.empty() ? "" : ": " + EscapeHtml(row.remark));
    html += cell(row.max_celsius) + cell(row.mean_celsius) + cell(row.min_celsius) +
            cell(row.sigma_k) + cell(row.difference_k);
    html += cell(!row.area_m2.empty()     ? row.area_m2 + " m²"
                 : !row.length_mm.empty() ? row.length_mm + " mm"
                                          : "");
    html += cell(row.heat_flow_w);
    html += cell(row.emissivity.empty() ? "" : row.emissivity + " / " + row.reflected_celsius);
    html += "<td>" + EscapeHtml(row.quality) + "</td>";
    std::string assessment = row.alarm.empty() ? "" : "ALARM: " + row.alarm;
    if (!row.severity.empty())
      assessment += (assessment.empty() ? "" : "; ") + row.severity + ": " + row.action;
    html += "<td>" + EscapeHtml(assessment) + "</td></tr>\n";
  }
  return html + "</tbody></table>\n";
}

std::string Percent(double part, double total) {
  return fmt::format("{:.1f} %", total > 0.0 ? 100.0 * part / total : 0.0);
}

std::string CoverageSection(const ReportInputs& inputs) {
  const CoverageByReason& c = inputs.coverage;
  const auto part = [&](double area, const char* colour) {
    return fmt::format("<span style=\"width:{:.2f}%;background:{}\"></span>",
                       c.total_m2 > 0.0 ? 100.0 * area / c.total_m2 : 0.0, colour);
  };
  std::string html = "<div class=\"bar\">" + part(c.good_m2, "#2fa765") +
                     part(c.acceptable_m2, "#e7b928") + part(c.bad_m2, "#dc4b4b") +
                     part(c.never_m2, "#9aa7b5") + "</div>\n<table><tbody>";
  const auto row = [&](const std::string& name, double area, const std::string& why) {
    html += fmt::format(
        "<tr><td>{}</td><td class=\"n\">{:.4f} m²</td><td class=\"n\">{}</td><td>{}</td></tr>\n",
        EscapeHtml(name), area, Percent(area, c.total_m2), EscapeHtml(why));
  };
  const auto& distance = inputs.limits.distance();
  const auto& angle = inputs.limits.angle();
  row("Surface that was scanned", c.total_m2, "");
  row("measured well", c.good_m2,
      fmt::format("from {:.2f} to {:.2f} m, at {:.0f} to {:.0f}° to the normal, without smear",
                  distance.min_m(), distance.good_m(), angle.min_deg(), angle.good_deg()));
  row("measured acceptably", c.acceptable_m2,
      fmt::format("up to {:.2f} m and {:.0f}°", distance.max_m(), angle.max_deg()));
  row("measured badly", c.bad_m2, "outside these limits");
  row("not measured", c.never_m2, "the thermal camera did not see it");
  row("bad: distance", c.distance_m2, "too near or too far");
  row("bad: angle", c.angle_m2, "too oblique, or the camera's own mirror image");
  row("bad: motion", c.motion_m2, "smeared while the rig moved");
  row("contradictory", c.disagreement_m2, "good measurements differ: a reflection, or it changed");
  return html +
         "</tbody></table>\n<p class=\"note\">Reasons overlap: a place may be both too far "
         "and too oblique. What was never seen by the depth camera is in no figure.</p>\n";
}

std::string CameraSection(const ReportInputs& inputs) {
  const Rig& rig = inputs.rig;
  const auto size = [](const std::optional<CameraModel>& camera) {
    return camera ? fmt::format("{} x {} pixels", camera->width, camera->height)
                  : std::string("none");
  };
  return Facts(
      {{"Rig", rig.serial},
       {"Depth camera",
        size(rig.depth) + (rig.depth_serial.empty() ? "" : ", " + rig.depth_serial)},
       {"Thermal camera",
        size(rig.thermal) + (rig.thermal_serial.empty() ? "" : ", " + rig.thermal_serial)},
       {"Calibration", rig.date},
       {"Method", rig.method},
       {"Reprojection error", rig.reprojection_error_px
                                  ? fmt::format("{:.3f} pixels", *rig.reprojection_error_px)
                                  : std::string("not stated")}});
}

std::string SeveritySection(const SeverityTables& tables) {
  if (tables.table().empty()) return "";
  std::string html;
  for (const SeverityTable& table : tables.table()) {
    html += "<p><b>" + EscapeHtml(table.title()) + "</b></p><table><tbody>";
    for (const SeverityRow& row : table.row()) {
      html += fmt::format("<tr><td class=\"n\">{}</td><td>{}</td><td>{}</td></tr>",
                          row.has_up_to_k()
                              ? fmt::format("{:g} to {:g} K", row.above_k(), row.up_to_k())
                              : fmt::format("above {:g} K", row.above_k()),
                          EscapeHtml(row.level()), EscapeHtml(row.action()));
    }
    html += "</tbody></table>";
  }
  html += fmt::format("<p class=\"note\">{}: {}</p>\n", EscapeHtml(tables.name()),
                      EscapeHtml(tables.source()));
  return Section("Limits", html);
}

std::string HashSection(const ReportInputs& inputs) {
  std::string html = "<table><tbody>";
  for (const auto& [name, hash] : inputs.hashes)
    html += fmt::format("<tr><td>{}</td><td><code>{}</code></td></tr>", EscapeHtml(name), hash);
  return html +
         "</tbody></table>\n<p class=\"note\">SHA-256 of the files that this report was made "
         "from.</p>\n";
}

std::string Html(const ReportInputs& inputs, const std::vector<ObjectRow>& rows) {
  std::string html = "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>" +
                     EscapeHtml(inputs.title) + "</title><style>" + kStyle +
                     "</style></head><body>\n";
  html += "<h1>" + EscapeHtml(inputs.title) +
          "</h1>\n<p class=\"note\">3D thermography, "
          "structured after ISO 18434-1. This report claims no conformity with any standard.</p>\n";
  html += Facts(
      {{"Place, object", inputs.place},
       {"Thermographer, qualification", inputs.inspector},
       {"Load, conditions", inputs.load},
       {"Time of the scan", inputs.when},
       {"Ambient (reflected)", fmt::format("{:.1f} °C", inputs.interpretation.reflected_celsius())},
       {"Emissivity", fmt::format("{:.2f}{}", inputs.interpretation.emissivity(),
                                  inputs.interpretation.material().empty()
                                      ? ""
                                      : ", " + inputs.interpretation.material())},
       {"Remarks", inputs.remarks}});
  html += Section("Views", Images(inputs.images));
  html += Section("Measured objects", ObjectTable(rows));
  html += SeveritySection(inputs.severity);
  html += Section("Coverage, and what was not measured", CoverageSection(inputs));
  html += Section("Cameras and calibration", CameraSection(inputs));
  html += Section("Files", HashSection(inputs));
  html += "<p class=\"note\">Made with " + EscapeHtml(inputs.software) + ".</p></body></html>\n";
  return html;
}

std::string Csv(const std::vector<ObjectRow>& rows) {
  std::string csv =
      "name,kind,max_celsius,mean_celsius,min_celsius,sigma_k,difference_k,area_m2,length_mm,"
      "heat_flow_w,emissivity,reflected_celsius,material,measured,alarm,severity,action,remark\n";
  for (const ObjectRow& row : rows) {
    bool is_first = true;
    for (const std::string* field :
         {&row.name, &row.kind, &row.max_celsius, &row.mean_celsius, &row.min_celsius, &row.sigma_k,
          &row.difference_k, &row.area_m2, &row.length_mm, &row.heat_flow_w, &row.emissivity,
          &row.reflected_celsius, &row.material, &row.quality, &row.alarm, &row.severity,
          &row.action, &row.remark}) {
      csv += (is_first ? "" : ",") + EscapeCsv(*field);
      is_first = false;
    }
    csv += '\n';
  }
  return csv;
}

std::string AllNumbers(const ReportInputs& inputs, const std::vector<ObjectRow>& rows) {
  Json json;
  json["title"] = inputs.title;
  json["software"] = inputs.software;
  json["scanned"] = inputs.when;
  const CoverageByReason& c = inputs.coverage;
  json["coverage_m2"] = {
      {"total", c.total_m2},     {"good", c.good_m2},         {"acceptable", c.acceptable_m2},
      {"bad", c.bad_m2},         {"never", c.never_m2},       {"bad_distance", c.distance_m2},
      {"bad_angle", c.angle_m2}, {"bad_motion", c.motion_m2}, {"contradictory", c.disagreement_m2}};
  json["interpretation"] = ToJson(inputs.interpretation);
  json["measurements"] = Json::parse(ExactJson(inputs.measurements));
  for (const ObjectRow& row : rows) {
    if (!row.severity.empty())
      json["assessment"].push_back(
          {{"name", row.name}, {"severity", row.severity}, {"action", row.action}});
  }
  for (const auto& [name, hash] : inputs.hashes) json["sha256"][name] = hash;
  return JsonText(json);
}

}  // namespace

std::string EscapeCsv(std::string_view text) {
  // A spreadsheet takes what begins like this for a formula.
  const bool is_formula =
      !text.empty() && (text.front() == '=' || text.front() == '+' || text.front() == '@');
  std::string field = is_formula ? "'" + std::string(text) : std::string(text);
  if (field.find_first_of(",\"\n\r") == std::string::npos) return field;
  std::string quoted = "\"";
  for (const char c : field) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + '"';
}

ReportFiles MakeReport(const ReportInputs& inputs) {
  const std::vector<ObjectRow> rows = ObjectRows(inputs);
  return {.html = Html(inputs, rows), .csv = Csv(rows), .json = AllNumbers(inputs, rows)};
}

}  // namespace isotherm
