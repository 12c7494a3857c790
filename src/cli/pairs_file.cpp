#include "src/cli/pairs_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>
#include <streambuf>
#include <system_error>

#include "needlework/error.h"
#include "src/io/decimal.h"
#include "src/scene_text/text_input.h"

namespace needlework {
namespace {

constexpr int column_count = 28;
constexpr int sized_count = 32;  // with lengths and diameters

std::string column_name(int column) {
  constexpr std::array<std::string_view, 3> leading = {"id", "family", "horizon"};
  constexpr std::array<std::string_view, 4> sizes = {"La", "Lb", "Da", "Db"};
  if (column < 3) return std::string(leading[column]);
  if (column == column_count - 1) return "skip";
  if (column >= column_count) return std::string(sizes[column - column_count]);
  const int number = column - 3;
  const char quantity = "ruvw"[number % 12 / 3];
  return fmt::format("{}{}{}", quantity, 1 + number / 12, "xyz"[number % 3]);
}

std::string_view trimmed(std::string_view text) {
  const auto begin = text.find_first_not_of(" \t\r");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> fields;
  for (;;) {
    const auto comma = line.find(',');
    fields.push_back(trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) return fields;
    line.remove_prefix(comma + 1);
  }
}

/// One line and where it stands, for messages.
struct Line {
  std::string_view file;
  std::size_t number;
  std::vector<std::string_view> fields;

  [[noreturn]] void reject(std::string_view column, std::string_view value,
                           std::string_view expected) const {
    throw InputError(fmt::format("{}: line {}: column {} = {}: expected {}", file, number, column,
                                 value, expected));
  }

  double number_at(int column) const {
    const std::string_view text = fields[column];
    double value = 0;
    const std::errc error = io::read_decimal(text, value);
    if (error == std::errc::result_out_of_range) {
      reject(column_name(column), text, "a number that a double can hold");
    }
    if (error != std::errc()) reject(column_name(column), text, "a finite number");
    return value;
  }
};

FreeNeedle read_needle(const Line& line, int column) {
  FreeNeedle needle;
  for (auto* vector :
       {&needle.position, &needle.orientation, &needle.velocity, &needle.angular_velocity}) {
    for (double& value : *vector) value = line.number_at(column++);
  }
  return needle;
}

void check_director(const Line& line, const FreeNeedle& needle, std::string_view name) {
  const auto& u = needle.orientation;
  if (u[0] == 0 && u[1] == 0 && u[2] == 0) {
    line.reject(name, "(0, 0, 0)", "a director that is not 0");
  }
}

PairLine read_pair(const Line& line) {
  const int found = static_cast<int>(line.fields.size());
  const bool sized = found > column_count;
  const auto expected = [&] {
    return fmt::format("{} columns, or {} with La, Lb, Da, Db, found {}", column_count, sized_count,
                       found);
  };
  if (found < column_count || (sized && found < sized_count))
    line.reject(column_name(found), "(missing)", expected());
  if (found > sized_count)
    line.reject(fmt::format("{}", sized_count + 1), line.fields[sized_count], expected());
  PairLine pair;
  pair.line = line.number;
  pair.id = line.fields[0];
  if (pair.id.empty()) line.reject("id", "(empty)", "a name or number");
  pair.horizon = line.number_at(2);
  if (pair.horizon < 0) line.reject("horizon", line.fields[2], "a time, 0 or later");
  pair.first = read_needle(line, 3);
  pair.second = read_needle(line, 15);
  check_director(line, pair.first, "u1");
  check_director(line, pair.second, "u2");
  const std::string_view skip = line.fields[column_count - 1];
  if (skip != "0" && skip != "1") line.reject("skip", skip, "0 or 1");
  pair.just_collided = skip == "1";
  if (sized) {
    int column = column_count;
    for (double* size :
         {&pair.first.length, &pair.second.length, &pair.first.diameter, &pair.second.diameter}) {
      *size = line.number_at(column);
      if (*size < 0) line.reject(column_name(column), line.fields[column], "a number, 0 or more");
      ++column;
    }
  }
  return pair;
}

bool is_number(std::string_view text) {
  double value = 0;
  return std::from_chars(text.data(), text.data() + text.size(), value).ec == std::errc();
}

// A header names its columns; one that has them in another order is not what it seems.
void check_header(const Line& line) {
  for (int found = 0; found < static_cast<int>(line.fields.size()); ++found) {
    for (int column = 0; column < sized_count; ++column) {
      if (column == found || line.fields[found] != column_name(column)) continue;
      const std::string expected = found < sized_count ? column_name(found) : "no such column";
      line.reject(fmt::format("{}", found + 1), line.fields[found], expected);
    }
  }
}

// Words alone, but not those of a header.
bool looks_like_a_header(const Line& line) {
  return line.fields.size() > 2 && std::none_of(line.fields.begin(), line.fields.end(), is_number);
}

// A pair takes some 600 bytes. What has no ends of lines is not a list, but could take all memory.
constexpr std::size_t longest_line = 1 << 16;

// The next line without its end; false after the last.
bool read_line(std::istream& in, std::string& line, std::string_view name, std::size_t number) {
  line.clear();
  for (int c = in.get(); c != std::istream::traits_type::eof(); c = in.get()) {
    if (c == '\n') return true;
    if (line.size() == longest_line) {
      throw InputError(
          fmt::format("{}: line {}: more than {} bytes: expected the 28 or 32 columns "
                      "of a pair",
                      name, number, longest_line));
    }
    line += static_cast<char>(c);
  }
  return !line.empty();
}

// Reads a file as a stream.
class FileBuffer : public std::streambuf {
 public:
  explicit FileBuffer(const std::string& path) : file_(open_text(path)) {}

 protected:
  int_type underflow() override {
    const std::size_t count = std::fread(bytes_.data(), 1, bytes_.size(), file_.get());
    // An exception sets the stream's badbit.
    if (std::ferror(file_.get())) throw IoError(std::generic_category().message(errno));
    setg(bytes_.data(), bytes_.data(), bytes_.data() + count);
    return count == 0 ? traits_type::eof() : traits_type::to_int_type(bytes_[0]);
  }

 private:
  std::unique_ptr<std::FILE, CloseFile> file_;
  std::array<char, 1 << 16> bytes_{};
};

}  // namespace

std::vector<PairLine> read_pairs(std::istream& in, std::string_view name) {
  std::vector<PairLine> pairs;
  bool header_allowed = true;
  std::string text;
  for (std::size_t number = 1; read_line(in, text, name, number); ++number) {
    std::string_view line = trimmed(text);
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    if (number == 1 && line.starts_with(byte_order_mark)) line.remove_prefix(3);
    if (line.empty() || line.front() == '#') continue;
    const Line fields{name, number, split(line)};
    const bool header =
        fields.fields.size() > 1 && fields.fields[0] == "id" && fields.fields[1] == "family";
    if (header && header_allowed) {
      check_header(fields);
    } else if (header_allowed && looks_like_a_header(fields)) {
      fields.reject("id", fields.fields[0],
                    "28 columns of numbers, or the header id,family,horizon, then x,y,z of "
                    "r1,u1,v1,w1,r2,u2,v2,w2, then skip; and La,Lb,Da,Db behind it, if at all");
    } else {
      pairs.push_back(read_pair(fields));
    }
    header_allowed = false;
  }
  if (in.bad()) throw IoError(fmt::format("{}: reading failed", name));
  return pairs;
}

std::vector<PairLine> read_pairs(const std::string& path) {
  if (path == "-") return read_pairs(std::cin, "stdin");
  FileBuffer buffer(path);
  std::istream file(&buffer);
  return read_pairs(file, path);
}

}  // namespace needlework
