#include "ground/cli/option_list.h"

#include <fmt/format.h>
#include <google/protobuf/descriptor.h>

#include <algorithm>
#include <memory>

#include "common/options/nearest_name.h"
#include "ground/cli/option_tree.h"

namespace isotherm {
namespace {

namespace pb = google::protobuf;

struct Program {
  const char* name;
  const char* message;
  const char* used_by;
};

constexpr Program kPrograms[] = {
    {"ground", "isotherm.GroundOptions",
     "isotherm-ground and isotherm reconstruct, render, export, calibrate"},
    {"edge", "isotherm.EdgeOptions", "isotherm-edge"},
    {"simulate", "isotherm.SimulationOptions", "isotherm simulate"},
};

/// This stands before the page's tables.
constexpr const char* kPageHead = R"(# Options

<!-- Made from the comments of the .proto files; option_list_test compares. To update it:
     isotherm options --markdown > docs/options.md -->

Every option of every program, in two rings: first what a person sets for a scan, then what is there for experts, in
the `expert` block of each stage. What belongs to a camera (near range, noise, time constant, lens) is in the
[rig file](data.md#rig-file). Names are those that `--set` takes. In a configuration file (protobuf text format) dots are
braces: `tsdf.expert.max_weight=100` is `tsdf { expert { max_weight: 100 } }`. `isotherm options` lists the same.
)";

std::string Indented(const std::string& text, std::string_view indent) {
  std::string indented;
  std::string_view rest = text;
  while (!rest.empty()) {
    const std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(line.size() + 1, rest.size()));
    indented += fmt::format("{}{}\n", indent, line);
  }
  return indented;
}

std::string DefaultOf(const pb::FieldDescriptor& field) {
  if (field.is_repeated() && field.message_type() != nullptr) return "   (several; in a file only)";
  if (field.is_repeated()) return "   (several)";
  const std::string value = DefaultText(field);
  return value.empty() ? "   (none)" : " = " + value;
}

/// Returns what may stand for an option: the names of an enumeration, the fields of each of several
/// groups.
std::string Choices(const pb::FieldDescriptor& field) {
  std::string text;
  if (const pb::EnumDescriptor* type = field.enum_type()) {
    for (int i = 0; i < type->value_count(); ++i) {
      const std::string comment = Indented(Comment(*type->value(i)), "        ");
      text += fmt::format("      {}{}\n{}", type->value(i)->name(), comment.empty() ? "" : ":",
                          comment);
    }
  }
  if (field.message_type() == nullptr) return text;
  for (const OptionGroup& group : GroupsOf(*field.message_type(), "", OptionRing::kEveryday)) {
    for (const pb::FieldDescriptor* part : group.options) {
      text += fmt::format("      {}{}{}\n{}", group.name, group.name.empty() ? "" : ".",
                          part->name() + DefaultOf(*part), Indented(Comment(*part), "        "));
    }
  }
  return text;
}

std::string List(const std::vector<OptionGroup>& groups) {
  std::string text;
  for (const OptionGroup& group : groups) {
    if (!group.name.empty())
      text += fmt::format("\n{}:\n{}", group.name, Indented(group.comment, "  "));
    for (const pb::FieldDescriptor* field : group.options) {
      text +=
          fmt::format("  {}{}{}{}\n{}{}", group.name, group.name.empty() ? "" : ".", field->name(),
                      DefaultOf(*field), Indented(Comment(*field), "      "), Choices(*field));
    }
  }
  return text;
}

/// In a cell of a table.
std::string Cell(std::string_view text) {
  std::string cell;
  for (const char c : text) {
    if (c == '|') cell += '\\';
    cell += c == '\n' ? ' ' : c;
  }
  while (cell.ends_with(' ')) cell.pop_back();
  return cell;
}

std::string Meaning(const pb::FieldDescriptor& field) {
  std::string text = Comment(field);
  if (const pb::EnumDescriptor* type = field.enum_type()) {
    for (int i = 0; i < type->value_count(); ++i) {
      const std::string comment = Cell(Comment(*type->value(i)));
      text +=
          fmt::format(" `{}`{}{}", type->value(i)->name(), comment.empty() ? "" : ": ", comment);
    }
  }
  if (field.message_type() != nullptr) {
    std::vector<std::string> parts;
    for (const OptionGroup& group : GroupsOf(*field.message_type(), "", OptionRing::kEveryday)) {
      for (const pb::FieldDescriptor* part : group.options)
        parts.push_back(
            fmt::format("`{}{}{}`", group.name, group.name.empty() ? "" : ".", part->name()));
    }
    text += "Each has " + JoinNames(parts) + ".";
  }
  return Cell(text);
}

std::string Tables(const std::vector<OptionGroup>& groups) {
  std::string text;
  for (const OptionGroup& group : groups) {
    if (!group.name.empty()) text += fmt::format("\n#### {}\n", group.name);
    if (!group.comment.empty()) text += "\n" + group.comment;
    if (group.options.empty()) continue;
    text += "\n| option | default | meaning |\n|---|---|---|\n";
    for (const pb::FieldDescriptor* field : group.options) {
      const std::string value = DefaultText(*field);
      text += fmt::format("| `{}{}{}` | {} | {} |\n", group.name, group.name.empty() ? "" : ".",
                          field->name(), value.empty() ? "" : "`" + value + "`", Meaning(*field));
    }
  }
  return text;
}

}  // namespace

std::vector<std::string> ProgramsWithOptions() {
  std::vector<std::string> names;
  for (const Program& program : kPrograms) names.emplace_back(program.name);
  return names;
}

Result<std::string> ListOptions(std::string_view program_name, std::string_view stage,
                                bool with_expert) {
  const auto* program = std::ranges::find(kPrograms, program_name, &Program::name);
  if (program == std::end(kPrograms)) {
    const std::vector<std::string> known = ProgramsWithOptions();
    return Err(InvalidArgument(fmt::format("there are no options of '{}'.{} There are those of: {}",
                                           program_name, DidYouMean(program_name, known),
                                           JoinNames(known))));
  }
  const std::unique_ptr<pb::DescriptorPool> pool = LoadOptionDescriptors();
  const pb::Descriptor* type = pool ? pool->FindMessageTypeByName(program->message) : nullptr;
  if (type == nullptr) return Err(Internal("the descriptions of options cannot be read"));
  const Result<const pb::Descriptor*> listed = FindStage(*type, stage);
  if (!listed) return Err(listed.error());
  const std::string prefix(stage);
  std::string text = fmt::format(
      "Options of {}, with their defaults: --set NAME=VALUE, or in the file of --config\n",
      program->used_by);
  text += List(GroupsOf(**listed, prefix, OptionRing::kEveryday));
  const std::vector<OptionGroup> expert = GroupsOf(**listed, prefix, OptionRing::kExpert);
  if (with_expert || IsExpert(stage)) return text + List(expert);
  std::size_t left_out = 0;
  for (const OptionGroup& group : expert) left_out += group.options.size();
  if (left_out > 0) text += fmt::format("\n{} more for experts: --expert\n", left_out);
  return text;
}

Result<std::string> OptionsPage() {
  const std::unique_ptr<pb::DescriptorPool> pool = LoadOptionDescriptors();
  if (!pool) return Err(Internal("the descriptions of options cannot be read"));
  std::string text = kPageHead;
  for (const auto& [ring, title] : {std::pair(OptionRing::kEveryday, "Everyday options"),
                                    std::pair(OptionRing::kExpert, "Expert options")}) {
    text += fmt::format("\n## {}\n", title);
    for (const Program& program : kPrograms) {
      const pb::Descriptor* type = pool->FindMessageTypeByName(program.message);
      if (type == nullptr) return Err(Internal("the descriptions of options cannot be read"));
      text += fmt::format("\n### {}: {}\n", title, program.used_by);
      text += Tables(GroupsOf(*type, "", ring));
    }
  }
  return text;
}

}  // namespace isotherm
