#include "common/options/text_proto.h"

#include <fmt/format.h>
#include <google/protobuf/descriptor.h>
#include <google/protobuf/io/tokenizer.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <google/protobuf/message.h>
#include <google/protobuf/text_format.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <set>
#include <vector>

#include "common/base/read_file.h"
#include "common/options/nearest_name.h"
#include "common/options/renamed_options.h"
#include "common/options/reserved_fields.h"

namespace isotherm {
namespace {

namespace pb = google::protobuf;

constexpr std::uint64_t kMaxFileBytes = 1U << 20;  // Far above any configuration.
// A file with more mistakes is no configuration; the list would scroll away.
constexpr std::size_t kMaxErrors = 50;
constexpr std::size_t kMaxMessageBytes = 300;  // Protobuf quotes what it found, however long.
// Text that is parsed again and again to list all errors: enough for any real file.
constexpr std::size_t kMaxRepairBytes = 4U << 20;

struct Location {
  int line = 0;  // From 0, as protobuf counts.
  int column = 0;
  // Clang-tidy 14 takes its result for a pointer.
  friend auto operator<=>(const Location&,
                          const Location&) = default;  // NOLINT(modernize-use-nullptr)
};

struct TextError {
  Location at;
  std::string message;
};

struct Token {
  Location at;
  std::size_t begin = 0;  // Byte range in the text.
  std::size_t end = 0;
  std::string text;
};

class Collector final : public pb::io::ErrorCollector {
 public:
  void AddError(int line, pb::io::ColumnNumber column, const std::string& message) override {
    if (errors.size() < kMaxErrors)
      errors.push_back({{line, column}, message.substr(0, kMaxMessageBytes)});
  }
  std::vector<TextError> errors;
};

// Byte offset of each line's start.
std::vector<std::size_t> LineStarts(const std::string& text) {
  std::vector<std::size_t> starts{0};
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\n') starts.push_back(i + 1);
  }
  return starts;
}

std::vector<Token> Tokenize(const std::string& text) {
  const std::vector<std::size_t> starts = LineStarts(text);
  pb::io::ArrayInputStream stream(text.data(), static_cast<int>(text.size()));
  Collector ignored;
  pb::io::Tokenizer tokenizer(&stream, &ignored);
  tokenizer.set_comment_style(pb::io::Tokenizer::SH_COMMENT_STYLE);
  tokenizer.set_allow_f_after_float(true);
  tokenizer.set_require_space_after_number(false);
  tokenizer.set_allow_multiline_strings(true);
  std::vector<Token> tokens;
  int line = -1, column = 0;
  std::size_t offset = 0;
  while (tokenizer.Next()) {
    const pb::io::Tokenizer::Token& current = tokenizer.current();
    Token token{{current.line, current.column}, 0, 0, current.text};
    if (current.line != line) {
      line = current.line;
      column = 0;
      offset = starts[static_cast<std::size_t>(line)];
    }
    // The tokenizer counts a tab as a step to the next multiple of 8; go on from the token before
    // in the same way.
    for (; column < current.column && offset < text.size(); ++offset) {
      column += text[offset] == '\t' ? 8 - column % 8 : 1;
    }
    token.begin = offset;
    token.end = std::min(text.size(), offset + current.text.size());
    tokens.push_back(std::move(token));
  }
  return tokens;
}

std::vector<std::string> FieldNames(const pb::Descriptor& type) {
  std::vector<std::string> names;
  for (int i = 0; i < type.field_count(); ++i) names.push_back(type.field(i)->name());
  return names;
}

std::string UnknownField(const pb::Descriptor& type, const std::string& name) {
  return fmt::format("unknown field '{}'.{} Known fields here: {}.", name,
                     SuggestOption(type, name), JoinNames(FieldNames(type)));
}

// Protobuf's wording for an unknown field, with its type's fields added.
void ExplainUnknownField(const pb::Descriptor& root, TextError& error) {
  constexpr std::string_view kType = "Message type \"";
  constexpr std::string_view kField = "\" has no field named \"";
  const std::size_t field = error.message.find(kField);
  if (!error.message.starts_with(kType) || field == std::string::npos) return;
  const std::string type_name = error.message.substr(kType.size(), field - kType.size());
  std::string name = error.message.substr(field + kField.size());
  // Longer than any field of ours: the rest is whatever stands in the file.
  constexpr std::size_t kMaxNameBytes = 64;
  name.resize(std::min({name.find('"'), name.size(), kMaxNameBytes}));
  const pb::Descriptor* type = root.file()->pool()->FindMessageTypeByName(type_name);
  if (type == nullptr) return;
  error.message = UnknownField(*type, name);
}

bool IsAboutFieldBefore(const std::string& message) {
  return message.find("has no field named") != std::string::npos ||
         message.find("is specified multiple times") != std::string::npos;
}

std::optional<std::size_t> TokenAt(const std::vector<Token>& tokens, Location at) {
  for (std::size_t i = 0; i < tokens.size(); ++i) {
    if (tokens[i].at == at) return i;
  }
  return std::nullopt;
}

// One past the last token of the value that starts at `first`: a scalar with its sign, or a whole {
// } group.
std::size_t EndOfValue(const std::vector<Token>& tokens, std::size_t first) {
  std::size_t i = first;
  if (i < tokens.size() && tokens[i].text == "-") ++i;
  int depth = 0;
  for (; i < tokens.size(); ++i) {
    if (tokens[i].text == "{" || tokens[i].text == "<") ++depth;
    if (tokens[i].text == "}" || tokens[i].text == ">") --depth;
    if (depth <= 0) return i + 1;
  }
  return tokens.size();
}

std::string Blanked(const std::string& text, std::size_t begin, std::size_t end) {
  std::string result = text;
  for (std::size_t i = begin; i < end; ++i) {
    if (result[i] != '\n' && result[i] != '\t') result[i] = ' ';
  }
  return result;
}

// Texts in which the error at token `i` is out of the way, the least intrusive first. All keep the
// positions of what follows on other lines.
std::vector<std::string> Repairs(const std::string& text, const std::vector<Token>& tokens,
                                 std::size_t i, bool about_field_before) {
  std::vector<std::string> repairs;
  if (!about_field_before) {
    for (const std::string value : {"0", "\"\""}) {
      const std::size_t length = tokens[i].end - tokens[i].begin;
      if (value.size() > length) continue;
      std::string repaired = Blanked(text, tokens[i].begin, tokens[i].end);
      repairs.push_back(repaired.replace(tokens[i].begin, value.size(), value));
    }
  }
  // Without the whole field: name, separator and value.
  std::size_t name = i;
  if (about_field_before && i > 0) name = i - 1;
  if (!about_field_before && i >= 2 && tokens[i - 1].text == ":") name = i - 2;
  std::size_t value = name + 1;
  if (value < tokens.size() && tokens[value].text == ":") ++value;
  const std::size_t end = EndOfValue(tokens, value);
  repairs.push_back(Blanked(text, tokens[name].begin, tokens[end - 1].end));
  repairs.push_back(Blanked(text, tokens[i].begin, tokens[i].end));
  return repairs;
}

struct Attempt {
  std::vector<TextError> errors;
  pb::TextFormat::ParseInfoTree tree;
};

void Parse(const std::string& text, pb::Message& message, Attempt& attempt) {
  Collector collector;
  pb::TextFormat::Parser parser;
  parser.RecordErrorsTo(&collector);
  parser.WriteLocationsTo(&attempt.tree);
  parser.SetRecursionLimit(kMaxNesting);
  parser.AllowPartialMessage(true);  // Missing fields are listed by CollectMissing.
  message.Clear();
  if (!parser.ParseFromString(text, &message) && collector.errors.empty()) {
    collector.errors.push_back({{0, 0}, "not in protobuf text format"});
  }
  attempt.errors = std::move(collector.errors);
}

// Protobuf stops at the first error. To list all, each error is repaired in a copy of the text, and
// the copy is parsed again: the next error must then come later. In a large file only the first few
// are listed.
std::vector<TextError> CollectErrors(std::string text, const pb::Message& prototype,
                                     std::vector<TextError> errors) {
  std::vector<TextError> all;
  std::size_t repair_bytes = 0;
  std::unique_ptr<pb::Message> scratch(prototype.New());
  while (!errors.empty() && all.size() < kMaxErrors) {
    const std::vector<Token> tokens = Tokenize(text);
    for (const TextError& error : errors) all.push_back(error);
    const Location last = errors.back().at;
    const bool about_field_before = IsAboutFieldBefore(errors.back().message);
    const std::optional<std::size_t> token = TokenAt(tokens, last);
    if (!token || repair_bytes > kMaxRepairBytes) break;
    if (about_field_before && *token > 0) all.back().at = tokens[*token - 1].at;
    bool repaired = false;
    for (std::string& repair : Repairs(text, tokens, *token, about_field_before)) {
      Attempt attempt;
      Parse(repair, *scratch, attempt);
      repair_bytes += repair.size();
      if (!attempt.errors.empty() && attempt.errors.front().at <= last) continue;
      text = std::move(repair);
      errors = std::move(attempt.errors);
      repaired = true;
      break;
    }
    if (!repaired) break;
  }
  return all;
}

// Required fields that are absent, each at the place of the message that lacks it.
void CollectMissing(const pb::Message& message, pb::TextFormat::ParseInfoTree* tree, Location here,
                    const std::string& prefix, std::vector<TextError>& errors) {
  const pb::Reflection& reflection = *message.GetReflection();
  const pb::Descriptor& type = *message.GetDescriptor();
  for (int i = 0; i < type.field_count(); ++i) {
    const pb::FieldDescriptor* field = type.field(i);
    if (field->is_repeated()) continue;
    const bool present = reflection.HasField(message, field);
    if (field->is_required() && !present) {
      errors.push_back(
          {here, fmt::format("required field '{}{}' is missing", prefix, field->name())});
    }
    if (!present || field->cpp_type() != pb::FieldDescriptor::CPPTYPE_MESSAGE) continue;
    Location there = here;
    pb::TextFormat::ParseInfoTree* nested = nullptr;
    if (tree != nullptr) {
      const auto location = tree->GetLocation(field, -1);
      there = {location.line, location.column};
      nested = tree->GetTreeForNested(field, -1);
    }
    CollectMissing(reflection.GetMessage(message, field), nested, there,
                   prefix + field->name() + ".", errors);
  }
}

Status ErrorsToStatus(std::string_view source_name, std::vector<TextError> errors) {
  if (errors.empty()) return OkStatus();
  std::stable_sort(errors.begin(), errors.end(),
                   [](const TextError& a, const TextError& b) { return a.at < b.at; });
  std::string text;
  for (const TextError& error : errors) {
    if (!text.empty()) text += '\n';
    text += fmt::format("{}:{}:{}: {}", source_name, std::max(error.at.line, 0) + 1,
                        std::max(error.at.column, 0) + 1, error.message);
  }
  return InvalidArgument(std::move(text));
}

void SetDefaults(pb::Message& message);

bool HasRequiredFields(const pb::Descriptor& type) {
  for (int i = 0; i < type.field_count(); ++i) {
    if (type.field(i)->is_required()) return true;
  }
  return false;
}

void SetDefault(pb::Message& message, const pb::FieldDescriptor* field) {
  const pb::Reflection& reflection = *message.GetReflection();
  if (field->cpp_type() == pb::FieldDescriptor::CPPTYPE_MESSAGE) {
    if (reflection.HasField(message, field) || !HasRequiredFields(*field->message_type())) {
      SetDefaults(*reflection.MutableMessage(&message, field));
    }
    return;
  }
  if (reflection.HasField(message, field)) return;
  switch (field->cpp_type()) {
    case pb::FieldDescriptor::CPPTYPE_INT32:
      return reflection.SetInt32(&message, field, field->default_value_int32());
    case pb::FieldDescriptor::CPPTYPE_INT64:
      return reflection.SetInt64(&message, field, field->default_value_int64());
    case pb::FieldDescriptor::CPPTYPE_UINT32:
      return reflection.SetUInt32(&message, field, field->default_value_uint32());
    case pb::FieldDescriptor::CPPTYPE_UINT64:
      return reflection.SetUInt64(&message, field, field->default_value_uint64());
    case pb::FieldDescriptor::CPPTYPE_DOUBLE:
      return reflection.SetDouble(&message, field, field->default_value_double());
    case pb::FieldDescriptor::CPPTYPE_FLOAT:
      return reflection.SetFloat(&message, field, field->default_value_float());
    case pb::FieldDescriptor::CPPTYPE_BOOL:
      return reflection.SetBool(&message, field, field->default_value_bool());
    case pb::FieldDescriptor::CPPTYPE_ENUM:
      return reflection.SetEnum(&message, field, field->default_value_enum());
    case pb::FieldDescriptor::CPPTYPE_STRING:
      if (field->has_default_value()) {
        reflection.SetString(&message, field, field->default_value_string());
      }
      return;
    case pb::FieldDescriptor::CPPTYPE_MESSAGE:
      return;
  }
}

void SetDefaults(pb::Message& message) {
  const pb::Descriptor& type = *message.GetDescriptor();
  for (int i = 0; i < type.field_count(); ++i) {
    const pb::FieldDescriptor* field = type.field(i);
    // A calibration that is absent stays absent.
    if (!field->is_repeated() && (field->has_default_value() || field->message_type() != nullptr)) {
      SetDefault(message, field);
    }
  }
}

}  // namespace

Status ParseTextProto(const std::string& text, std::string_view source_name, pb::Message& message) {
  if (text.size() > kMaxFileBytes) {
    return InvalidArgument(
        fmt::format("{}: {} bytes are too many for a text file of this kind (at most {})",
                    source_name, text.size(), kMaxFileBytes));
  }
  if (const std::size_t zero = text.find('\0'); zero != std::string::npos) {
    return InvalidArgument(fmt::format("{}: not a text file: byte {} is zero", source_name, zero));
  }
  Attempt attempt;
  Parse(text, message, attempt);
  std::vector<TextError> errors = attempt.errors;
  if (errors.empty()) {
    CollectMissing(message, &attempt.tree, {}, "", errors);
  } else {
    errors = CollectErrors(text, message, std::move(errors));
    for (TextError& error : errors) ExplainUnknownField(*message.GetDescriptor(), error);
  }
  for (const ReservedField& field : FindReservedFields(text, *message.GetDescriptor())) {
    if (errors.size() >= kMaxErrors) break;
    errors.push_back({{field.line, field.column}, UnknownField(*field.type, field.name)});
  }
  return ErrorsToStatus(source_name, std::move(errors));
}

Status LoadTextProto(const std::filesystem::path& path, pb::Message& message) {
  const Result<std::string> text = ReadFile(path, kMaxFileBytes);
  if (text) return ParseTextProto(*text, path.string(), message);
  // A file that is too large to be a configuration is not damaged: another one was meant.
  if (text.error().code() == StatusCode::kDataLoss) return InvalidArgument(text.error().message());
  return text.error();
}

std::string ToTextProto(const pb::Message& message) {
  std::unique_ptr<pb::Message> complete(message.New());
  complete->CopyFrom(message);
  SetDefaults(*complete);
  std::string text;
  pb::TextFormat::PrintToString(*complete, &text);
  return text;
}

}  // namespace isotherm
