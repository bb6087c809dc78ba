// A library with the interface of the vendor's, for tests, with the ranges of a PI 450: 4 x 3
// pixels, each call a frame; the
// flag goes open, closing, closed, opening, open, ...; the fifth frame after an order is open.
//
// If the camera's file exists, frames come at the camera's rate, and the words in it say what goes
// wrong: "crash N" or "hang N" at the N-th frame, "refuse": orders are refused, "hang-at-open".
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string>
#include <string_view>
#include <thread>

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
bool is_hottest_range = false;

struct Script {
  bool paced = false;
  std::uint32_t crash_at = 0;  // 0 = never.
  std::uint32_t hang_at = 0;
  bool refuses = false;
  bool hangs_at_open = false;
};
Script script;

Script ReadScript(const char* path) {
  Script read;
  std::ifstream file(path);
  read.paced = file.is_open();
  for (std::string word; file >> word;) {
    if (word == "crash") file >> read.crash_at;
    if (word == "hang") file >> read.hang_at;
    if (word == "refuse") read.refuses = true;
    if (word == "hang-at-open") read.hangs_at_open = true;
  }
  return read;
}

void PlayScript() {
  if (script.paced) std::this_thread::sleep_for(std::chrono::microseconds(37'037));
  if (frames == script.crash_at) std::abort();
  while (frames == script.hang_at) ::pause();
}

}  // namespace

extern "C" {
int evo_irimager_usb_init(const char* config, const char*, const char*) {
  running = std::string_view(config).ends_with("pi450.xml");
  script = ReadScript(config);
  if (script.hangs_at_open) {
    std::fputs("the library opens its camera\n", stderr);
    while (true) ::pause();
  }
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
  PlayScript();
  // 25 degrees Celsius, or 850.
  const unsigned first = is_hottest_range ? 9'500 : 1'250;
  for (int i = 0; i < 12; ++i) data[i] = static_cast<unsigned short>(first + frames % 7);
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
  if (script.refuses) return -1;
  closing = 3;
  return 0;
}
int evo_irimager_set_temperature_range(int min, int max) {
  closing = 3;
  is_hottest_range = min == 150 && max == 900;
  const bool is_known = (min == -20 && max == 100) || (min == 0 && max == 250) || is_hottest_range;
  return is_known ? 0 : -1;
}
int evo_irimager_set_radiation_parameters(float emissivity, float transmissivity, float ambient) {
  return emissivity == 1.0F && transmissivity == 1.0F && ambient < -273.15F ? 0 : -1;
}
}
