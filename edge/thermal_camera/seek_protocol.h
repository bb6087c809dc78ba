#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "common/base/status.h"
#include "common/frame/image.h"
#include "edge/usb/uvc_payload.h"

namespace isotherm {

/// A Seek camera as seen from its bytes (OpenThermal/libseek-thermal and its issues 17, 30 and 39).
/// A frame is one block of little-endian words, row by row, with words that say what it is in the
/// margin around the image. It comes only when asked for.
struct SeekModel {
  std::string_view name;
  int raw_width = 0;  ///< As sent, margin included.
  int raw_height = 0;
  int left = 0;  ///< Where the image lies in it.
  int top = 0;
  int width = 0;
  int height = 0;
  std::size_t read_bytes = 0;    ///< Size of a bulk read; frames are whole multiples.
  std::size_t id_word = 0;       ///< Word of a frame that says what it shows.
  std::size_t counter_word = 0;  ///< Word of a frame with its number, which counts all kinds.

  constexpr std::size_t words() const {
    return static_cast<std::size_t>(raw_width) * static_cast<std::size_t>(raw_height);
  }
  constexpr std::size_t frame_bytes() const { return 2 * words(); }
};

inline constexpr SeekModel kSeekCompact{"Seek Compact", 208, 156, 0, 1, 207, 154, 16'224, 10, 40};
inline constexpr SeekModel kSeekCompactPro{
    "Seek CompactPro", 342, 260, 1, 4, 320, 240, 13'680, 2, 1};

/// A vendor request: writes `data`, or reads `answer_bytes` if that is not 0.
struct SeekRequest {
  std::uint8_t opcode = 0;
  std::vector<std::uint8_t> data;
  std::size_t answer_bytes = 0;

  friend bool operator==(const SeekRequest&, const SeekRequest&) = default;
};

/// The first request of all. A camera that was left running refuses it until it was put to sleep.
SeekRequest SeekWakeRequest();
/// Puts it to sleep; the vendor's program sends it three times.
SeekRequest SeekSleepRequest();
/// Returns what follows SeekWakeRequest until frames can be asked for.
std::vector<SeekRequest> SeekStartRequests(const SeekModel& model);
SeekRequest SeekFrameRequest(const SeekModel& model);
/// Its answer tells cameras apart.
inline constexpr std::uint8_t kSeekReadChipId = 54;

/// Tells the camera's frames apart: only some of them are images.
enum class SeekFrameKind : std::uint8_t {
  kFirst,    ///< After the start; detectors that do not work are dark in it.
  kShutter,  ///< The closed shutter: what an image is measured against.
  kImage,
  kOther,  ///< The camera's own business, or bytes out of step.
};

/// Holds a frame before the shutter's is subtracted.
struct SeekRawFrame {
  SeekFrameKind kind = SeekFrameKind::kOther;
  std::uint16_t counter = 0;
  Image<std::uint16_t> raw;  ///< Without the margin, height x width, counts as measured.
};

/// kDataLoss if `bytes` has not the size of a frame.
Result<SeekRawFrame> ParseSeekFrame(Bytes bytes, const SeekModel& model);

/// Collects the reads that make up a frame. Thread-compatible.
class SeekAssembler {
 public:
  explicit SeekAssembler(const SeekModel& model) : model_(&model) {}

  /// A frame was asked for: forgets what came before.
  void Begin();
  void Add(Bytes bytes, const HostStamp& stamp);
  /// Returns what the next read may bring; 0 = the frame is complete.
  std::size_t wanted_bytes() const;
  bool is_empty() const { return bytes_.empty(); }
  Bytes bytes() const { return bytes_; }
  const HostStamp& first_stamp() const { return first_stamp_; }

 private:
  const SeekModel* model_;
  std::vector<std::uint8_t> bytes_;
  HostStamp first_stamp_;
};

/// Detectors that do not work, and what to show instead. Thread-compatible.
class SeekDeadPixels {
 public:
  /// Finds them in a frame of kind kFirst. kDataLoss if that cannot be one: more are dead than
  /// alive.
  static Result<SeekDeadPixels> Find(const Image<std::uint16_t>& first);

  /// Gives each the mean of its neighbours; those amid others are filled from the outside inwards.
  void Fill(Image<std::uint16_t>& counts) const;
  std::size_t count() const { return dead_.size(); }

 private:
  /// Holds a detector that does not work and those that its value is made of.
  struct Dead {
    std::uint32_t pixel = 0;
    std::vector<std::uint32_t> neighbours;  ///< Alive, or filled before.
  };
  int width_ = 0;
  int height_ = 0;
  std::vector<Dead> dead_;  ///< In the order in which they can be filled.
};

/// Holds an image relative to the shutter.
struct SeekImage {
  Image<std::uint16_t> counts;  ///< kSeekMiddle = as the shutter; 0 = no value.
  std::uint16_t counter = 0;
  bool shutter_closed = false;  ///< It shows the shutter, measured against the one before.
};

/// Count of a pixel that is as warm as the shutter was.
inline constexpr int kSeekMiddle = 0x4000;

/// Turns frames into images: measured against the last frame of the shutter, dead detectors
/// filled. Thread-compatible.
class SeekImageMaker {
 public:
  /// Nothing for frames that are no images, and for images before the first frame of the
  /// shutter. kDataLoss if the first frame was not one.
  Result<std::optional<SeekImage>> Process(SeekRawFrame frame);

 private:
  std::optional<SeekDeadPixels> dead_pixels_;
  Image<std::uint16_t> shutter_;
};

}  // namespace isotherm
