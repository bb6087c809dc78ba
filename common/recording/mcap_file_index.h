#pragma once

#include <set>
#include <string>

#include "common/recording/mcap_segment.h"

namespace isotherm::mcap {

/// A stretch of the file that is damaged or was never finished, and what is known to have been in
/// it.
struct Gap {
  std::uint64_t offset = 0;
  std::uint64_t length = 0;
  std::map<ChannelId, std::uint64_t> message_counts;  ///< From the message indexes that survived.
};

/// Holds what a file contains and where, without its messages.
struct FileIndex {
  Header header;
  bool complete = false;            ///< Ends with a summary that is whole.
  std::uint64_t bytes_ignored = 0;  ///< Damaged or unfinished parts that are not read.
  std::vector<Gap> gaps;            ///< Where they are, in file order; the first kMaxGaps.
  /// A file with more damaged places is described by its first ones; bytes_ignored counts all.
  static constexpr std::size_t kMaxGaps = 1000;
  Definitions definitions;
  std::vector<Segment> segments;       ///< In file order.
  std::set<std::string> compressions;  ///< All that its chunks use.
  std::vector<Metadata> metadata;
  std::map<ChannelId, std::uint64_t> message_counts;
};

/// Reads the index from the summary or, if that is missing, damaged or does not cover everything,
/// rebuilds it by a pass over the record headers, which goes on behind damage. kDataLoss if this is
/// not an MCAP file at all, kFailedPrecondition if it has another major version or a compression
/// that is not supported.
Result<FileIndex> ReadFileIndex(const ByteSource& source);

}  // namespace isotherm::mcap
