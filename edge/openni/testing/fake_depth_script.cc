#include "edge/openni/testing/fake_depth_script.h"

#include <array>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string_view>

namespace isotherm {
namespace {

struct FaultName {
  FakeDepthFault fault;
  std::string_view name;
};
constexpr std::array<FaultName, 8> kFaults = {{{FakeDepthFault::kShort, "short"},
                                               {FakeDepthFault::kWrongSize, "size"},
                                               {FakeDepthFault::kDrop, "drop"},
                                               {FakeDepthFault::kStall, "stall"},
                                               {FakeDepthFault::kJump, "jump"},
                                               {FakeDepthFault::kFlip, "flip"},
                                               {FakeDepthFault::kCrash, "crash"},
                                               {FakeDepthFault::kHang, "hang"}}};

void ReadFault(std::istringstream& line, FakeDepthScript& script) {
  int frame = 0;
  std::string name;
  FakeDepthScript::Fault fault;
  line >> frame >> name >> fault.frames >> fault.jump_us;
  for (const FaultName& known : kFaults) {
    if (known.name == name) fault.fault = known.fault;
  }
  script.faults[frame] = fault;
}

}  // namespace

std::string FakeDepthScript::ToText() const {
  std::ostringstream text;
  text.precision(17);
  text << "connected " << connected << "\nopen_hangs " << open_hangs << "\nserial " << serial
       << "\nfield_of_view " << has_field_of_view << ' ' << horizontal_fov_rad << ' '
       << vertical_fov_rad << "\nzero_plane " << has_zero_plane << "\nclose_range "
       << has_close_range << "\nregistration " << has_registration << "\nmirroring_stays_on "
       << mirroring_stays_on << "\ntimestamps " << first_timestamp_us << ' ' << wraps_at_32_bits
       << '\n';
  if (!pixels.empty()) text << "pixels " << pixels.string() << '\n';
  if (!counter.empty()) text << "counter " << counter.string() << '\n';
  for (const auto& [frame, fault] : faults) {
    for (const FaultName& known : kFaults) {
      if (known.fault != fault.fault) continue;
      text << "at " << frame << ' ' << known.name << ' ' << fault.frames << ' ' << fault.jump_us
           << '\n';
    }
  }
  return text.str();
}

std::filesystem::path HangMark(const std::filesystem::path& path) {
  return path.string() + ".hangs";
}

void MarkHang() {
  if (const char* path = std::getenv("ISOTHERM_FAKE_DEPTH")) std::ofstream(HangMark(path)).put('x');
}

std::optional<FakeDepthScript> ReadFakeDepthScript() {
  const char* path = std::getenv("ISOTHERM_FAKE_DEPTH");
  if (path == nullptr) return std::nullopt;
  std::ifstream file(path);
  if (!file) return std::nullopt;
  FakeDepthScript script;
  for (std::string text; std::getline(file, text);) {
    std::istringstream line(text);
    std::string key;
    line >> key;
    if (key == "connected") line >> script.connected;
    if (key == "open_hangs") line >> script.open_hangs;
    if (key == "serial") line >> script.serial;
    if (key == "field_of_view") {
      line >> script.has_field_of_view >> script.horizontal_fov_rad >> script.vertical_fov_rad;
    }
    if (key == "zero_plane") line >> script.has_zero_plane;
    if (key == "close_range") line >> script.has_close_range;
    if (key == "registration") line >> script.has_registration;
    if (key == "mirroring_stays_on") line >> script.mirroring_stays_on;
    if (key == "timestamps") line >> script.first_timestamp_us >> script.wraps_at_32_bits;
    if (key == "pixels") line >> script.pixels;
    if (key == "counter") line >> script.counter;
    if (key == "at") ReadFault(line, script);
  }
  return script;
}

std::uint16_t FakePlaneMillimetres(int u, int v) {
  if ((u * 7 + v * 13) % 41 == 0) return 0;
  return static_cast<std::uint16_t>(600 + u / 4 + v / 8);
}

std::vector<std::uint16_t> PrepareFakeDepth(const FakeDepthScript& script, int width, int height,
                                            bool tenth_mm) {
  std::vector<std::uint16_t> frames;
  if (!script.pixels.empty()) {
    std::ifstream file(script.pixels, std::ios::binary);
    frames.resize(std::filesystem::file_size(script.pixels) / 2);
    file.read(reinterpret_cast<char*>(frames.data()),
              static_cast<std::streamsize>(frames.size() * 2));
  } else {
    for (int v = 0; v < height; ++v) {
      for (int u = 0; u < width; ++u) frames.push_back(FakePlaneMillimetres(u, v));
    }
  }
  for (std::uint16_t& depth : frames) {
    if (tenth_mm) depth = static_cast<std::uint16_t>(depth * 10);
  }
  return frames;
}

std::optional<FakeDepthFrame> FakeDepthClock::Next() {
  ++index_;
  if (const auto found = script_.faults.find(index_); found != script_.faults.end()) {
    running_ = found->second;
    left_ = running_.frames;
    if (running_.fault == FakeDepthFault::kJump) jumped_us_ += running_.jump_us;
    stalled_ = running_.fault == FakeDepthFault::kStall;
  }
  const FakeDepthFault fault = left_-- > 0 ? running_.fault : FakeDepthFault::kNone;
  if (stalled_ || fault == FakeDepthFault::kDrop) return std::nullopt;
  const auto elapsed_us = static_cast<std::int64_t>(index_) * 1'000'000 / fps_;
  std::uint64_t timestamp_us =
      script_.first_timestamp_us + static_cast<std::uint64_t>(elapsed_us + jumped_us_);
  if (script_.wraps_at_32_bits) timestamp_us &= 0xFFFF'FFFFU;
  return FakeDepthFrame{index_, timestamp_us, fault};
}

}  // namespace isotherm
