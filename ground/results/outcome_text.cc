#include "ground/results/outcome_text.h"

namespace isotherm {
namespace {

constexpr EnumArray<LostReason, std::string_view> kLost = {
    {LostReason::kTooFewPixels,
     "too few pixels between preprocessor.expert.min_depth_m and max_depth_m; stay within the "
     "depth "
     "camera's range"},
    {LostReason::kTooFewInliers, "too little of the image fits the model; move more slowly"},
    {LostReason::kResidual, "the image lies too far off the model; did something move?"},
    {LostReason::kStep, "the rig would have jumped; move more slowly"},
    {LostReason::kSingular,
     "the image does not tell the motion (a bare plane?); keep edges in view"},
    {LostReason::kNotFound,
     "looked for the place and did not find it; go back to what was scanned, or scan a larger "
     "volume (--volume) if the rig left it"},
    {LostReason::kOutsideVolume,
     "nothing in view lies in the scan volume; check --initial-pose, --volume and --volume-min"},
};

constexpr EnumArray<LeftOutReason, std::string_view> kLeftOut = {
    {LeftOutReason::kNuc, "taken during a correction (NUC) of the thermal camera, as it must be"},
    {LeftOutReason::kWrongSize, "of another size than the calibration's"},
    {LeftOutReason::kTimeUncertain, "stamped too uncertainly (thermal.expert.max_time_sigma_s)"},
    {LeftOutReason::kDepthStopped, "no depth frames came along with them"},
    {LeftOutReason::kNoDepthAfter,
     "no depth frame came after them; many of these mean that the cameras' clocks differ"},
    {LeftOutReason::kPoseUnknown, "taken while the rig was lost or before the first depth frame"},
    {LeftOutReason::kPoseUncertain,
     "the pose was less certain than thermal.expert.max_registration_px; keep edges in view, and "
     "see that no depth frames are lost"},
    {LeftOutReason::kDepthGap,
     "depth frames were missing around them for longer than thermal.expert.max_depth_gap_s"},
    {LeftOutReason::kBehind,
     "left out to keep up; `isotherm reconstruct` of the recording uses them, at its own pace"},
    {LeftOutReason::kDiskFull, "volume.spill_dir is full; free some space"},
    {LeftOutReason::kNoCalibration, "the calibration says not how the thermal camera sees"},
    {LeftOutReason::kCounts, "the camera sends counts that nothing relates to temperatures"},
};

}  // namespace

std::string_view ExplainLost(LostReason reason) { return kLost[reason]; }

std::string_view ExplainLeftOut(LeftOutReason reason) { return kLeftOut[reason]; }

}  // namespace isotherm
