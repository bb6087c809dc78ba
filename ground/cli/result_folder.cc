#include "ground/cli/result_folder.h"

#include <fmt/format.h>
#include <google/protobuf/struct.pb.h>
#include <google/protobuf/util/json_util.h>

#include <string>

#include "common/config/text_proto.h"
#include "common/dataset/text_lines.h"
#include "common/dataset/trajectory.h"

namespace isotherm {
namespace {

namespace fs = std::filesystem;

constexpr const char* kModelName = "model.iso";

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
      "{} has no {}: is it a result folder of isotherm reconstruct, and was export.model "
      "on?",
      place.string(), kModelName)));
}

std::optional<GroundOptions> ConfigurationOf(const fs::path& folder) {
  const Result<std::string> text = ReadTextFile(folder / "stats.json");
  if (!text) return std::nullopt;
  google::protobuf::Struct stats;
  if (!google::protobuf::util::JsonStringToMessage(*text, &stats).ok()) return std::nullopt;
  const auto found = stats.fields().find("configuration");
  if (found == stats.fields().end()) return std::nullopt;
  GroundOptions options;
  if (!ParseTextProto(found->second.string_value(), "stats.json", options).ok()) {
    return std::nullopt;
  }
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
