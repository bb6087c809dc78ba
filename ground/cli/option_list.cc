#include "ground/cli/option_list.h"

#include <fmt/format.h>
#include <google/protobuf/descriptor.h>
#include <google/protobuf/descriptor.pb.h>

#include <algorithm>
#include <memory>

#include "common/config/nearest_name.h"

namespace isotherm {

/// The .proto files of all options with their comments, a serialized FileDescriptorSet.
std::string OptionDescriptors();

namespace {

namespace pb = google::protobuf;

struct Program {
  const char* name;
  const char* message;
  const char* used_by;
};

constexpr Program kPrograms[] = {
    {"edge", "isotherm.EdgeOptions", "isotherm-edge"},
    {"ground", "isotherm.GroundOptions",
     "isotherm-ground and isotherm reconstruct, render, export, calibrate"},
    {"simulate", "isotherm.SimulationOptions", "isotherm simulate"},
};

std::unique_ptr<pb::DescriptorPool> LoadDescriptors() {
  pb::FileDescriptorSet files;
  if (!files.ParseFromString(OptionDescriptors())) return nullptr;
  auto pool = std::make_unique<pb::DescriptorPool>();
  for (const pb::FileDescriptorProto& file : files.file()) {
    if (pool->BuildFile(file) == nullptr) return nullptr;
  }
  return pool;
}

/// The comment in front, indented; nothing if there is none.
template <typename Descriptor>
std::string Comment(const Descriptor& descriptor, std::string_view indent) {
  pb::SourceLocation location;
  if (!descriptor.GetSourceLocation(&location)) return {};
  std::string text;
  std::string_view rest = location.leading_comments;
  while (!rest.empty()) {
    std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(line.size() + 1, rest.size()));
    if (line.starts_with(' ')) line.remove_prefix(1);
    text += fmt::format("{}{}\n", indent, line);
  }
  return text;
}

std::string DefaultOf(const pb::FieldDescriptor& field) {
  if (field.is_repeated()) return "   (several; in a file only)";
  if (!field.has_default_value()) return "   (none)";
  pb::FieldDescriptorProto proto;
  field.CopyTo(&proto);
  if (field.cpp_type() == pb::FieldDescriptor::CPPTYPE_STRING)
    return fmt::format(" = \"{}\"", proto.default_value());
  return " = " + proto.default_value();
}

void ListEnum(const pb::EnumDescriptor& type, std::string& text) {
  for (int i = 0; i < type.value_count(); ++i) {
    const pb::EnumValueDescriptor& value = *type.value(i);
    const std::string comment = Comment(value, "        ");
    text += fmt::format("      {}{}\n{}", value.name(), comment.empty() ? "" : ":", comment);
  }
}

void ListMessage(const pb::Descriptor& type, const std::string& prefix, std::string& text) {
  for (int i = 0; i < type.field_count(); ++i) {
    const pb::FieldDescriptor& field = *type.field(i);
    const std::string name = prefix + field.name();
    const bool is_group = field.message_type() != nullptr && !field.is_repeated();
    if (is_group) {
      std::string comment = Comment(field, "  ");
      if (comment.empty()) comment = Comment(*field.message_type(), "  ");
      text += fmt::format("\n{}:\n{}", name, comment);
      ListMessage(*field.message_type(), name + ".", text);
      continue;
    }
    text += fmt::format("  {}{}\n{}", name, DefaultOf(field), Comment(field, "      "));
    if (field.enum_type() != nullptr) ListEnum(*field.enum_type(), text);
    if (field.message_type() != nullptr) text += Comment(*field.message_type(), "      ");
  }
}

std::vector<std::string> Groups(const pb::Descriptor& type) {
  std::vector<std::string> names;
  for (int i = 0; i < type.field_count(); ++i) {
    if (type.field(i)->message_type() != nullptr) names.push_back(type.field(i)->name());
  }
  return names;
}

/// The message behind "tracker.external_odometry".
Result<const pb::Descriptor*> FindStage(const pb::Descriptor& program, std::string_view stage) {
  const pb::Descriptor* type = &program;
  while (!stage.empty()) {
    const std::string name(stage.substr(0, stage.find('.')));
    const pb::FieldDescriptor* field = type->FindFieldByName(name);
    if (field == nullptr || field->message_type() == nullptr) {
      const std::vector<std::string> known = Groups(*type);
      return Err(InvalidArgument(fmt::format("there is no group of options '{}'.{} There are: {}",
                                             name, DidYouMean(name, known), JoinNames(known))));
    }
    type = field->message_type();
    stage.remove_prefix(std::min(name.size() + 1, stage.size()));
  }
  return type;
}

}  // namespace

std::vector<std::string> ProgramsWithOptions() {
  std::vector<std::string> names;
  for (const Program& program : kPrograms) names.emplace_back(program.name);
  return names;
}

Result<std::string> ListOptions(std::string_view program_name, std::string_view stage) {
  const auto* program = std::ranges::find(kPrograms, program_name, &Program::name);
  if (program == std::end(kPrograms)) {
    const std::vector<std::string> known = ProgramsWithOptions();
    return Err(InvalidArgument(fmt::format("there are no options of '{}'.{} There are those of: {}",
                                           program_name, DidYouMean(program_name, known),
                                           JoinNames(known))));
  }
  const std::unique_ptr<pb::DescriptorPool> pool = LoadDescriptors();
  const pb::Descriptor* type = pool ? pool->FindMessageTypeByName(program->message) : nullptr;
  if (type == nullptr) return Err(Internal("the descriptions of options cannot be read"));
  const Result<const pb::Descriptor*> listed = FindStage(*type, stage);
  if (!listed) return Err(listed.error());
  std::string text = fmt::format(
      "Options of {}, with their defaults: --set NAME=VALUE, or in the file of --config\n",
      program->used_by);
  const std::string prefix = stage.empty() ? "" : std::string(stage) + ".";
  ListMessage(**listed, prefix, text);
  return text;
}

}  // namespace isotherm
