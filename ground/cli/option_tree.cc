#include "ground/cli/option_tree.h"

#include <fmt/format.h>
#include <google/protobuf/descriptor.h>
#include <google/protobuf/descriptor.pb.h>

#include <algorithm>

#include "common/options/nearest_name.h"

namespace isotherm {

/// The .proto files of all options with their comments, a serialized FileDescriptorSet.
std::string OptionDescriptors();

namespace {

namespace pb = google::protobuf;

constexpr std::string_view kExpert = "expert";

template <typename Descriptor>
std::string CommentOf(const Descriptor& descriptor) {
  pb::SourceLocation location;
  if (!descriptor.GetSourceLocation(&location)) return {};
  std::string text;
  std::string_view rest = location.leading_comments;
  while (!rest.empty()) {
    std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(line.size() + 1, rest.size()));
    if (line.starts_with(' ')) line.remove_prefix(1);
    text += fmt::format("{}\n", line);
  }
  return text;
}

void AddGroups(const pb::Descriptor& type, const std::string& name, std::string comment,
               OptionRing ring, bool is_expert, std::vector<OptionGroup>& groups) {
  const std::size_t place = groups.size();
  groups.push_back({name, std::move(comment), {}});
  for (int i = 0; i < type.field_count(); ++i) {
    const pb::FieldDescriptor& field = *type.field(i);
    if (field.message_type() == nullptr || field.is_repeated()) {
      if (is_expert == (ring == OptionRing::kExpert)) groups[place].options.push_back(&field);
      continue;
    }
    const bool is_deeper = is_expert || field.name() == kExpert;
    if (is_deeper && ring == OptionRing::kEveryday) continue;
    std::string about = CommentOf(field);
    if (about.empty()) about = CommentOf(*field.message_type());
    AddGroups(*field.message_type(), name.empty() ? field.name() : name + "." + field.name(),
              std::move(about), ring, is_deeper, groups);
  }
  if (groups[place].options.empty()) groups.erase(groups.begin() + static_cast<long>(place));
}

std::vector<std::string> StagesIn(const pb::Descriptor& type) {
  std::vector<std::string> names;
  for (int i = 0; i < type.field_count(); ++i) {
    if (type.field(i)->message_type() != nullptr) names.push_back(type.field(i)->name());
  }
  return names;
}

}  // namespace

std::unique_ptr<pb::DescriptorPool> LoadOptionDescriptors() {
  pb::FileDescriptorSet files;
  if (!files.ParseFromString(OptionDescriptors())) return nullptr;
  auto pool = std::make_unique<pb::DescriptorPool>();
  for (const pb::FileDescriptorProto& file : files.file()) {
    if (pool->BuildFile(file) == nullptr) return nullptr;
  }
  return pool;
}

Result<const pb::Descriptor*> FindStage(const pb::Descriptor& program, std::string_view stage) {
  const pb::Descriptor* type = &program;
  while (!stage.empty()) {
    const std::string name(stage.substr(0, stage.find('.')));
    const pb::FieldDescriptor* field = type->FindFieldByName(name);
    if (field == nullptr || field->message_type() == nullptr) {
      const std::vector<std::string> known = StagesIn(*type);
      return Err(InvalidArgument(fmt::format("there is no group of options '{}'.{} There are: {}",
                                             name, DidYouMean(name, known), JoinNames(known))));
    }
    type = field->message_type();
    stage.remove_prefix(std::min(name.size() + 1, stage.size()));
  }
  return type;
}

bool IsExpert(std::string_view name) {
  return name == kExpert || name.ends_with(".expert") || name.starts_with("expert.") ||
         name.find(".expert.") != std::string_view::npos;
}

std::vector<OptionGroup> GroupsOf(const pb::Descriptor& type, const std::string& name,
                                  OptionRing ring) {
  std::vector<OptionGroup> groups;
  AddGroups(type, name, CommentOf(type), ring, IsExpert(name), groups);
  return groups;
}

std::string Comment(const pb::FieldDescriptor& field) { return CommentOf(field); }
std::string Comment(const pb::EnumValueDescriptor& value) { return CommentOf(value); }

std::string DefaultText(const pb::FieldDescriptor& field) {
  if (!field.has_default_value()) return {};
  pb::FieldDescriptorProto proto;
  field.CopyTo(&proto);
  const bool is_text = field.cpp_type() == pb::FieldDescriptor::CPPTYPE_STRING;
  return is_text ? fmt::format("\"{}\"", proto.default_value()) : proto.default_value();
}

}  // namespace isotherm
