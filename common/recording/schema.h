#pragma once

#include <string>

namespace google::protobuf {
class Descriptor;
}

namespace isotherm::recording {

/// FileDescriptorSet of the message's file and all that it imports, as MCAP wants schemas.
std::string SerializedSchema(const google::protobuf::Descriptor& descriptor);

}  // namespace isotherm::recording
