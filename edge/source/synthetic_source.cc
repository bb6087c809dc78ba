#include "edge/source/synthetic_source.h"

#include <algorithm>
#include <filesystem>
#include <thread>
#include <utility>

#include "common/base/progress.h"
#include "common/concurrency/thread_pool.h"
#include "common/simulation/render_recording.h"
#include "edge/source/replay_source.h"

namespace isotherm {

SyntheticSource::SyntheticSource(const SourceOptions& options, const Clock& clock,
                                 std::stop_token stop)
    : options_(options), clock_(clock), stop_(std::move(stop)), shutter_(options.simulation()) {}

SyntheticSource::~SyntheticSource() = default;

Status SyntheticSource::Open() {
  if (!replay_) {
    const Result<std::filesystem::path> recording = RenderOrFind();
    if (!recording) return recording.error();
    replay_ = std::make_unique<ReplaySource>(options_, *recording, clock_);
  }
  return replay_->Open();
}

Result<std::filesystem::path> SyntheticSource::RenderOrFind() const {
  const std::filesystem::path cache_dir =
      options_.expert().cache_dir().empty() ? DefaultCacheDir()
                                            : std::filesystem::path(options_.expert().cache_dir());
  ThreadPool pool(static_cast<int>(std::max(1U, std::thread::hardware_concurrency())));
  // No bar for a scan that is in the cache.
  std::optional<ProgressBar> progress;
  return CachedRecording(
      options_.simulation(), cache_dir, pool,
      [&progress](double fraction) {
        if (!progress) progress.emplace("rendering the simulated scan", 0, "");
        progress->Update(fraction);
        if (fraction >= 1.0) progress->Finish();
      },
      stop_);
}

Result<SourceItem> SyntheticSource::Read(std::stop_token stop) {
  Result<SourceItem> item = replay_->Read(stop);
  if (!item) return item;
  RawFrame* const frame = std::get_if<RawFrame>(&*item);
  if (frame && frame->sensor == Sensor::kThermal) shutter_.Apply(*frame);
  return item;
}

std::optional<Rig> SyntheticSource::rig() const { return replay_->rig(); }

}  // namespace isotherm
