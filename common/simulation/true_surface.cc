#include "common/simulation/true_surface.h"

#include <cstddef>
#include <memory>
#include <vector>

#include "common/simulation/simulated_scan.h"
#include "common/simulation/simulation_options.pb.h"
#include "common/simulation/surface_sampling.h"

namespace isotherm {
namespace {

// The default voxel: truth need not be finer than what is compared with it.
constexpr double kSampleSpacing_m = 0.002;
// Every tenth pose counts what is seen: 30 degrees a second move little in a third of a second.
constexpr std::size_t kPoseStep = 10;

}  // namespace

Status WriteTrueSurface(const SimulationOptions& options, const std::filesystem::path& path,
                        const std::function<void(double fraction)>& progress,
                        const std::stop_token& stop) {
  const Result<std::unique_ptr<SimulatedScan>> scan = SimulatedScan::Create(options);
  if (!scan) return scan.error();
  std::vector<SurfaceSample> samples = SampleSurface((*scan)->scene(), kSampleSpacing_m);
  const Rig& rig = (*scan)->rig();
  const double max_depth_m = options.depth().expert().max_depth_m();
  const auto& times = (*scan)->depth_times();
  for (std::size_t i = 0; i < times.size(); i += kPoseStep) {
    if (stop.stop_requested()) return Unavailable("writing the true surface was interrupted");
    if (progress) progress(static_cast<double>(i) / static_cast<double>(times.size()));
    const CaptureTime time = times[i].exposure;
    CountSeen((*scan)->scene(), *rig.depth, (*scan)->PoseAt(time), max_depth_m, SeenBy::kDepth,
              samples);
    CountSeen((*scan)->scene(), *rig.thermal, (*scan)->ThermalPoseAt(time), max_depth_m,
              SeenBy::kThermal, samples);
  }
  return WriteSurfacePly(path, samples);
}

}  // namespace isotherm
