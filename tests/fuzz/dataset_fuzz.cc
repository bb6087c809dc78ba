// The lists of a data set folder.
#include <algorithm>
#include <cstdlib>
#include <string_view>

#include "common/dataset/dataset.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  if (const auto images = isotherm::ParseImageList(text, "list", "folder")) {
    for (const auto& image : *images) {
      if (*image.path.begin() != "folder" ||
          std::find(image.path.begin(), image.path.end(), "..") != image.path.end()) {
        std::abort();
      }
    }
  }
  static_cast<void>(isotherm::ParseNucIntervals(text, "nuc"));
  static_cast<void>(isotherm::ParseTrajectory(text, "trajectory"));
  return 0;
}
