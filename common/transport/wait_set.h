#pragma once

#include <memory>

#include "common/base/status.h"
#include "common/transport/endpoints.h"

namespace isotherm {

/// Lets one thread sleep until any of several readers has data or somebody wakes it. Wait is
/// thread-bound, Wake is thread-safe.
class WaitSet {
 public:
  /// To be called once before anything else. `participant` must outlive the wait set.
  Status Open(const Participant& participant);

  /// `reader` must outlive the wait set, and is not attached to another one afterwards.
  template <typename Message>
  Status Attach(const Reader<Message>& reader) {
    return reader.AttachTo(wait_set_.value());
  }
  /// Returns when a reader has data, when woken, or after `timeout`, whichever is first.
  void Wait(Nanoseconds timeout);
  /// Ends the current Wait, or the next one if none is running.
  void Wake();

 private:
  DdsHandle guard_;
  DdsHandle wait_set_;
};

}  // namespace isotherm
