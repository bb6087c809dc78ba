#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "common/base/mutex.h"

namespace isotherm {

/// A text output that never waits for whoever reads it. What the reader does not take at once is
/// kept, up to kKeptBytes, and offered again with the next text; beyond that texts are left out and
/// counted. A reader that is gone costs the text and nothing else, if SIGPIPE is ignored
/// (IgnoreBrokenPipes()). Thread-safe.
class UnblockedOutput {
 public:
  /// As much as a pipe holds, once more.
  static constexpr std::size_t kKeptBytes = 64U << 10;

  /// `descriptor` stays the caller's and may be pointed elsewhere in between (dup2).
  explicit UnblockedOutput(int descriptor) : descriptor_(descriptor) {}
  ~UnblockedOutput();
  UnblockedOutput(const UnblockedOutput&) = delete;
  UnblockedOutput& operator=(const UnblockedOutput&) = delete;

  /// `text` is left out as a whole or not at all.
  void Write(std::string_view text);
  /// Returns how many texts were left out since the last call; 0 while there is no room to say so.
  std::uint64_t TakeLeftOut();
  /// Offers what is kept for this long; for the end of the program.
  void Flush(int patience_ms);

 private:
  /// Tells how a write can be made that never waits: the descriptor itself may belong to other
  /// processes, so its flags are not touched.
  enum class Kind : std::uint8_t { kDirect, kReopened, kSocket, kPolled };

  void LookAtDescriptor() REQUIRES(mutex_);
  /// Offers what is kept; true if nothing is left.
  bool Offer() REQUIRES(mutex_);
  /// Bytes taken: 0 if there is no room, below 0 if there never will be any.
  std::ptrdiff_t TryWrite(std::string_view text) const REQUIRES(mutex_);

  const int descriptor_;
  Mutex mutex_;
  Kind kind_ GUARDED_BY(mutex_) = Kind::kDirect;
  /// With kReopened, the same file opened so that it never waits.
  int own_ GUARDED_BY(mutex_) = -1;
  std::uint64_t device_ GUARDED_BY(mutex_) = 0;
  std::uint64_t inode_ GUARDED_BY(mutex_) = 0;
  std::string kept_ GUARDED_BY(mutex_);
  std::uint64_t left_out_ GUARDED_BY(mutex_) = 0;
};

/// Writes to standard error by way of the process's one UnblockedOutput. Thread-safe.
void WriteStandardError(std::string_view text);
/// UnblockedOutput::TakeLeftOut of it.
std::uint64_t TakeLeftOutOfStandardError();
/// The same as WriteStandardError for standard output, for programs that must not wait for whoever
/// reads what they say. Not together with stdio. Thread-safe.
void WriteStandardOutput(std::string_view text);

}  // namespace isotherm
