#include "ground/cli/interpretation_arguments.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "common/dataset/text_lines.h"
#include "common/options/nearest_name.h"
#include "common/options/text_proto.h"
#include "ground/cli/command.h"
#include "ground/cli/numbers.h"
#include "ground/interpretation/interpretation.h"
#include "ground/options/option_geometry.h"

namespace isotherm {
namespace {

/// Sets one of a region's values by its name on the command line; false if there is none.
bool SetNumber(const std::string& key, double value, InterpretedRegion& region) {
  if (key == "emissivity") region.set_emissivity(value);
  if (key == "reflected") region.set_reflected_celsius(value);
  if (key == "emissivity-sigma") region.set_emissivity_sigma(value);
  if (key == "reflected-sigma") region.set_reflected_sigma_k(value);
  return key == "emissivity" || key == "reflected" || key == "emissivity-sigma" ||
         key == "reflected-sigma";
}

/// "emissivity=0.3 reflected=25" into a region.
Status ReadValues(std::string_view values, std::string_view option, InterpretedRegion& region) {
  bool any = false;
  for (std::string_view word = NextWord(values); !word.empty(); word = NextWord(values)) {
    const std::size_t equals = word.find('=');
    const std::string key(word.substr(0, equals));
    if (key == "name" && equals != std::string_view::npos) {
      region.set_name(std::string(word.substr(equals + 1)));
      continue;
    }
    if (key == "material" && equals != std::string_view::npos) {
      region.set_material(std::string(word.substr(equals + 1)));
      any = true;
      continue;
    }
    // The key is checked before its value, so that the message is about what is wrong first.
    InterpretedRegion ignored;
    if (equals == std::string_view::npos || !SetNumber(key, 0.0, ignored)) {
      return InvalidArgument(
          fmt::format("{}: '{}' is not known, expected emissivity=VALUE, reflected=VALUE, "
                      "material=NAME, emissivity-sigma=VALUE or reflected-sigma=VALUE",
                      option, word));
    }
    const Result<double> value = ParseNumber(word.substr(equals + 1));
    if (!value)
      return InvalidArgument(fmt::format("{}: {}: {}", option, key, value.error().message()));
    SetNumber(key, *value, region);
    any = true;
  }
  if (any) return OkStatus();
  return InvalidArgument(fmt::format(
      "{}: nothing to interpret with, expected emissivity=VALUE or reflected=VALUE after "
      "the colon",
      option));
}

Status AddBox(const std::string& text, InterpretationOptions& options) {
  const std::size_t colon = text.find(':');
  const std::string corners = text.substr(0, colon);
  const auto numbers = ParseNumbers(corners, {6}, "--box");
  if (!numbers) return numbers.error();
  InterpretedRegion& region = *options.add_region();
  const std::vector<double>& v = *numbers;
  *region.mutable_box() = ToOptions(
      Eigen::AlignedBox3d(Eigen::Vector3d(v[0], v[1], v[2]), Eigen::Vector3d(v[3], v[4], v[5])));
  region.set_name(fmt::format("box {}", corners));
  return ReadValues(colon == std::string::npos ? "" : std::string_view(text).substr(colon + 1),
                    fmt::format("--box \"{}\"", text), region);
}

Status ChangeLabel(const std::string& text, InterpretationOptions& options) {
  // The last one: names may hold colons.
  const std::size_t colon = text.rfind(':');
  const std::string name = text.substr(0, colon);
  const auto region = std::ranges::find_if(
      *options.mutable_region(), [&](const InterpretedRegion& r) { return r.name() == name; });
  if (region == options.mutable_region()->end()) {
    std::vector<std::string> names;
    for (const InterpretedRegion& known : options.region()) names.push_back(known.name());
    return InvalidArgument(fmt::format(
        "--label: there is no region '{}'.{} {}", name, DidYouMean(name, names),
        names.empty() ? "--regions FILE brings them" : "Known are " + JoinNames(names)));
  }
  return ReadValues(colon == std::string::npos ? "" : std::string_view(text).substr(colon + 1),
                    fmt::format("--label \"{}\"", text), *region);
}

}  // namespace

void AddInterpretationOptions(CLI::App& command, InterpretationArguments& arguments) {
  command.add_option("--emissivity", arguments.emissivity,
                     "Of the whole model, above 0 and at most 1");
  command.add_option("--reflected", arguments.reflected_celsius,
                     "Temperature of what the whole model reflects, °C");
  command.add_option("--material", arguments.material,
                     "The emissivity depends on the angle like that of this material "
                     "(isotherm limits --list); --emissivity is along the normal");
  command.add_option("--emissivity-sigma", arguments.emissivity_sigma,
                     "Standard uncertainty of the emissivity");
  command.add_option("--reflected-sigma", arguments.reflected_sigma_k,
                     "Standard uncertainty of the reflected temperature, K");
  command
      .add_option("--box", arguments.boxes,
                  "A region: two corners (metres, world), a colon, its values; repeatable")
      ->take_all()
      ->type_name("\"X Y Z X Y Z: emissivity=E reflected=T\"");
  command.add_option("--regions", arguments.regions, "File with regions (text format)");
  command
      .add_option("--label", arguments.labels, "Other values for a region of the file; repeatable")
      ->take_all()
      ->type_name("\"NAME: emissivity=E reflected=T\"");
  command.add_option("--band", arguments.band, "Of the thermal camera, \"min max\" um");
}

std::string AppliedText(const Interpretation& interpretation,
                        const std::vector<PartReport>& reports) {
  std::string text;
  for (std::size_t i = 0; i < interpretation.parts().size(); ++i) {
    const InterpretedPart& part = interpretation.parts()[i];
    text += fmt::format("{:<8} {}: emissivity {:g}{}, {:g} °C reflected: {} points measured\n",
                        i == 0 ? "applied" : "", part.name, part.emissivity,
                        part.material.empty() ? "" : " (by angle as " + part.material + ")",
                        part.reflected_celsius, reports[i].measured);
  }
  for (const std::string& sentence : interpretation.Overlaps())
    text += fmt::format("         {}\n", sentence);
  return text;
}

int FailWhereUnsolved(const Interpretation& interpretation,
                      const std::vector<PartReport>& reports) {
  int status = 0;
  for (const std::string& sentence : interpretation.Errors(reports))
    status = Fail(FailedPrecondition(sentence));
  return status;
}

Status ApplyArguments(const InterpretationArguments& arguments, InterpretationOptions& options) {
  if (!arguments.regions.empty()) {
    InterpretationOptions file;
    ISOTHERM_RETURN_IF_ERROR(LoadTextProto(arguments.regions, file));
    options.MergeFrom(file);
  }
  if (arguments.emissivity) options.set_emissivity(*arguments.emissivity);
  if (arguments.reflected_celsius) options.set_reflected_celsius(*arguments.reflected_celsius);
  if (arguments.emissivity_sigma) options.set_emissivity_sigma(*arguments.emissivity_sigma);
  if (arguments.reflected_sigma_k) options.set_reflected_sigma_k(*arguments.reflected_sigma_k);
  if (arguments.material) options.set_material(*arguments.material);
  if (!arguments.band.empty()) {
    const auto band = ParseNumbers(arguments.band, {2}, "--band");
    if (!band) return band.error();
    options.mutable_expert()->set_band_min_um(band->front());
    options.mutable_expert()->set_band_max_um(band->back());
  }
  // Labels name regions of the file, so they come before boxes, which add regions.
  for (const std::string& label : arguments.labels)
    ISOTHERM_RETURN_IF_ERROR(ChangeLabel(label, options));
  for (const std::string& box : arguments.boxes) ISOTHERM_RETURN_IF_ERROR(AddBox(box, options));
  return OkStatus();
}

}  // namespace isotherm
