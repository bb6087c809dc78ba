#include "ground/cli/calibrated_rig_file.h"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>

#include "common/options/text_proto.h"
#include "common/rig/rig_calibration.h"
#include "common/rig/rig_calibration.pb.h"
#include "common/rig/rig_calibration_file.h"

namespace isotherm {

Status WriteCalibratedRig(const RigFilePaths& paths, const Rig& recorded,
                          const std::function<void(RigCalibration&)>& change) {
  std::error_code error;
  const bool was_there = std::filesystem::exists(paths.output, error);
  RigCalibration whole = ToProto(recorded);
  if (!paths.rig.empty()) {
    whole.Clear();
    ISOTHERM_RETURN_IF_ERROR(LoadTextProto(paths.rig, whole));
  }
  change(whole);
  ISOTHERM_RETURN_IF_ERROR(EditRigFile(paths.output, [&](RigCalibration& rig) {
    rig = whole;
    return OkStatus();
  }));
  fmt::print("{}: written{}\n", paths.output,
             was_there ? fmt::format("; as it was, with its comments: {}.bak", paths.output) : "");
  return OkStatus();
}

}  // namespace isotherm
