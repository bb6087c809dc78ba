#include "ground/results/result_folder.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>

#include "common/dataset/text_lines.h"
#include "common/dataset/trajectory.h"
#include "ground/json/message_json.h"
#include "ground/results/older_configuration.h"

namespace isotherm {
namespace {

namespace fs = std::filesystem;

constexpr const char* kModelName = "model.iso";
// Our own files nest a few levels deep; a damaged one must not exhaust the stack.
constexpr int kMaxNesting = 32;

}  // namespace

Result<fs::path> FindModel(const fs::path& place) {
  std::error_code error;
  if (!fs::exists(place, error)) {
    return Err(
        NotFound(fmt::format("{}: there is no such model or result folder", place.string())));
  }
  if (!fs::is_directory(place, error)) return place;
  fs::path file = place / kModelName;
  if (fs::exists(file, error)) return file;
  return Err(NotFound(fmt::format(
      "{} has no {}: is it a result folder of isotherm reconstruct, and was export.expert.model "
      "on?",
      place.string(), kModelName)));
}

std::optional<GroundOptions> ConfigurationOf(const fs::path& folder) {
  const Result<std::string> text = ReadTextFile(folder / "stats.json");
  if (!text) return std::nullopt;
  // Values that are nested deeper than any option are left out: what writes and frees them
  // recurses.
  const auto is_shallow = [](int depth, Json::parse_event_t, Json&) { return depth < kMaxNesting; };
  const Json stats = Json::parse(*text, is_shallow, /*allow_exceptions=*/false);
  const auto found = stats.find("configuration");
  if (found == stats.end()) return std::nullopt;
  // Before version 0.2 it was text format in a string.
  const Json written =
      found->is_string() ? OptionsFromLines(found->get<std::string>()) : Json(*found);
  GroundOptions options;
  const Json present = WithPresentNames(written, *GroundOptions::descriptor());
  if (!FromJson(present, "stats.json", options).ok()) return std::nullopt;
  return options;
}

std::optional<RigidTransform> LastPoseOf(const fs::path& folder) {
  std::error_code error;
  const fs::path path = folder / "trajectory.txt";
  if (!fs::exists(path, error)) return std::nullopt;
  const auto trajectory = ReadTrajectory(path);
  if (!trajectory || trajectory->empty()) return std::nullopt;
  return trajectory->back().T_world_depth;
}

}  // namespace isotherm
