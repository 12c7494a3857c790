#include "src/scene_text/toml_guard.h"

#include <fmt/format.h>

#include <algorithm>

#include "src/scene/printable.h"

namespace needlework {
namespace {

bool beyond_ascii(char c) { return static_cast<unsigned char>(c) >= 0x80; }

bool is_digit(std::string_view text, std::size_t at) {
  return at < text.size() && text[at] >= '0' && text[at] <= '9';
}

// The bytes of the character that begins at `begin`, as far as it is valid.
std::string_view character(std::string_view text, std::size_t begin) {
  std::size_t end = begin + 1;
  while (end < text.size() && end < begin + 4 && (text[end] & '\xc0') == '\x80') ++end;
  return text.substr(begin, end - begin);
}

// Follows the syntax of TOML closely enough to know where a string begins. In text that is not
// TOML, follows it as far as the parser does.
class Scanner {
 public:
  explicit Scanner(std::string_view toml) : toml_(toml) {
    if (toml_.starts_with("\xef\xbb\xbf")) at_ = 3;
  }

  std::optional<TomlHazard> first_hazard() {
    constexpr std::string_view not_bare = " \t\r\n#\"'[]{},";
    while (at_ < toml_.size() && !hazard_) {
      const char c = toml_[at_];
      if (c == '#')
        at_ = std::min(toml_.find('\n', at_), toml_.size());
      else if ((c == '"' || c == '\'') && next_ != Next::end)
        skip_string();
      else if (next_ == Next::value && not_bare.find(c) == not_bare.npos)
        skip_bare_value();
      else
        step_over(c);
    }
    return hazard_;
  }

 private:
  enum class Next { key, value, end };  // end: the end of the value or of what contains it

  // Handles a character outside strings, comments and bare values.
  void step_over(char c) {
    constexpr std::string_view behind_values = " \t\r\n,]}";
    if (beyond_ascii(c)) return report_character("expected ASCII outside quotes and comments");
    if (next_ == Next::end && behind_values.find(c) == behind_values.npos)
      return report_character("expected the end of the line, or of what the value stands in");
    if (c == '.') ++dots_;
    if (c == '=') begin(Next::value);
    if (c == ',') begin(in_array() ? Next::value : Next::key);
    if (c == '\n') {
      ++line_;
      if (open_.empty()) begin(Next::key);
    }
    if (c == '[' || c == '{') {
      const bool header = c == '[' && next_ == Next::key;
      open_.push_back(header ? 'h' : c);
      begin(in_array() ? Next::value : Next::key);
    }
    if (c == ']' || c == '}') {
      if (!open_.empty()) open_.pop_back();
      begin(Next::end);
    }
    if (open_.size() > max_nesting || dots_ > max_nesting)
      hazard_ = {line_, fmt::format("expected at most {} levels of nesting", max_nesting)};
    ++at_;
  }

  void begin(Next next) {
    next_ = next;
    dots_ = 0;
  }

  bool in_array() const { return !open_.empty() && open_.back() == '['; }

  // Skips a number, a date, or what the parser takes for one before it finds the error. A date may
  // continue after a space with the two digits of an hour; after other values they are an error
  // anyway.
  void skip_bare_value() {
    constexpr std::string_view ends = " \t\r\n#,]}";
    for (; at_ < toml_.size(); ++at_) {
      const bool hour_follows =
          toml_[at_] == ' ' && is_digit(toml_, at_ + 1) && is_digit(toml_, at_ + 2);
      if (ends.find(toml_[at_]) != ends.npos && !hour_follows) break;
      if (beyond_ascii(toml_[at_]))
        return report_character("expected ASCII outside quotes and comments");
    }
    begin(Next::end);
  }

  void skip_string() {
    const char quote = toml_[at_];
    const std::string_view opening = toml_.substr(at_, 3);
    const bool triple = opening == std::string_view(quote == '"' ? R"(""")" : "'''");
    at_ += triple ? 3 : 1;
    if (next_ == Next::value) begin(Next::end);
    int quotes = 0;  // number of consecutive quotes
    for (; at_ < toml_.size() && !hazard_; ++at_) {
      const char c = toml_[at_];
      if (c == '\n' && !triple) return;  // a syntax error; the line ends like any other
      if (c == '\n') ++line_;
      quotes = c == quote ? quotes + 1 : 0;
      if (quotes == (triple ? 3 : 1)) {
        ++at_;
        // One or two before the closing three belong to the string.
        for (int more = 0; triple && more < 2 && at_ < toml_.size() && toml_[at_] == quote; ++more)
          ++at_;
        return;
      }
      if (c == '\\' && quote == '"') skip_escape(triple);
    }
  }

  // Leaves at_ on the last character of the escape.
  void skip_escape(bool triple) {
    constexpr std::string_view white_space = " \t\r\n";
    const auto next_is_space = [&] {
      return at_ + 1 < toml_.size() && white_space.find(toml_[at_ + 1]) != std::string_view::npos;
    };
    if (!triple || !next_is_space()) {
      ++at_;
    } else {
      while (next_is_space()) line_ += toml_[++at_] == '\n';
      if (at_ + 1 < toml_.size() && beyond_ascii(toml_[at_ + 1])) ++at_;
    }
    if (triple && at_ < toml_.size() && beyond_ascii(toml_[at_]))
      report_character("expected ASCII after a backslash that ends a line");
  }

  void report_character(std::string_view expected) {
    hazard_ = {line_,
               fmt::format("unexpected '{}': {}", printable(character(toml_, at_)), expected)};
  }

  std::string_view toml_;
  std::size_t at_ = 0;
  std::size_t line_ = 1;
  Next next_ = Next::key;
  std::string open_;      // open brackets: '[' array, '{' table, 'h' header of a table
  std::size_t dots_ = 0;  // number of dots in the present key
  std::optional<TomlHazard> hazard_;
};

}  // namespace

std::optional<TomlHazard> find_toml_hazard(std::string_view toml) {
  return Scanner(toml).first_hazard();
}

}  // namespace needlework
