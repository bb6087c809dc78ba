#include "common/options/edit_field.h"

#include <algorithm>
#include <cctype>
#include <cstddef>

namespace isotherm {
namespace {

bool IsWordCharacter(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.' || c == '-' ||
         c == '+';
}

/// Goes through the text word by word, over comments and quoted strings.
class Scanner {
 public:
  explicit Scanner(std::string_view text) : text_(text) {}

  /// Moves to the next word, quoted string or sign; false at the end.
  bool Next() {
    position_ = end_;
    while (position_ < text_.size()) {
      const char c = text_[position_];
      if (c == '#') {
        while (position_ < text_.size() && text_[position_] != '\n') ++position_;
      } else if (std::isspace(static_cast<unsigned char>(c)) != 0) {
        ++position_;
      } else {
        end_ = EndOfToken();
        return true;
      }
    }
    return false;
  }

  std::string_view token() const { return text_.substr(position_, end_ - position_); }
  std::size_t begin() const { return position_; }
  std::size_t end() const { return end_; }

 private:
  std::size_t EndOfToken() const {
    std::size_t end = position_ + 1;
    const char first = text_[position_];
    if (first == '"' || first == '\'') {
      while (end < text_.size() && text_[end] != first) end += text_[end] == '\\' ? 2 : 1;
      return std::min(end + 1, text_.size());
    }
    if (!IsWordCharacter(first)) return end;
    while (end < text_.size() && IsWordCharacter(text_[end])) ++end;
    return end;
  }

  const std::string_view text_;
  std::size_t position_ = 0, end_ = 0;
};

}  // namespace

std::string WithFieldSet(const std::string& text, std::string_view name, std::string_view value) {
  Scanner scanner(text);
  int depth = 0;
  while (scanner.Next()) {
    const std::string_view token = scanner.token();
    if (token == "{" || token == "<") ++depth;
    if (token == "}" || token == ">") --depth;
    if (depth != 0 || token != name) continue;
    if (!scanner.Next() || scanner.token() != ":" || !scanner.Next()) break;
    std::string edited = text;
    return edited.replace(scanner.begin(), scanner.end() - scanner.begin(), value);
  }
  std::string edited = text;
  if (!edited.empty() && edited.back() != '\n') edited += '\n';
  return edited.append(name).append(": ").append(value).append("\n");
}

}  // namespace isotherm
