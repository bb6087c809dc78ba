#pragma once

#include <memory>

#include "common/recording/byte_stream.h"
#include "common/recording/recording.h"

namespace isotherm {

/// The same as RecordingWriter::Create and RecordingReader::Open on any sink and source (tests:
/// memory).
Result<std::unique_ptr<RecordingWriter>> MakeRecordingWriter(std::unique_ptr<ByteSink> sink,
                                                             const RecordingOptions& options);
Result<std::unique_ptr<RecordingReader>> MakeRecordingReader(std::unique_ptr<ByteSource> source);

/// Version of what a recording contains, kept in its metadata. A reader refuses another major
/// version.
inline constexpr std::string_view kRecordingMetadataName = "isotherm.recording";
inline constexpr int kRecordingMajorVersion = 1;
inline constexpr int kRecordingMinorVersion = 0;

/// Metadata of a recording whose rig was written anew: the log time of the first copy that holds,
/// ns.
inline constexpr std::string_view kRigMetadataName = "isotherm.rig";
inline constexpr std::string_view kRigSince = "since_ns";

}  // namespace isotherm
