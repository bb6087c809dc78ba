#include "ground/report/report_table.h"

#include <fmt/format.h>

#include <cmath>

namespace isotherm {
namespace {

std::string KindName(measuring::Shape::Kind kind) {
  switch (kind) {
    case measuring::Shape::SPOT:
      return "spot";
    case measuring::Shape::LINE:
      return "line";
    case measuring::Shape::AREA:
      return "area";
    case measuring::Shape::DIFFERENCE:
      return "difference";
    case measuring::Shape::DISTANCE:
      return "distance";
    default:
      return "note";
  }
}

std::string Number(double value, int digits) { return fmt::format("{:.{}f}", value, digits); }

void AddTemperatures(const measuring::MeasuredShape& measured, ObjectRow& row) {
  if (measured.has_object()) {
    const measuring::Statistics& object = measured.object();
    row.max_celsius = Number(object.max_celsius(), 1);
    row.mean_celsius = Number(object.mean_celsius(), 1);
    row.min_celsius = Number(object.min_celsius(), 1);
    if (object.has_sigma_k()) row.sigma_k = Number(object.sigma_k(), 2);
  } else if (measured.has_record() && measured.record().has_object_celsius()) {
    row.max_celsius = row.mean_celsius = row.min_celsius =
        Number(measured.record().object_celsius(), 1);
    if (measured.record().has_object_sigma_k())
      row.sigma_k = Number(measured.record().object_sigma_k(), 2);
  }
}

std::string QualityText(const measuring::MeasuredShape& measured) {
  if (measured.has_quality()) {
    return fmt::format("{:.0f} % well, {:.0f} % never", 100.0 * measured.quality().good(),
                       100.0 * measured.quality().never());
  }
  return measured.has_record() ? measured.record().quality() : "";
}

/// A difference is assessed between similar parts; anything else against the air, if it is known.
void Assess(const ReportInputs& inputs, const measuring::Shape& shape,
            const measuring::MeasuredShape& measured, ObjectRow& row) {
  const SeverityRow* found = nullptr;
  if (measured.has_difference_k()) {
    found = FindSeverity(inputs.severity, "similar", std::abs(measured.difference_k()));
  } else if (shape.parameters().has_air_celsius()) {
    const double air = shape.parameters().air_celsius();
    if (measured.has_object()) {
      found = FindSeverity(inputs.severity, "ambient", measured.object().max_celsius() - air);
    } else if (measured.has_record() && measured.record().has_object_celsius()) {
      found = FindSeverity(inputs.severity, "ambient", measured.record().object_celsius() - air);
    }
  }
  if (found == nullptr) return;
  row.severity = found->level();
  row.action = found->action();
}

void AddParameters(const ReportInputs& inputs, const measuring::Shape& shape, ObjectRow& row) {
  if (shape.kind() == measuring::Shape::DIFFERENCE || shape.kind() == measuring::Shape::DISTANCE ||
      shape.kind() == measuring::Shape::NOTE)
    return;
  const measuring::ObjectParameters& own = shape.parameters();
  row.emissivity =
      Number(own.has_emissivity() ? own.emissivity() : inputs.interpretation.emissivity(), 2);
  row.reflected_celsius =
      Number(own.has_reflected_celsius() ? own.reflected_celsius()
                                         : inputs.interpretation.reflected_celsius(),
             1);
  row.material = own.has_material() ? own.material() : inputs.interpretation.material();
}

}  // namespace

std::vector<ObjectRow> ObjectRows(const ReportInputs& inputs) {
  std::vector<ObjectRow> rows;
  for (int i = 0; i < inputs.measurements.shapes_size(); ++i) {
    const measuring::Shape& shape = inputs.measurements.shapes(i);
    const measuring::MeasuredShape& measured = inputs.measurements.measured(i);
    ObjectRow row;
    row.name = shape.name().empty() ? shape.id() : shape.name();
    row.kind = KindName(shape.kind());
    row.remark = measured.problem().empty() ? shape.text() : measured.problem();
    row.quality = QualityText(measured);
    AddTemperatures(measured, row);
    AddParameters(inputs, shape, row);
    if (measured.has_difference_k()) row.difference_k = Number(measured.difference_k(), 1);
    if (measured.area_m2() > 0.0) row.area_m2 = Number(measured.area_m2(), 4);
    if (measured.length_m() > 0.0) row.length_mm = Number(1e3 * measured.length_m(), 1);
    if (measured.has_heat_flow() && measured.heat_flow().measured_m2() > 0.0)
      row.heat_flow_w = Number(measured.heat_flow().total_w(), 2);
    row.alarm = measured.alarm();
    Assess(inputs, shape, measured, row);
    row.is_problem = !measured.problem().empty() || !measured.alarm().empty();
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace isotherm
