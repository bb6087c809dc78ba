#include "common/options/reserved_fields.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/io/tokenizer.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>

#include <string_view>
#include <utility>

namespace isotherm {
namespace {

namespace pb = google::protobuf;
using pb::io::Tokenizer;

class NoErrors final : public pb::io::ErrorCollector {
 public:
  void AddError(int, pb::io::ColumnNumber, const std::string&) override {}
};

/// Goes through a text field by field. Each step takes at least one token, so it ends on any text.
class Walker {
 public:
  explicit Walker(const std::string& text)
      : stream_(text.data(), static_cast<int>(text.size())), tokens_(&stream_, &no_errors_) {
    tokens_.set_comment_style(Tokenizer::SH_COMMENT_STYLE);
    tokens_.set_allow_f_after_float(true);
    tokens_.set_require_space_after_number(false);
    tokens_.set_allow_multiline_strings(true);
    Next();
  }

  /// Reads up to what closes the message, or to the end. `type` is nullptr in a field that is not
  /// known.
  void Fields(const pb::Descriptor* type, int depth) {
    while (!at_end_ && !Is("}") && !Is(">")) {
      if (tokens_.current().type != Tokenizer::TYPE_IDENTIFIER) {
        Next();
        continue;
      }
      const Tokenizer::Token name = tokens_.current();
      const pb::FieldDescriptor* field =
          type == nullptr ? nullptr : type->FindFieldByName(name.text);
      if (type != nullptr && field == nullptr && type->IsReservedName(name.text))
        found_.push_back({name.line, name.column, type, name.text});
      Next();
      if (Is(":")) Next();
      Value(field == nullptr ? nullptr : field->message_type(), depth);
    }
  }

  std::vector<ReservedField> TakeFound() { return std::move(found_); }

 private:
  void Next() { at_end_ = !tokens_.Next(); }
  bool Is(std::string_view text) { return !at_end_ && tokens_.current().text == text; }

  void Value(const pb::Descriptor* type, int depth) {
    if (Is("{") || Is("<")) {
      Next();
      if (depth >= kMaxNesting) return;  // The parser refuses such a text, with a message.
      Fields(type, depth + 1);
      if (!at_end_) Next();
    } else if (Is("[")) {
      Next();
      while (!at_end_ && !Is("]")) Element(type, depth);
      if (!at_end_) Next();
    } else if (!Is("}") && !Is(">")) {
      if (Is("-")) Next();
      if (!at_end_) Next();
    }
  }
  /// Reads one element of a list.
  void Element(const pb::Descriptor* type, int depth) {
    if (Is("{") || Is("<")) {
      Value(type, depth);
    } else {
      Next();
    }
  }

  pb::io::ArrayInputStream stream_;
  NoErrors no_errors_;
  Tokenizer tokens_;
  bool at_end_ = false;
  std::vector<ReservedField> found_;
};

}  // namespace

std::vector<ReservedField> FindReservedFields(const std::string& text, const pb::Descriptor& type) {
  Walker walker(text);
  walker.Fields(&type, 0);
  return walker.TakeFound();
}

}  // namespace isotherm
