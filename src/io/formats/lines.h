// Walks through the lines of a text and the fields of a line.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace needlework::io {

/// What blanks separate in a line, and where the line stands. Messages have the form "PATH: line N:
/// reason".
struct Row {
  std::string_view path;
  std::size_t number = 0;  ///< of the line, counted from 1
  std::vector<std::string_view> fields;

  /// A field as a finite number, or as a whole number from `least` to `most`. `name` is used in
  /// messages: "NAME = VALUE: expected ...".
  double read(std::size_t field, std::string_view name) const;
  std::int64_t read_whole(std::size_t field, std::string_view name, std::int64_t least,
                          std::int64_t most) const;

  [[noreturn]] void reject(std::string_view reason) const;
};

/// The lines of a text, one after the other.
class Lines {
 public:
  /// Begins at the offset `from` of the text, which must outlive this object.
  Lines(std::string_view text, std::string_view path, std::size_t from = 0);

  /// Goes to the next line. Throws InputError if there is none: "cut short: expected EXPECTED".
  void advance(std::string_view expected);
  /// The same, but returns false at the end of the text.
  bool advance_if_any();

  std::string_view line() const { return line_; }
  const Row& row() const { return row_; }
  const std::vector<std::string_view>& fields() const { return row_.fields; }
  bool is_blank() const { return row_.fields.empty(); }
  /// Offset of the line in the text.
  std::size_t offset() const { return offset_; }

  [[noreturn]] void reject(std::string_view reason) const { row_.reject(reason); }

 private:
  std::string_view text_;
  std::string_view line_;
  Row row_;
  std::size_t offset_ = 0;
  std::size_t next_ = 0;
};

/// The text as messages quote it: the beginning of a long one.
std::string quotation(std::string_view text);

/// The words of a line that blanks separate. Blanks between quotes separate nothing; quotes are
/// kept.
std::vector<std::string_view> words_of(std::string_view line);

}  // namespace needlework::io
