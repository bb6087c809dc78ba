#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "common/base/status.h"
#include "common/time/back_off.h"
#include "common/time/time_types.h"

namespace isotherm {

/// Looks whether the folder for recordings and results can be used, from the start on until it can,
/// with growing pauses. Meanwhile scans are received and reconstructed; their recordings begin as
/// soon as the disk takes them, and results go elsewhere if they must. Thread-compatible.
class OutputFolder {
 public:
  using Prepare = std::function<Status(const std::filesystem::path&)>;

  /// `prepare` makes the folder and tries to write into it.
  OutputFolder(std::filesystem::path folder, Prepare prepare)
      : folder_(std::move(folder)), prepare_(std::move(prepare)) {}

  /// Tries if it is time to. Says in the log that the folder cannot be used, once, and that it can.
  void Tend(SteadyTime now);
  /// Returns why it cannot be used; nullopt if it could.
  const std::optional<std::string>& problem() const { return problem_; }

 private:
  const std::filesystem::path folder_;
  const Prepare prepare_;
  bool usable_ = false;
  BackOff back_off_;
  SteadyTime next_try_{};
  std::optional<std::string> problem_;
};

}  // namespace isotherm
