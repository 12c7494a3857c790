// Values to bytes and back, both by the same code.
//
// A function that passes its values to an archive says in one place what is saved, and in which
// order: an archive that writes appends the values to its bytes, one that reads replaces the values
// by those of its bytes. Types of other headers take part by a function `transfer(Archive&, T&)`
// beside them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace needlework {

/// Bytes are not checked against damage here; files that hold them have a checksum.
class Archive {
 public:
  /// Appends to `bytes`, which must outlive the archive.
  static Archive to(std::string& bytes) { return Archive(&bytes, {}); }
  /// Reads `bytes`, which must outlive the archive. Every call throws InputError when they are not
  /// those of the values asked for, as far as that can be seen.
  static Archive from(std::string_view bytes) { return Archive(nullptr, bytes); }

  bool reads() const { return out_ == nullptr; }

  /// Writes the values, or replaces them.
  template <class... T>
  void operator()(T&... values) {
    (pass(values), ...);
  }
  /// To be called after the last value has been read.
  void require_end() const {
    if (reads() && !in_.empty()) throw_damaged();
  }
  /// Throws InputError if what has been read cannot have been written.
  void require(bool condition) const {
    if (reads() && !condition) throw_damaged();
  }
  [[noreturn]] static void throw_damaged();

 private:
  Archive(std::string* out, std::string_view in) : out_(out), in_(in) {}

  void pass_bytes(void* values, std::size_t size);

  // Numbers, and arrays of them, whose bytes are those of their elements.
  template <class T>
  struct Plain : std::bool_constant<std::is_arithmetic_v<T> && !std::is_same_v<T, bool>> {};
  template <class T, std::size_t size>
  struct Plain<std::array<T, size>> : Plain<T> {};
  template <class T>
  static constexpr bool is_plain = Plain<T>::value;

  template <class T>
  void pass(T& value) {
    if constexpr (is_plain<T>) {
      pass_bytes(&value, sizeof value);
    } else if constexpr (std::is_same_v<T, bool>) {
      std::uint8_t byte = value;
      pass(byte);
      if (byte > 1) throw_damaged();
      value = byte == 1;
    } else {
      transfer(*this, value);
    }
  }
  template <class T, std::size_t size>
  void pass(std::array<T, size>& values) {
    for (T& value : values) pass(value);
  }
  void pass(std::string& text) {
    text.resize(count_of(text.size()));
    pass_bytes(text.data(), text.size());
  }
  template <class T, class Allocator>
  void pass(std::vector<T, Allocator>& values) {
    const std::size_t count = count_of(values.size());
    if constexpr (is_plain<T>) {
      if (reads() && count > in_.size() / sizeof(T)) throw_damaged();
      values.resize(count);
      pass_bytes(values.data(), count * sizeof(T));
    } else {
      // One by one, so that a damaged count takes no more memory than the values that are there.
      if (reads()) values.clear();
      for (std::size_t n = 0; n < count; ++n) pass(reads() ? values.emplace_back() : values[n]);
    }
  }
  template <class T>
  void pass(std::optional<T>& value) {
    bool has = value.has_value();
    pass(has);
    if (!has) {
      value.reset();
      return;
    }
    if (!value)
      value = T{};  // clang 14 cannot emplace() what a class nested in another one contains
    pass(*value);
  }
  template <class Key, class Value, class Less>
  void pass(std::map<Key, Value, Less>& values) {
    std::vector<std::pair<Key, Value>> entries(values.begin(), values.end());
    pass(entries);
    if (reads()) values = {entries.begin(), entries.end()};
  }
  template <class First, class Second>
  void pass(std::pair<First, Second>& values) {
    pass(values.first);
    pass(values.second);
  }

  // The number of elements. Each has a byte at least.
  std::size_t count_of(std::size_t present) {
    std::uint64_t count = present;
    pass(count);
    if (reads() && count > in_.size()) throw_damaged();
    return count;
  }

  std::string* out_;
  std::string_view in_;
};

}  // namespace needlework
