#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace isotherm {

/// One frame of an emulated camera, or something that happens instead.
struct FaultStep {
  std::string what;   ///< "f", "-", "unplug", ...
  std::string fault;  ///< The text behind the colon.
};

/// Holds what an emulated camera does, frame by frame. Steps are separated by blanks:
/// `[count*]what[:fault]`. The last step is repeated for ever.
///
///   f          a frame
///   f:freeze   the image and the counter of the frame before   f:nuc      it corrects itself
///   f:still    the image of the frame before, counter goes on  f:imminent ... is about to
///   f:short    the end is missing        f:head   a payload with a damaged header
///   f:error    the error bit is set      f:lost   the bus lost a packet
///   f:noeof    no end-of-frame bit       f:skip   three images were not sent
///   f:reset    the camera's clock starts again   f:flip  a bit of the frame counter is wrong
///   -          nothing for the time of a frame
///   stall, unstall   requests are refused from here on, or answered again; takes no time
///   unplug[:MS]      the cable comes off in the middle of a frame, and on again after MS ms
class FaultScript {
 public:
  explicit FaultScript(std::string_view script);

  /// The step that comes next.
  FaultStep Next();

 private:
  std::vector<FaultStep> steps_;
  std::size_t next_ = 0;
};

}  // namespace isotherm
