#include "ground/scan/scan_counts.h"

namespace isotherm {
namespace {

constexpr EnumArray<LeftOutReason, std::string_view> kReasonNames = {
    {LeftOutReason::kBehind, "behind"},
    {LeftOutReason::kCounts, "counts"},
    {LeftOutReason::kDepthGap, "depth_gap"},
    {LeftOutReason::kDiskFull, "disk_full"},
    {LeftOutReason::kNoCalibration, "no_calibration"},
    {LeftOutReason::kDepthStopped, "no_depth"},
    {LeftOutReason::kNoDepthAfter, "no_depth_after"},
    {LeftOutReason::kNuc, "nuc"},
    {LeftOutReason::kPoseUncertain, "pose_uncertain"},
    {LeftOutReason::kPoseUnknown, "pose_unknown"},
    {LeftOutReason::kTimeUncertain, "time_uncertain"},
    {LeftOutReason::kWrongSize, "wrong_size"}};

}  // namespace

std::string_view ToString(LeftOutReason reason) { return kReasonNames[reason]; }

}  // namespace isotherm
