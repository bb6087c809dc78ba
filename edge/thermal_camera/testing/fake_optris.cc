// A library with the interface of the vendor's, for tests: 4 x 3 pixels, each call a frame; the
// flag goes open, closing, closed, opening, open, ...; the fifth frame after an order is open.
#include <cstdint>
#include <cstring>
#include <string_view>

namespace {

struct Metadata {
  std::uint32_t counter, counter_hw;
  std::int64_t timestamp, timestamp_media;
  std::int32_t flag_state;
  float chip, flag, box;
};

std::uint32_t frames = 0;
int closing = 0;
bool running = false;

}  // namespace

extern "C" {
int evo_irimager_usb_init(const char* config, const char*, const char*) {
  running = std::string_view(config) == "pi450.xml";
  return running ? 0 : -1;
}
int evo_irimager_terminate() {
  running = false;
  return 0;
}
int evo_irimager_get_serial(unsigned long* serial) {
  *serial = 12'345;
  return 0;
}
int evo_irimager_get_thermal_image_size(int* width, int* height) {
  *width = 4;
  *height = 3;
  return 0;
}
int evo_irimager_get_thermal_image_metadata(int* width, int* height, unsigned short* data,
                                            void* metadata) {
  if (!running) return -1;
  *width = 4;
  *height = 3;
  ++frames;
  for (int i = 0; i < 12; ++i) data[i] = static_cast<unsigned short>(1'250 + frames % 7);
  constexpr int kFlags[] = {0, 2, 1, 3};  // Counted down: closing, closed, opening, open.
  const int flag = kFlags[closing];
  if (closing > 0) --closing;
  const Metadata content{frames, frames, 0,     std::int64_t{370'370} * frames,
                         flag,   31.0F,  32.0F, 33.0F};
  std::memcpy(metadata, &content, sizeof(content));
  return 0;
}
int evo_irimager_set_shutter_mode(int) { return 0; }
int evo_irimager_trigger_shutter_flag() {
  closing = 3;
  return 0;
}
int evo_irimager_set_temperature_range(int min, int max) {
  closing = 3;
  return min == 0 && max == 250 ? 0 : -1;
}
int evo_irimager_set_radiation_parameters(float emissivity, float transmissivity, float ambient) {
  return emissivity == 1.0F && transmissivity == 1.0F && ambient < -273.15F ? 0 : -1;
}
}
