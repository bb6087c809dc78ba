#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace isotherm {

/// Says what goes wrong at a frame of the fake depth camera.
enum class FakeDepthFault {
  kNone,
  kShort,      ///< Half of the bytes.
  kWrongSize,  ///< Half of the lines.
  kDrop,       ///< The frame is lost in the camera; its number is used up.
  kStall,      ///< No frame from here on.
  kJump,       ///< The camera's clock moves, then goes on.
  kFlip,       ///< A bit of the frame's number is wrong.
  kCrash,      ///< The library dies: the process gets SIGSEGV.
  kHang,       ///< The library never returns: the process is stopped.
};

/// Holds what the fake depth camera is and does. Travels as a text file that the driver reads when
/// the camera is opened (and, for `connected`, all the time); its path is in the environment
/// variable ISOTHERM_FAKE_DEPTH. Without the variable no camera is connected.
struct FakeDepthScript {
  /// Holds a fault and its extent.
  struct Fault {
    FakeDepthFault fault = FakeDepthFault::kNone;
    int frames = 1;            ///< How many frames it lasts (kShort, kWrongSize, kDrop).
    std::int64_t jump_us = 0;  ///< kJump: signed.
  };

  bool connected = true;
  /// The library never comes back from opening it. That it got there is seen by MarkHang's file.
  bool open_hangs = false;
  std::string serial = "FAKE-1";
  bool has_field_of_view = true;
  bool has_zero_plane = true;
  double horizontal_fov_rad = 1.0144;  ///< A Carmine's: 58.1 degrees.
  double vertical_fov_rad = 0.7898;
  bool has_close_range = true;
  bool has_registration = true;
  bool mirroring_stays_on = false;  ///< The camera says yes and does not do it.
  std::uint64_t first_timestamp_us = 1'000'000;
  bool wraps_at_32_bits = false;  ///< Timestamps count modulo 2^32.
  /// Raw 16-bit frames of the mode's size (millimetres), one after the other, sent in turn; empty:
  /// a tilted plane.
  std::filesystem::path pixels;
  /// A file of 8 bytes in which the driver counts the frames that it has made; empty: none.
  std::filesystem::path counter;
  /// By number of the frame since the stream started, from 1.
  std::map<int, Fault> faults;

  std::string ToText() const;
};

/// Reads the file that ISOTHERM_FAKE_DEPTH names; nullopt if there is none.
std::optional<FakeDepthScript> ReadFakeDepthScript();

/// Makes the file that says that the library hangs, beside the script.
void MarkHang();
/// Returns the name of that file for a script at `path`.
std::filesystem::path HangMark(const std::filesystem::path& path);

/// The frames of a script: `width` x `height` each, row-major, in tenths of a millimetre or
/// millimetres.
std::vector<std::uint16_t> PrepareFakeDepth(const FakeDepthScript& script, int width, int height,
                                            bool tenth_mm);

/// Returns what the plane measures at a pixel, millimetres; 0 = no return.
std::uint16_t FakePlaneMillimetres(int u, int v);

/// One frame to send.
struct FakeDepthFrame {
  int index = 0;
  std::uint64_t timestamp_us = 0;
  FakeDepthFault fault = FakeDepthFault::kNone;
};

/// Numbers and times of a stream's frames. Thread-compatible.
class FakeDepthClock {
 public:
  FakeDepthClock(const FakeDepthScript& script, int fps) : script_(script), fps_(fps) {}
  /// The next frame; nullopt if it is lost.
  std::optional<FakeDepthFrame> Next();
  bool stalled() const { return stalled_; }

 private:
  const FakeDepthScript& script_;
  const int fps_;
  int index_ = 0;
  std::int64_t jumped_us_ = 0;
  FakeDepthScript::Fault running_;
  int left_ = 0;  ///< Frames that `running_` still lasts.
  bool stalled_ = false;
};

}  // namespace isotherm
