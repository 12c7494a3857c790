// Columns: what an effect keeps for each needle beside its record.
//
// An effect adds its column to Gas::columns once, and the engine does the rest: the column follows
// its needles when the storage is sorted, is put back when a phase is rolled back, and is saved in
// checkpoints. A gas without columns pays nothing for them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "src/archive/archive.h"
#include "src/memory/large_array.h"
#include "src/memory/prefetch.h"
#include "src/physics/permutation.h"
#include "src/physics/transfer.h"

namespace needlework {

/// One column, of values of any type. Several threads may use the values of different needles.
class AnyColumn {
 public:
  explicit AnyColumn(std::string name) : name_(std::move(name)) {}
  virtual ~AnyColumn() = default;
  AnyColumn(const AnyColumn&) = delete;
  AnyColumn& operator=(const AnyColumn&) = delete;

  const std::string& name() const { return name_; }
  virtual void resize(std::size_t needles) = 0;
  virtual void permute(const std::vector<Needle>& order) = 0;
  /// Size of a value in memory. [bytes]
  virtual std::size_t value_size() const = 0;
  /// Copies the value of needle i to or from memory of that size.
  virtual void copy_out(Needle i, std::byte* to) const = 0;
  virtual void copy_in(Needle i, const std::byte* from) = 0;
  /// Saves or restores the value of needle i.
  virtual void transfer(Archive& archive, Needle i) = 0;
  virtual void prefetch(Needle i) const = 0;

 private:
  std::string name_;
};

/// A column of values of type T, which is trivially copyable and known to archives.
template <class T>
class Column final : public AnyColumn {
  static_assert(std::is_trivially_copyable_v<T> && !std::is_same_v<T, bool>);

 public:
  /// All needles begin with the value `initial`.
  Column(std::string name, const T& initial) : AnyColumn(std::move(name)), initial_(initial) {}

  T& operator[](Needle i) { return values_[i]; }
  const T& operator[](Needle i) const { return values_[i]; }
  const LargeArray<T>& values() const { return values_; }

  void resize(std::size_t needles) override { values_.resize(needles, initial_); }
  void permute(const std::vector<Needle>& order) override { needlework::permute(values_, order); }
  std::size_t value_size() const override { return sizeof(T); }
  void copy_out(Needle i, std::byte* to) const override { std::memcpy(to, &values_[i], sizeof(T)); }
  void copy_in(Needle i, const std::byte* from) override {
    std::memcpy(&values_[i], from, sizeof(T));
  }
  void transfer(Archive& archive, Needle i) override { archive(values_[i]); }
  void prefetch(Needle i) const override { needlework::prefetch(&values_[i]); }

 private:
  T initial_;
  LargeArray<T> values_;
};

/// The columns of a gas.
class Columns {
 public:
  /// Adds a column, which has a value for each of the needles that resize() has been told of.
  /// The reference is valid as long as the columns exist, also after they have been moved.
  template <class T>
  Column<T>& add(std::string name, const T& initial) {
    auto column = std::make_unique<Column<T>>(std::move(name), initial);
    Column<T>& out = *column;
    out.resize(needles_);
    bytes_per_needle_ += out.value_size();
    all_.push_back(std::move(column));
    return out;
  }

  bool empty() const { return all_.empty(); }
  void resize(std::size_t needles) {
    needles_ = needles;
    for (const auto& column : all_) column->resize(needles);
  }
  void permute(const std::vector<Needle>& order) {
    for (const auto& column : all_) column->permute(order);
  }
  /// Appends all values of needle i to `bytes`, bytes_per_needle() in all.
  void append(Needle i, std::vector<std::byte>& bytes) const {
    std::size_t end = bytes.size();
    bytes.resize(end + bytes_per_needle_);
    for (const auto& column : all_) {
      column->copy_out(i, &bytes[end]);
      end += column->value_size();
    }
  }
  /// Replaces all values of needle i by those that append() has put there.
  void put_back(Needle i, const std::byte* from) {
    for (const auto& column : all_) {
      column->copy_in(i, from);
      from += column->value_size();
    }
  }
  std::size_t bytes_per_needle() const { return bytes_per_needle_; }
  /// From now on counts the events at which the values of a needle change while its record stays,
  /// in a column of its own. Rollback needs it to tell which values are older.
  void keep_changes() {
    if (!changes_) changes_ = &add<std::uint32_t>("changes", 0);
  }
  void count_change(Needle i) {
    if (changes_) ++(*changes_)[i];
  }
  std::uint32_t changes(Needle i) const { return changes_ ? (*changes_)[i] : 0; }
  void transfer(Archive& archive, Needle i) {
    for (const auto& column : all_) column->transfer(archive, i);
  }
  void prefetch(Needle i) const {
    for (const auto& column : all_) column->prefetch(i);
  }

 private:
  std::vector<std::unique_ptr<AnyColumn>> all_;
  Column<std::uint32_t>* changes_ = nullptr;
  std::size_t needles_ = 0, bytes_per_needle_ = 0;
};

}  // namespace needlework
