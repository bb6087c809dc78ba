#include "edge/nuc/nuc_supervisor.h"

#include "edge/edge_options.pb.h"

namespace isotherm {

NucSupervisor::NucSupervisor(const NucOptions& options)
    : settle_time_(FromSeconds(options.settle_time_s())),
      require_initial_nuc_(options.require_initial_nuc()) {}

NucStatus NucSupervisor::Update(CaptureTime time, bool shutter_closed) {
  if (state_ == NucState::kInProgress && !shutter_closed) shutter_opened_at_ = time;
  state_ = NextState(time, shutter_closed);

  NucStatus status;
  status.state = state_;
  status.valid = state_ == NucState::kIdle;
  if (shutter_opened_at_) status.seconds_since_nuc = ToSeconds(time - *shutter_opened_at_);
  if (shutter_closed || shutter_opened_at_) status.source = NucSource::kInBand;
  return status;
}

NucState NucSupervisor::NextState(CaptureTime time, bool shutter_closed) const {
  if (shutter_closed) return NucState::kInProgress;
  if (shutter_opened_at_) {
    return time - *shutter_opened_at_ < settle_time_ ? NucState::kSettling : NucState::kIdle;
  }
  return require_initial_nuc_ ? NucState::kUnknown : NucState::kIdle;
}

}  // namespace isotherm
