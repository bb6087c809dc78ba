#pragma once

#include "common/recording/mcap_file_index.h"

namespace isotherm::mcap {

/// The record that every file starts with, behind the magic.
Result<Header> ReadHeader(const ByteSource& source);

/// Builds the index of a file that has no usable summary: one pass over the headers of its records.
/// Chunks are unpacked only where the headers do not tell what is in them, and at the end of a file
/// that breaks off, where the last chunk may be damaged.
FileIndex ScanFile(const ByteSource& source);

}  // namespace isotherm::mcap
