#include "ground/service/output_folder.h"

#include <utility>

#include "common/base/log.h"

namespace isotherm {

void OutputFolder::Tend(SteadyTime now) {
  if (usable_ || now < next_try_) return;
  const Status prepared = prepare_(folder_);
  usable_ = prepared.ok();
  if (usable_) {
    if (std::exchange(problem_, std::nullopt)) {
      LOG(Ground, Info) << "the output folder can be used, folder=" << folder_.string();
    }
    return;
  }
  if (!problem_) {
    LOG(Ground, Error) << prepared.message()
                       << "; scans are received all the same, and it is tried again until it works";
  }
  problem_ = prepared.message();
  next_try_ = now + back_off_.Next();
}

}  // namespace isotherm
