#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/base/status.h"
#include "ground/options/ground_options.pb.h"

namespace CLI {
class App;
}

namespace isotherm {

class Interpretation;
struct PartReport;

/// The arguments by which `isotherm export` and `isotherm render` are told what to interpret.
struct InterpretationArguments {
  std::optional<double> emissivity, reflected_celsius, emissivity_sigma, reflected_sigma_k;
  std::optional<std::string> material;
  std::string band;                 ///< "min max", um; empty: as in the options.
  std::string regions;              ///< Text format of InterpretationOptions.
  std::vector<std::string> boxes;   ///< "x0 y0 z0 x1 y1 z1: emissivity=0.3 reflected=25".
  std::vector<std::string> labels;  ///< "NAME: emissivity=0.3 reflected=25", a region's name.
};

/// Adds --emissivity, --material and the like to the command. `arguments` must outlive it.
void AddInterpretationOptions(CLI::App& command, InterpretationArguments& arguments);

/// Puts the arguments over `options`: the regions file, then what holds for the whole model, then
/// labels, and boxes after all regions. Says what cannot be read; values are checked later.
Status ApplyArguments(const InterpretationArguments& arguments, InterpretationOptions& options);

/// Says in lines what was applied to which part, and which regions overlap.
std::string AppliedText(const Interpretation& interpretation,
                        const std::vector<PartReport>& reports);

/// Says on standard error where measured points have no temperature, and returns the exit status; 0
/// if all have one.
int FailWhereUnsolved(const Interpretation& interpretation, const std::vector<PartReport>& reports);

}  // namespace isotherm
