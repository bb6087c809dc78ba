#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>

#include "common/base/status.h"

namespace isotherm {

/// Collects what is wrong with the options of a stage, one line each: "stage.field: what is wrong".
/// Thread-compatible.
class OptionProblems {
 public:
  /// `stage` is the path of the fields to come: "nuc", "source.thermal_camera".
  explicit OptionProblems(std::string_view stage) : stage_(stage) {}

  /// Adds a problem unless `value` lies in [lowest, highest]. NaN does not.
  template <typename T>
  void CheckRange(std::string_view field, T value, T lowest, T highest) {
    // Written so that NaN fails.
    if (value >= lowest && value <= highest) return;
    Add(field, fmt::format("is {}, must be from {} to {}", value, lowest, highest));
  }
  void Add(std::string_view field, std::string_view problem) {
    AddLine(fmt::format("{}.{}: {}", stage_, field, problem));
  }
  /// Adds the problems of a stage that is a part of this one; nothing if there are none.
  void Add(const Status& of_part) {
    if (!of_part.ok()) AddLine(of_part.message());
  }

  Status ToStatus() const { return text_.empty() ? OkStatus() : InvalidArgument(text_); }

 private:
  void AddLine(std::string_view line) {
    if (!text_.empty()) text_ += '\n';
    text_ += line;
  }

  const std::string stage_;
  std::string text_;
};

}  // namespace isotherm
