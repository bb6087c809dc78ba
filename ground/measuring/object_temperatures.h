#pragma once

#include <map>
#include <memory>
#include <string>

#include "ground/interpretation/interpretation.h"
#include "ground/measuring/measuring.pb.h"
#include "ground/options/ground_options.pb.h"

namespace isotherm {

/// Says what an object is taken for, complete.
struct ObjectParameterValues {
  double emissivity = 1.0;
  double reflected_celsius = 23.0;
  std::string material;
  double air_celsius = 23.0;
  double film_coefficient_w_m2k = 8.0;
};

/// Object temperatures for shapes with parameters of their own: keeps the tables of each set.
/// Thread-compatible.
class ObjectTemperatures {
 public:
  /// `scan` is what holds where a shape says nothing.
  explicit ObjectTemperatures(const InterpretationOptions& scan) : scan_(scan) {}

  ObjectParameterValues Complete(const measuring::ObjectParameters& parameters) const;
  /// The interpretation by these parameters; a Status in words if they are wrong.
  Result<const Interpretation*> For(const ObjectParameterValues& values);

 private:
  const InterpretationOptions scan_;
  std::map<std::string, std::unique_ptr<Interpretation>> kept_;
};

}  // namespace isotherm
