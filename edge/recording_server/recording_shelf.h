#pragma once

#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

#include "common/base/status.h"
#include "common/messages/recording_transfer.h"
#include "edge/spool/recording_listing.h"

namespace isotherm {

/// Answers what is asked about an edge's recordings. Only files that the edge itself has written by
/// `record` are there, whatever a request names. Thread-compatible.
class RecordingShelf {
 public:
  explicit RecordingShelf(std::filesystem::path record) : record_(std::move(record)) {}

  RecordingPiece Answer(const RecordingRequest& request);

 private:
  void Look() { listed_ = ListRecordings(record_); }
  const ListedRecording* Find(const std::string& name) const;
  void List(const RecordingRequest& request, RecordingPiece& piece);
  void Read(const RecordingRequest& request, RecordingPiece& piece);
  void NoteKept(const RecordingRequest& request, RecordingPiece& piece);
  /// Returns the one that is asked for, and describes it; nullptr if there is none, or it cannot be
  /// read now, as the answer says.
  const ListedRecording* Get(const RecordingRequest& request, RecordingPiece& piece);

  const std::filesystem::path record_;
  std::vector<ListedRecording> listed_;  ///< As of the newest look.
  std::optional<SteadyTime> looked_at_;
};

}  // namespace isotherm
