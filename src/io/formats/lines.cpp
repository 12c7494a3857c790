#include "src/io/formats/lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "needlework/error.h"
#include "src/io/decimal.h"

namespace needlework::io {
namespace {

// The part of a file that is in memory.
constexpr std::size_t longest_line = std::size_t{1} << 20;

constexpr std::string_view byte_order_mark = "\xef\xbb\xbf";

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

Lines::Lines(InputText& file, std::string_view path, PlaceInText from)
    : file_(&file), next_(from.offset) {
  file.seek(from.offset);
  row_.path = path;
  row_.number = from.lines;
}

// Puts more of the file behind the rest of the block; false at its end.
bool Lines::read_block() {
  if (!file_) return false;
  if (rest_.size() == longest_line) {
    ++row_.number;
    reject(fmt::format("more than {} bytes: expected a shorter line", longest_line));
  }
  block_.erase(0, block_.size() - rest_.size());
  const std::size_t kept = block_.size();
  block_.resize(longest_line);
  block_.resize(kept + file_->read(block_.data() + kept, longest_line - kept));
  rest_ = block_;
  return block_.size() > kept;
}

bool Lines::pass_if_any() {
  std::size_t end = rest_.find('\n');
  while (end == rest_.npos) {
    const std::size_t searched = rest_.size();
    if (!read_block()) break;
    end = rest_.find('\n', searched);
  }
  if (rest_.empty()) return false;
  line_ = rest_.substr(0, end);
  has_end_ = end != rest_.npos;
  rest_.remove_prefix(std::min(line_.size() + 1, rest_.size()));
  offset_ = next_;
  next_ += line_.size() + 1;
  ++row_.number;
  row_.fields.clear();
  if (row_.number == 1 && line_.starts_with(byte_order_mark)) {
    line_.remove_prefix(byte_order_mark.size());
  }
  if (line_.ends_with('\r')) line_.remove_suffix(1);
  return true;
}

bool Lines::advance_if_any() {
  if (!pass_if_any()) return false;
  for (std::size_t i = 0; i < line_.size();) {
    const std::size_t begin = i;
    while (i < line_.size() && !separates(line_[i])) ++i;
    if (i > begin) row_.fields.push_back(line_.substr(begin, i - begin));
    while (i < line_.size() && separates(line_[i])) ++i;
  }
  return true;
}

bool Lines::advance_to_text() {
  while (advance_if_any()) {
    if (!is_blank()) return true;
  }
  return false;
}

void Lines::advance(std::string_view expected) { require(advance_if_any(), expected); }

void Lines::pass(std::string_view expected) { require(pass_if_any(), expected); }

void Lines::require(bool found, std::string_view expected) const {
  if (found) return;
  throw InputError(fmt::format("{}: cut short {} line {}: expected {}{}", row_.path,
                               has_end_ ? "after" : "in", row_.number, expected, advice_));
}

std::string advice_where_cut_short(std::size_t frame) {
  if (frame == 0) return "";
  if (frame == 1) return "; the frame before it is whole: --frame 0 reads it";
  return fmt::format("; the {} frames before it are whole: --frame {} reads the last of them",
                     frame, frame - 1);
}

void refuse_frame(std::string_view path, std::size_t frame, std::size_t frames) {
  throw InputError(fmt::format("{}: frame {}: expected one below {}, as there are so many frames",
                               path, frame, frames));
}

}  // namespace needlework::io
