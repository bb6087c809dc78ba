#include "edge/usb/testing/fault_script.h"

#include <algorithm>
#include <cstdlib>
#include <sstream>

#include "common/base/check.h"

namespace isotherm {

FaultScript::FaultScript(std::string_view script) {
  std::istringstream words{std::string(script)};
  for (std::string word; words >> word;) {
    int count = 1;
    if (const std::size_t star = word.find('*'); star != std::string::npos) {
      count = std::atoi(word.c_str());
      word = word.substr(star + 1);
    }
    const std::size_t colon = word.find(':');
    const FaultStep step{word.substr(0, colon),
                         colon == std::string::npos ? "" : word.substr(colon + 1)};
    steps_.insert(steps_.end(), static_cast<std::size_t>(count), step);
  }
  CHECK(!steps_.empty());
}

FaultStep FaultScript::Next() {
  const FaultStep step = steps_[next_];
  next_ = std::min(next_ + 1, steps_.size() - 1);
  return step;
}

}  // namespace isotherm
