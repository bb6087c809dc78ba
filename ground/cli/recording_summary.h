#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/doubts/plausibility_check.h"
#include "common/recording/recording.h"

namespace isotherm {

/// One sensor's frames in a recording.
struct StreamSummary {
  std::uint64_t frames = 0;
  std::set<std::uint64_t> sessions;
  std::set<std::pair<int, int>> sizes;             ///< Width and height, pixels.
  std::map<std::string, std::uint64_t> encodings;  ///< Frames by encoding.
  std::uint64_t raw_bytes = 0;                     ///< Size of the pixels before encoding.
  std::uint64_t payload_bytes = 0;
  CaptureTime first{}, last{};
  double period_s = 0.0;           ///< Median time between frames; 0 for fewer than two.
  std::uint64_t missing = 0;       ///< Frame numbers that are not there.
  std::uint64_t holes = 0;         ///< Runs of them.
  std::uint64_t duplicates = 0;    ///< Frames whose number was there before.
  std::uint64_t out_of_order = 0;  ///< Frames earlier than the one before, as recorded.
  std::uint64_t gaps = 0;          ///< Times of more than 1.5 periods without a frame.
  double longest_gap_s = 0.0;
  CaptureTime longest_gap_at{};  ///< The frame before it.
  std::uint64_t repeats = 0;     ///< Images equal bit for bit to the one before.
  double sigma_s = 0.0;          ///< Median uncertainty of the capture time; 0 = not estimated.

  double rate_hz() const { return period_s > 0.0 ? 1.0 / period_s : 0.0; }
  /// Returns what encoding left of the pixels' bytes, as a ratio.
  double compression() const {
    return raw_bytes == 0 ? 0.0
                          : static_cast<double>(payload_bytes) / static_cast<double>(raw_bytes);
  }
};

/// The NUC state that a run of thermal frames carries.
struct NucRun {
  CaptureTime start, end;  ///< First and last frame in progress.
  std::uint64_t frames = 0;
};

/// Counts what a recording has.
struct RecordingSummary {
  StreamSummary depth;
  StreamSummary thermal;
  std::uint64_t valid_thermal = 0;
  std::map<std::string, std::uint64_t> nuc_states;         ///< Thermal frames by state.
  std::vector<NucRun> nuc_runs;                            ///< Shutter closed, from the frames.
  std::vector<NucEvent> nuc_events;                        ///< As recorded.
  std::vector<ClockStep> clock_steps;                      ///< The first kMaxLog.
  std::map<std::string, std::uint64_t> poses;              ///< By stream: groundtruth, trajectory.
  std::map<std::string, std::uint64_t> external_odometry;  ///< By source.
  std::vector<RecordedLog> log;                            ///< Logged events; the first kMaxLog.
  std::uint64_t log_left_out = 0;
  /// Lines of the log that are shown; a scan of hours has more, in the recording.
  static constexpr std::size_t kMaxLog = 200;
  /// Longer lines are cut; more sources, sizes and sessions are not told apart.
  static constexpr std::size_t kMaxLogBytes = 4096;
  /// Distinct values that are counted one by one, whatever a file holds.
  static constexpr std::size_t kMaxKinds = 1000;
  std::uint64_t unreadable = 0;  ///< Messages that could not be read.
};

/// Collects a summary in constant memory per frame (its number and time), for the first kMaxFrames
/// of a stream; later ones are only counted. Thread-compatible.
class RecordingSummarizer {
 public:
  /// Nine hours at 30 Hz.
  static constexpr std::size_t kMaxFrames = 1'000'000;

  void Add(const RecordedItem& item);
  void AddUnreadable() { ++summary_.unreadable; }
  RecordingSummary Finish();

 private:
  /// Collects the stamps of one stream to find gaps, repeats and steps at the end.
  struct Stamps {
    std::vector<std::pair<std::uint64_t, std::uint64_t>> numbers;  // Session and frame number.
    std::vector<CaptureTime> times;
    std::vector<std::int64_t> sigmas_ns;
    std::optional<Encoding> last_encoding;
    std::size_t last_hash = 0;  ///< Hash of the payload: an image may be large.
  };
  static void AddFrame(const FrameHeader& header, const EncodedImage& image, StreamSummary& stream,
                       Stamps& stamps);
  static void FinishStream(Stamps& stamps, StreamSummary& stream);
  void AddNuc(const EncodedThermalFrame& frame);

  RecordingSummary summary_;
  Stamps depth_, thermal_;
  bool in_nuc_ = false;
};

/// Reads all of a recording that can be read, and shows `plausibility` what it needs.
RecordingSummary Summarize(RecordingReader& reader, PlausibilityCheck& plausibility);

std::string EncodingName(Encoding encoding);
std::string NucStateName(NucState state);

}  // namespace isotherm
