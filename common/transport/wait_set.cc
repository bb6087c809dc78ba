#include "common/transport/wait_set.h"

#include <dds/dds.h>
#include <fmt/format.h>

#include <algorithm>

namespace isotherm {

Status WaitSet::Open(const Participant& participant) {
  wait_set_ = DdsHandle(dds_create_waitset(participant.handle()));
  guard_ = DdsHandle(dds_create_guardcondition(participant.handle()));
  if (wait_set_.value() < 0 || guard_.value() < 0) return Internal("cannot create a DDS wait set");
  const dds_return_t code = dds_waitset_attach(wait_set_.value(), guard_.value(), 0);
  if (code == DDS_RETCODE_OK) return OkStatus();
  return Internal(fmt::format("cannot attach to a DDS wait set: {}", dds_strretcode(code)));
}

void WaitSet::Wait(Nanoseconds timeout) {
  static_cast<void>(dds_waitset_wait(wait_set_.value(), nullptr, 0,
                                     std::max<dds_duration_t>(0, timeout.count())));
  bool woken = false;
  static_cast<void>(dds_take_guardcondition(guard_.value(), &woken));
}

void WaitSet::Wake() { static_cast<void>(dds_set_guardcondition(guard_.value(), true)); }

}  // namespace isotherm
