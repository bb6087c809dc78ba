#include "edge/source/synthetic_source.h"

#include <filesystem>
#include <utility>

#include "edge/edge_options.pb.h"
#include "edge/source/replay_source.h"

namespace isotherm {

SyntheticSource::SyntheticSource(const SourceOptions& options, const Clock& clock,
                                 std::stop_token stop)
    : options_(std::make_unique<const SourceOptions>(options)),
      clock_(clock),
      stop_(std::move(stop)) {}

SyntheticSource::~SyntheticSource() = default;

Status SyntheticSource::Open() {
  if (!replay_) return Unavailable("no simulation yet");
  return replay_->Open();
}

Result<SourceItem> SyntheticSource::Read(std::stop_token stop) { return replay_->Read(stop); }

std::optional<Rig> SyntheticSource::rig() const { return replay_->rig(); }

}  // namespace isotherm
