#pragma once

namespace isotherm {

/// The shipped profile for a radio (deploy/cyclonedds-radio.xml), as CYCLONEDDS_URI's file has it.
const char* RadioProfile();

}  // namespace isotherm
