#pragma once

#include <string>
#include <vector>

namespace google::protobuf {
class Descriptor;
}

namespace isotherm {

/// Messages that stand deeper in each other than this are refused.
inline constexpr int kMaxNesting = 64;

/// Places a name in a text that its message once had. Protobuf's parser passes over it without a
/// word.
struct ReservedField {
  int line;  ///< From 0, as protobuf counts.
  int column;
  const google::protobuf::Descriptor* type;
  std::string name;
};

/// Returns the reserved names in `text`, which is meant as a message of `type` in text format. Of a
/// text that is not well-formed some may be missing.
std::vector<ReservedField> FindReservedFields(const std::string& text,
                                              const google::protobuf::Descriptor& type);

}  // namespace isotherm
