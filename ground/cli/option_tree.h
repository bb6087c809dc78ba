#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/status.h"
#include "ground/cli/option_list.h"

namespace google::protobuf {
class Descriptor;
class DescriptorPool;
class EnumValueDescriptor;
class FieldDescriptor;
}  // namespace google::protobuf

namespace isotherm {

/// Holds the options that stand in one message.
struct OptionGroup {
  std::string name;  ///< Dotted, as --set has it; empty: the program's own.
  std::string comment;
  std::vector<const google::protobuf::FieldDescriptor*> options;
};

/// Reads the .proto files of all programs, with their comments; nullptr if they cannot be read.
std::unique_ptr<google::protobuf::DescriptorPool> LoadOptionDescriptors();

/// Returns the message behind "tracker.external_odometry" from `program` on.
Result<const google::protobuf::Descriptor*> FindStage(const google::protobuf::Descriptor& program,
                                                      std::string_view stage);

/// Says whether a group of this dotted name is an `expert` block or in one.
bool IsExpert(std::string_view name);

/// Returns the groups of one ring from `type` on, whose dotted name is `name`. Empty ones are left
/// out.
std::vector<OptionGroup> GroupsOf(const google::protobuf::Descriptor& type, const std::string& name,
                                  OptionRing ring);

/// Returns the comment in front, lines ending in newlines; nothing if there is none.
std::string Comment(const google::protobuf::FieldDescriptor& field);
std::string Comment(const google::protobuf::EnumValueDescriptor& value);

/// Returns the default as --set takes it; empty if there is none.
std::string DefaultText(const google::protobuf::FieldDescriptor& field);

}  // namespace isotherm
