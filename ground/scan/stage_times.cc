#include "ground/scan/stage_times.h"

namespace isotherm {
namespace {

constexpr EnumArray<Stage, std::string_view> kStageNames = {{Stage::kDepthFrame, "depth_frame"},
                                                            {Stage::kIntegrate, "integrate"},
                                                            {Stage::kMerge, "merge"},
                                                            {Stage::kPreprocess, "preprocess"},
                                                            {Stage::kRaycast, "raycast"},
                                                            {Stage::kRelocalise, "relocalise"},
                                                            {Stage::kSubMaps, "submaps"},
                                                            {Stage::kThermalFrame, "thermal_frame"},
                                                            {Stage::kTrack, "track"}};

}  // namespace

std::string_view ToString(Stage stage) { return kStageNames[stage]; }

}  // namespace isotherm
