#include "ground/results/outcome_text.h"

#include <algorithm>
#include <array>
#include <span>

namespace isotherm {
namespace {

struct Explanation {
  std::string_view reason;
  std::string_view sentence;
};

constexpr std::array<Explanation, 7> kLost = {{
    {"too_few_pixels",
     "too few pixels between preprocessor.min_depth_m and max_depth_m; stay within the depth "
     "camera's range"},
    {"too_few_inliers", "too little of the image fits the model; move more slowly"},
    {"residual", "the image lies too far off the model; did something move?"},
    {"step", "the rig would have jumped; move more slowly"},
    {"singular", "the image does not tell the motion (a bare plane?); keep edges in view"},
    {"not_found",
     "looked for the place and did not find it; go back to what was scanned, or scan a larger "
     "volume "
     "(--volume) if the rig left it"},
    {"outside_volume",
     "nothing in view lies in the scan volume; check --initial-pose, --volume and --volume-min"},
}};

constexpr std::array<Explanation, 12> kLeftOut = {{
    {"nuc", "taken during a correction (NUC) of the thermal camera, as it must be"},
    {"wrong_size", "of another size than the calibration's"},
    {"time_uncertain", "stamped too uncertainly (thermal.max_time_sigma_s)"},
    {"no_depth", "no depth frames came along with them"},
    {"no_depth_after",
     "no depth frame came after them; many of these mean that the cameras' clocks differ"},
    {"pose_unknown", "taken while the rig was lost or before the first depth frame"},
    {"pose_uncertain",
     "the pose was less certain than thermal.max_registration_px; keep edges in view"},
    {"depth_gap", "depth frames were missing around them for longer than thermal.max_wait_s"},
    {"behind",
     "left out to keep up; `isotherm reconstruct` of the recording uses them, at its own pace"},
    {"disk_full", "volume.spill_dir is full; free some space"},
    {"no_calibration", "the calibration says not how the thermal camera sees"},
    {"counts", "the camera sends counts that nothing relates to temperatures"},
}};

std::string Explain(std::span<const Explanation> explanations, std::string_view reason) {
  const auto found = std::ranges::find(explanations, reason, &Explanation::reason);
  return std::string(found == explanations.end() ? reason : found->sentence);
}

}  // namespace

std::string ExplainLost(std::string_view reason) { return Explain(kLost, reason); }

std::string ExplainLeftOut(std::string_view reason) { return Explain(kLeftOut, reason); }

std::string MainReason(const std::map<std::string, std::uint64_t>& counts) {
  const auto most =
      std::ranges::max_element(counts, {}, &std::pair<const std::string, std::uint64_t>::second);
  return most == counts.end() ? std::string() : most->first;
}

}  // namespace isotherm
