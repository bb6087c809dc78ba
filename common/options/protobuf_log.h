#pragma once

namespace isotherm {

/// From now on the messages of the protobuf library go to our log, with a limit: it writes a line
/// for each field of a file that is not UTF-8, for example. To be called once in main(), before any
/// thread starts. Thread-safe afterwards.
void LimitProtobufLog();

}  // namespace isotherm
