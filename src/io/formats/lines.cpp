#include "src/io/formats/lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "needlework/error.h"
#include "src/io/decimal.h"

namespace needlework::io {
namespace {

bool separates(char c) { return c == ' ' || c == '\t' || c == '\r'; }

}  // namespace

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  std::size_t begin = 0;
  char quote = 0;
  for (std::size_t i = 0; i <= line.size(); ++i) {
    if (i < line.size() && (line[i] == '"' || line[i] == '\'')) {
      if (quote == 0) {
        quote = line[i];
      } else if (quote == line[i]) {
        quote = 0;
      }
    }
    if (i == line.size() || (quote == 0 && separates(line[i]))) {
      if (i > begin) words.push_back(line.substr(begin, i - begin));
      begin = i + 1;
    }
  }
  return words;
}

std::string quotation(std::string_view text) {
  constexpr std::size_t longest = 80;
  if (text.size() <= longest) return std::string(text);
  return std::string(text.substr(0, longest)) + "...";
}

double Row::read(std::size_t field, std::string_view name) const {
  double value = 0;
  const std::errc error = read_decimal(fields[field], value);
  if (error == std::errc()) return value;
  reject(fmt::format("{} = {}: expected {}", name, quotation(fields[field]),
                     error == std::errc::result_out_of_range ? "a number that a double can hold"
                                                             : "a finite number"));
}

std::int64_t Row::read_whole(std::size_t field, std::string_view name, std::int64_t least,
                             std::int64_t most) const {
  const std::string_view text = fields[field];
  std::int64_t value = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc() && stop == text.data() + text.size() && value >= least &&
      value <= most) {
    return value;
  }
  reject(fmt::format("{} = {}: expected a whole number from {} to {}", name, quotation(text), least,
                     most));
}

void Row::reject(std::string_view reason) const {
  throw InputError(fmt::format("{}: line {}: {}", path, number, reason));
}

Lines::Lines(std::string_view text, std::string_view path, std::size_t from)
    : text_(text), next_(from) {
  row_.path = path;
  row_.number = static_cast<std::size_t>(std::count(text.begin(), text.begin() + from, '\n'));
}

bool Lines::advance_if_any() {
  if (next_ >= text_.size()) return false;
  offset_ = next_;
  const std::size_t end = std::min(text_.find('\n', next_), text_.size());
  line_ = text_.substr(next_, end - next_);
  next_ = end + 1;
  ++row_.number;
  row_.fields.clear();
  for (std::size_t i = 0; i < line_.size();) {
    const std::size_t begin = i;
    while (i < line_.size() && !separates(line_[i])) ++i;
    if (i > begin) row_.fields.push_back(line_.substr(begin, i - begin));
    while (i < line_.size() && separates(line_[i])) ++i;
  }
  return true;
}

void Lines::advance(std::string_view expected) {
  if (advance_if_any()) return;
  throw InputError(
      fmt::format("{}: cut short after line {}: expected {}", row_.path, row_.number, expected));
}

}  // namespace needlework::io
