#include "ground/measuring/object_temperatures.h"

#include <utility>

namespace isotherm {
namespace {

/// Sets of parameters that are kept: a table takes 0.1 MB and a few milliseconds.
constexpr std::size_t kMaxKept = 64;

}  // namespace

ObjectParameterValues ObjectTemperatures::Complete(
    const measuring::ObjectParameters& parameters) const {
  ObjectParameterValues values;
  values.emissivity = parameters.has_emissivity() ? parameters.emissivity() : scan_.emissivity();
  values.reflected_celsius = parameters.has_reflected_celsius() ? parameters.reflected_celsius()
                                                                : scan_.reflected_celsius();
  values.material = parameters.has_material() ? parameters.material() : scan_.material();
  values.air_celsius =
      parameters.has_air_celsius() ? parameters.air_celsius() : values.reflected_celsius;
  if (parameters.has_film_coefficient_w_m2k())
    values.film_coefficient_w_m2k = parameters.film_coefficient_w_m2k();
  return values;
}

Result<const Interpretation*> ObjectTemperatures::For(const ObjectParameterValues& values) {
  InterpretationOptions options = scan_;
  options.clear_region();
  options.set_emissivity(values.emissivity);
  options.set_reflected_celsius(values.reflected_celsius);
  if (values.material.empty()) {
    options.clear_material();
  } else {
    options.set_material(values.material);
  }
  const std::string key = options.SerializeAsString();
  if (const auto found = kept_.find(key); found != kept_.end()) return found->second.get();
  Result<Interpretation> made = Interpretation::Create(options);
  if (!made) return Err(made.error());
  if (kept_.size() >= kMaxKept) kept_.clear();
  return (kept_[key] = std::make_unique<Interpretation>(std::move(*made))).get();
}

}  // namespace isotherm
