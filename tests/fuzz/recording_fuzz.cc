// A recording: index or scan, rig, all messages, their images.
#include "common/codec/codec.h"
#include "common/recording/recording_streams.h"
#include "common/recording/testing/memory_stream.h"

namespace {

constexpr std::size_t kMaxPixels = 1U << 16;

void Decode(const isotherm::RecordedItem& item) {
  if (const auto* depth = std::get_if<isotherm::RecordedDepth>(&item))
    static_cast<void>(isotherm::Decode(depth->frame.image, kMaxPixels));
  if (const auto* thermal = std::get_if<isotherm::RecordedThermal>(&item))
    static_cast<void>(isotherm::DecodeTemperatures(thermal->frame.image, kMaxPixels));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  auto reader = isotherm::MakeRecordingReader(
      std::make_unique<isotherm::MemorySource>(std::vector<std::uint8_t>(data, data + size)));
  if (!reader) return 0;
  static_cast<void>((*reader)->ReadRig());
  while (true) {
    const auto item = (*reader)->Next();
    if (item && !*item) return 0;
    if (item) Decode(**item);
  }
}
