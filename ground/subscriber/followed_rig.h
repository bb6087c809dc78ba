#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "common/base/log.h"
#include "common/base/mutex.h"

namespace isotherm {

/// Knows which rig this ground follows by its name: the one that was chosen, or else the first one
/// that is seen. Thread-safe.
class FollowedRig {
 public:
  /// `edge_id` is empty if no choice was made.
  explicit FollowedRig(std::string edge_id) : edge_id_(std::move(edge_id)) {}

  /// Returns its name; empty before there is one.
  std::string edge_id() const {
    MutexLock lock(mutex_);
    return edge_id_;
  }
  /// A rig was seen. Returns whether it is the one that is followed, from now on or already.
  bool See(const std::string& edge_id) {
    MutexLock lock(mutex_);
    if (edge_id_.empty()) {
      edge_id_ = edge_id;
      LOG(Subscriber, Info) << "following the first rig seen, edge_id=" << edge_id;
    }
    return edge_id == edge_id_;
  }

 private:
  mutable Mutex mutex_;
  std::string edge_id_ GUARDED_BY(mutex_);
};

}  // namespace isotherm
