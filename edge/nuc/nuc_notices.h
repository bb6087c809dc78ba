#pragma once

#include <string>
#include <utility>
#include <vector>

#include "common/base/log.h"
#include "common/time/time_types.h"

namespace isotherm {

/// Something that operator, log and recording should know.
struct NucNotice {
  CaptureTime time{};
  LogLevel level = LogLevel::kInfo;
  std::string text{};
};

/// Collects notices in the order in which they come. Thread-compatible.
class NucNotices {
 public:
  /// `time` is that of all notices from now on.
  void SetTime(CaptureTime time) { time_ = time; }
  void Add(LogLevel level, std::string text) {
    notices_.push_back({time_, level, std::move(text)});
  }
  /// Returns those since the last call.
  std::vector<NucNotice> Take() { return std::exchange(notices_, {}); }

 private:
  CaptureTime time_{};
  std::vector<NucNotice> notices_;
};

}  // namespace isotherm
