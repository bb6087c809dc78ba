#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <stop_token>

#include "common/time/clock.h"
#include "edge/options/edge_options.pb.h"
#include "edge/source/frame_source.h"
#include "edge/source/simulated_shutter.h"

namespace isotherm {

class ReplaySource;

/// A simulated scan. The first Open renders it into the cache, with a progress bar, or finds it
/// there; then it is replayed like any recording, so that a live run spends its cores on the
/// pipeline. Its thermal camera has a shutter that can be commanded. Thread-bound.
class SyntheticSource final : public FrameSource {
 public:
  /// `clock` must outlive the source. `stop` ends rendering early.
  SyntheticSource(const SourceOptions& options, const Clock& clock, std::stop_token stop);
  ~SyntheticSource() override;

  std::string_view name() const override { return "simulated scan"; }
  Status Open() override;
  Result<SourceItem> Read(std::stop_token stop) override;
  void Close() override {}
  std::optional<Status> Control(const CameraControl& control) override {
    return shutter_.Control(control);
  }
  std::optional<Rig> rig() const override;

 private:
  Result<std::filesystem::path> RenderOrFind() const;

  const SourceOptions options_;
  const Clock& clock_;
  const std::stop_token stop_;
  std::unique_ptr<ReplaySource> replay_;
  SimulatedShutter shutter_;
};

}  // namespace isotherm
