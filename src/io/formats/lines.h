// Walks through the lines of a text, in memory or in a file, and the fields of a line.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "src/io/formats/input_text.h"

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

/// Where a line begins.
struct PlaceInText {
  std::size_t offset = 0;
  std::size_t lines = 0;  ///< before it
};

/// The lines of a text, one after the other, without a byte order mark before the first and a
/// carriage return at the end.
class Lines {
 public:
  /// The text and the path must outlive this object.
  Lines(std::string_view text, std::string_view path) : rest_(text) { row_.path = path; }
  /// Reads the file as it goes, of which a block is in memory at a time. The line and its fields
  /// are valid until the next one. Throws InputError for a line longer than a block, 1 MiB.
  Lines(InputText& file, std::string_view path, PlaceInText from = {});

  /// Goes to the next line. Throws InputError if there is none: "cut short: expected EXPECTED".
  void advance(std::string_view expected);
  /// What to add to that error.
  void set_advice(std::string advice) { advice_ = std::move(advice); }
  /// Throws the same if this is the last line, has no end, and has fewer fields than these.
  void require_whole(std::size_t fields, std::string_view expected) const {
    require(has_end_ || row_.fields.size() >= fields, expected);
  }
  /// The same, but returns false at the end of the text.
  bool advance_if_any();
  /// Goes to the next line that is not blank; false if there is none.
  bool advance_to_text();
  /// The same two without the fields, which are those of no line then.
  void pass(std::string_view expected);
  bool pass_if_any();

  std::string_view line() const { return line_; }
  const Row& row() const { return row_; }
  const std::vector<std::string_view>& fields() const { return row_.fields; }
  bool is_blank() const { return row_.fields.empty(); }
  /// Where the line begins, and where the next one does.
  PlaceInText place() const { return {offset_, row_.number - 1}; }
  PlaceInText next_place() const { return {next_, row_.number}; }

  [[noreturn]] void reject(std::string_view reason) const { row_.reject(reason); }

 private:
  bool read_block();
  void require(bool found, std::string_view expected) const;

  InputText* file_ = nullptr;  ///< null: the text is in memory
  std::string block_;          ///< the part of the file that rest_ refers to
  std::string_view rest_;      ///< of the text, or of the block, after the line
  std::string_view line_;
  Row row_;
  std::size_t offset_ = 0;
  std::size_t next_ = 0;
  bool has_end_ = true;  ///< whether the line ends with a line feed
  std::string advice_;
};

/// Where a frame is in a file.
struct PartOfFile {
  PlaceInText begin;
  std::size_t end = 0;     ///< offset
  std::size_t number = 0;  ///< of the frame, from 0

  std::size_t bytes() const { return end - begin.offset; }
};

/// Where frames are read: what to do where this one is cut short, see Lines::set_advice().
std::string advice_where_cut_short(std::size_t frame);
/// Throws InputError for a frame that a file of so many frames has not.
[[noreturn]] void refuse_frame(std::string_view path, std::size_t frame, std::size_t frames);

/// The text as messages quote it: the beginning of a long one.
std::string quotation(std::string_view text);

/// The words of a line that blanks separate. Blanks between quotes separate nothing; quotes are
/// kept.
std::vector<std::string_view> words_of(std::string_view line);

}  // namespace needlework::io
