#include "ground/subscriber/stream_refusals.h"

#include <fmt/format.h>

#include <variant>

namespace isotherm {

void StreamRefusals::Add(const RigSample& sample, RefusalCause cause) {
  const auto add_frame = [cause](RefusalCounter& counter, const char* stream,
                                 const FrameHeader& header) {
    counter.Add(cause, fmt::format("stream={} session={} frame_number={}", stream, header.session,
                                   header.frame_number));
  };
  if (const auto* frame = std::get_if<EncodedDepthFrame>(&sample.content)) {
    add_frame(depth, "depth", frame->header);
  } else if (const auto* other = std::get_if<EncodedThermalFrame>(&sample.content)) {
    add_frame(thermal, "thermal", other->header);
  } else {
    all.Add(cause, fmt::format("a message of session={}", SessionOf(sample)));
  }
}

}  // namespace isotherm
