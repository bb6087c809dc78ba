#include "tests/lint/word_rules.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace isotherm::lint {
namespace {

/// Words that begin a fragment. A sentence that begins with one of them is rare enough to be turned
/// round.
constexpr std::array<std::string_view, 6> kFragmentWords = {"Of",   "What",    "Those",
                                                            "That", "Whether", "Which"};

/// Beginnings of names that were replaced by kMax and kMin.
constexpr std::array<std::string_view, 10> kSuperlatives = {
    "Most",     "Least",  "Fewest",    "Longest",   "Shortest",
    "Smallest", "Widest", "Smoothest", "Narrowest", "Largest"};

/// A word that was replaced, and by what.
struct Replaced {
  std::string_view word;
  std::string_view by;
};
constexpr std::array<Replaced, 7> kReplaced = {{{"picture", "image"},
                                                {"pictures", "images"},
                                                {"judge", "assess"},
                                                {"judged", "assessed"},
                                                {"judges", "assesses"},
                                                {"share of", "fraction of"},
                                                {"in vain", "what was missing"}}};

bool IsWordCharacter(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

/// The first place of `word` in `text` where no letter, digit or underscore is beside it.
bool HasWord(std::string_view text, std::string_view word) {
  for (std::size_t at = text.find(word); at != std::string_view::npos;
       at = text.find(word, at + 1)) {
    const std::size_t end = at + word.size();
    const bool begins = at == 0 || !IsWordCharacter(text[at - 1]);
    if (begins && (end == text.size() || !IsWordCharacter(text[end]))) return true;
  }
  return false;
}

/// A comment of a line and what stands before it.
struct Comment {
  std::string_view code;
  std::string_view text;  ///< Behind the slashes and the blank.
  bool is_doc = false;
};

/// nullopt if the line has no comment. Slashes within a string are not taken for one; a quote
/// within a character literal is rare enough to be ignored.
std::optional<Comment> CommentOf(std::string_view line) {
  bool in_string = false;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    if (in_string && line[i] == '\\') {
      ++i;
      continue;
    }
    if (line[i] == '"') in_string = !in_string;
    if (in_string || line[i] != '/' || line[i + 1] != '/') continue;
    std::string_view text = line.substr(i + 2);
    const bool is_doc = text.starts_with('/');
    if (is_doc) text.remove_prefix(1);
    if (is_doc && text.starts_with('<')) text.remove_prefix(1);
    text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
    return Comment{line.substr(0, i), text, is_doc};
  }
  return std::nullopt;
}

bool IsBlank(std::string_view text) {
  return text.find_first_not_of(' ') == std::string_view::npos;
}

/// The constant that a line defines ("kMaxFrames"); empty if it defines none.
std::string_view ConstantOf(std::string_view code) {
  const std::size_t type = code.find("constexpr ");
  if (type == std::string_view::npos) return {};
  for (std::size_t at = code.find(" k", type); at != std::string_view::npos;
       at = code.find(" k", at + 1)) {
    const std::size_t begin = at + 1;
    std::size_t end = begin;
    while (end < code.size() && IsWordCharacter(code[end])) ++end;
    if (begin + 1 < end && std::isupper(static_cast<unsigned char>(code[begin + 1])) != 0)
      return code.substr(begin, end - begin);
  }
  return {};
}

class WordCheck {
 public:
  WordCheck(const SourceFile& file, std::vector<Violation>& violations)
      : file_(file), violations_(violations) {}

  void Run() {
    bool in_block = false;  // The line before was a comment, which this one may go on with.
    for (std::size_t i = 0; i < file_.lines.size(); ++i) {
      const std::string_view line = file_.lines[i];
      const std::optional<Comment> comment = CommentOf(line);
      CheckName(i, comment ? comment->code : line);
      const bool is_alone = comment && IsBlank(comment->code);
      if (comment) {
        if (!is_alone || !in_block) CheckBeginning(i, *comment);
        CheckReplaced(i, comment->text);
      }
      // A comment behind code may go on in the next line, alone and indented.
      in_block = comment.has_value();
    }
  }

 private:
  void Add(std::size_t line_index, std::string message) {
    violations_.push_back({file_.path, static_cast<int>(line_index + 1), std::move(message)});
  }

  void CheckName(std::size_t line_index, std::string_view code) {
    const std::string_view name = ConstantOf(code);
    for (const std::string_view superlative : kSuperlatives) {
      if (!name.substr(std::min<std::size_t>(1, name.size())).starts_with(superlative)) continue;
      const std::string_view rest = name.substr(1 + superlative.size());
      if (rest.empty() || std::islower(static_cast<unsigned char>(rest.front())) == 0)
        Add(line_index, "a bound is called kMax or kMin: " + std::string(name));
    }
  }

  void CheckBeginning(std::size_t line_index, const Comment& comment) {
    if (!comment.is_doc) return;  // Remarks within code may be short, and tables may run on.
    if (comment.text.starts_with("...")) Add(line_index, "a comment that runs on from another");
    for (const std::string_view word : kFragmentWords) {
      if (comment.text.starts_with(word) && HasWord(comment.text.substr(0, word.size() + 1), word))
        Add(line_index, "a doc comment is a sentence, this is a fragment: " + std::string(word));
    }
  }

  void CheckReplaced(std::size_t line_index, std::string_view text) {
    std::string lower(text);
    std::ranges::transform(lower, lower.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    for (const Replaced& replaced : kReplaced) {
      if (HasWord(lower, replaced.word)) {
        Add(line_index,
            "say '" + std::string(replaced.by) + "', not '" + std::string(replaced.word) + "'");
      }
    }
  }

  const SourceFile& file_;
  std::vector<Violation>& violations_;
};

}  // namespace

std::vector<Violation> CheckWords(const std::vector<SourceFile>& files) {
  std::vector<Violation> violations;
  for (const SourceFile& file : files) {
    if (file.IsCode()) WordCheck(file, violations).Run();
  }
  return violations;
}

}  // namespace isotherm::lint
