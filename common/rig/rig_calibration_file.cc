#include "common/rig/rig_calibration_file.h"

#include <optional>
#include <string>
#include <system_error>

#include "common/base/output_file.h"
#include "common/base/read_file.h"
#include "common/options/text_proto.h"
#include "common/rig/rig_calibration.h"
#include "common/rig/rig_calibration.pb.h"

namespace isotherm {
namespace {

constexpr std::uint64_t kMaxRigBytes = 1U << 20;

}  // namespace

void SetCovariance(const Eigen::MatrixXd& covariance, CalibrationRecord& record) {
  record.clear_covariance();
  for (Eigen::Index y = 0; y < covariance.rows(); ++y) {
    for (Eigen::Index x = 0; x < covariance.cols(); ++x) record.add_covariance(covariance(y, x));
  }
}

Status EditRigFile(const std::filesystem::path& path,
                   const std::function<Status(RigCalibration&)>& edit) {
  RigCalibration rig;
  std::error_code error;
  std::optional<std::string> before;
  if (std::filesystem::exists(path, error)) {
    const Result<std::string> text = ReadFile(path, kMaxRigBytes);
    if (!text) return text.error();
    before = *text;
    ISOTHERM_RETURN_IF_ERROR(ParseTextProto(*before, path.string(), rig));
  }
  if (Status status = edit(rig); !status.ok()) return status.WithContext(path.string());
  const std::string text = ToTextProto(rig);
  if (const Result<Rig> read = ParseRigCalibration(text, path.string()); !read) return read.error();
  if (before) ISOTHERM_RETURN_IF_ERROR(WriteFile(path.string() + ".bak", *before));
  return WriteFile(path, text);
}

}  // namespace isotherm
