// A calendar by position: the needles in one part of the box compete in a tournament of their own.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <boost/container/small_vector.hpp>
#include <cstdint>
#include <vector>

#include "src/calendar/calendar.h"
#include "src/calendar/event_table.h"
#include "src/calendar/winner_tree.h"
#include "src/memory/large_array.h"
#include "src/memory/prefetch.h"

namespace needlework {

/// Each needle is in a cell of the search. The cells are divided among subdomains, initially one,
/// and each subdomain has a tournament of the needles in its cells. Cells that are `shown` hold the
/// keys of the events of their needles, and publish the earliest.
///
/// With `set` alone it is a calendar like the others. Several threads, each with a subdomain, use
/// it in three steps. `put` replaces the event of a needle; no other thread may read or write it at
/// the time, nor the shown cells that the needle leaves and enters. `publish` makes the earliest
/// key of a shown cell visible; all threads may read these at any time. `follow`, called by the
/// thread of a subdomain, updates that tournament.
///
/// `set` is O(log n), and O(1) on average for an event that does not become the next one. `top` is
/// O(number of subdomains). About 90 bytes per needle, 10 more for each further subdomain, and 40
/// for each needle in a shown cell.
class CellCalendar {
 public:
  static constexpr const char* name = "cell-calendar";
  static constexpr bool by_cell = true;
  /// Later than any event.
  static constexpr TimeKey no_event = ~TimeKey{8};

  /// Makes this number of cells. All needles are in the first until they are set.
  CellCalendar(std::size_t n, const Clock& clock, std::size_t cells)
      : events_(n, clock), places_(n) {
    for (Needle i{0}; i < n; ++i) places_[i].key = events_.key(i);
    divide(std::vector<std::uint32_t>(cells, 0), 1, std::vector<std::uint8_t>(cells, false));
  }

  bool empty() const { return events_.size() == 0; }
  const Event& of(Needle i) const { return events_[i]; }
  const Event& top() const { return events_[winner(first_subdomain())]; }
  Needle likely_next() const { return likely_next_in(first_subdomain()); }
  Needle likely_next_in(std::uint32_t z) const {
    const Needle i(trees_[z].second());
    events_.prefetch(i);
    return i;
  }

  void set(const Event& event, CellIndex cell) {
    const std::uint32_t before = subdomain_of(cell_of(event.owner)), now = subdomain_of(cell);
    changed_.clear();
    put(event, cell, changed_);
    for (const CellIndex c : changed_) publish(c);
    const auto in_order = [&](std::uint32_t a, std::uint32_t b) {
      return events_.before(Needle(a), Needle(b));
    };
    if (before != now) follow(event.owner, before, no_event, in_order);
    follow(event.owner, now, key_of(event.owner), in_order);
  }
  /// Prefetches what set() accesses for an event of needle i, now in `cell`.
  void prefetch(Needle i, CellIndex cell) const {
    prefetch(i);
    trees_[subdomain_of(cell)].prefetch(i.index);
    if (!is_shown(cell)) return;
    needlework::prefetch(&content(cell));
    needlework::prefetch(&published_keys_[cell]);
  }
  /// Prefetches the event of a needle and its place.
  void prefetch(Needle i) const {
    events_.prefetch(i);
    needlework::prefetch(&places_[i]);
  }

  // Cells and subdomains.

  CellIndex cells() const { return static_cast<CellIndex>(assigned_.size()); }
  std::uint32_t subdomains() const { return static_cast<std::uint32_t>(trees_.size()); }
  std::uint32_t subdomain_of(CellIndex c) const { return assigned_[c].subdomain; }
  bool is_shown(CellIndex c) const { return assigned_[c].content != none; }
  /// The cell of a needle. Any thread may call this.
  CellIndex cell_of(Needle i) const { return places_[i].cell.load(std::memory_order_relaxed); }
  /// The key of a needle's event. Any thread may call this.
  TimeKey key_of(Needle i) const { return places_[i].key.load(std::memory_order_relaxed); }
  TimeKey key_of(Time time) const { return events_.key_of(time); }
  /// The number of needles in each cell.
  std::vector<std::size_t> needles_in_cells() const {
    std::vector<std::size_t> count(cells());
    for (Needle i{0}; i < events_.size(); ++i) ++count[cell_of(i)];
    return count;
  }

  /// Assigns cell c to subdomain `subdomain_of[c]`, shows it if `shown[c]`, and sets up all
  /// tournaments.
  void divide(const std::vector<std::uint32_t>& subdomain_of, std::uint32_t subdomains,
              const std::vector<std::uint8_t>& shown) {
    assigned_.clear();
    std::uint32_t contents = 0;
    for (std::size_t c = 0; c < subdomain_of.size(); ++c) {
      assigned_.push_back({subdomain_of[c], shown[c] ? contents++ : none});
    }
    contents_.clear();
    contents_.resize(contents);
    published_keys_ = std::vector<PublishedKey>(cells());
    for (Needle i{0}; i < events_.size(); ++i) {
      if (is_shown(cell_of(i))) insert(i, cell_of(i), key_of(i));
    }
    for (CellIndex c = 0; c < cells(); ++c) {
      if (is_shown(c)) find_next(c);
    }
    trees_.clear();
    for (std::uint32_t z = 0; z < subdomains; ++z) trees_.emplace_back(events_.size(), no_event);
    order_again();
  }
  /// Publishes all keys and sets up all tournaments again, whatever steps are missing, with events
  /// of equal keys in the full order.
  void order_again() {
    for (CellIndex c = 0; c < cells(); ++c) {
      if (is_shown(c)) publish(c);
    }
    for (std::uint32_t z = 0; z < subdomains(); ++z) {
      trees_[z].play_all(
          [&](std::uint32_t i) {
            return subdomain_of(cell_of(Needle(i))) == z ? key_of(Needle(i)) : no_event;
          },
          no_event,
          [&](std::uint32_t a, std::uint32_t b) { return events_.before(Needle(a), Needle(b)); });
    }
  }

  /// Replaces the event of event.owner, which is now in `cell`, and appends the shown cells whose
  /// earliest key may have changed to `changed`.
  void put(const Event& event, CellIndex cell, std::vector<CellIndex>& changed) {
    const Needle i = event.owner;
    const TimeKey key = events_.put(event);
    const CellIndex old = cell_of(i);
    const std::uint32_t old_slot = places_[i].slot;
    // Before key and cell are stored, as memory may run out here.
    if (old != cell && is_shown(cell)) insert(i, cell, key);
    places_[i].key.store(key, std::memory_order_relaxed);
    places_[i].cell.store(cell, std::memory_order_relaxed);
    bool was_first = false;
    if (is_shown(old)) {
      was_first = content(old).key(old_slot) == content(old).first_key;
      if (old == cell) {
        content(old).key(old_slot) = key;
      } else {
        remove(old, old_slot);
      }
      if (was_first) {
        find_next(old);
        changed.push_back(old);
      }
      if (old == cell && was_first) return;
    }
    if (!is_shown(cell) || key >= first_key(cell)) return;
    content(cell).first_key = key;
    changed.push_back(cell);
  }
  /// The earliest key of a shown cell as last published; `no_event` for other cells. Any thread
  /// may call this.
  TimeKey published_key(CellIndex c) const {
    return published_keys_[c].load(std::memory_order_acquire);
  }
  /// The same, published or not.
  TimeKey first_key(CellIndex c) const { return content(c).first_key; }
  void publish(CellIndex c) { published_keys_[c].store(first_key(c), std::memory_order_release); }

  /// The needle of a subdomain whose event is next, according to the keys that the tournament has
  /// been given, and this key.
  Needle winner(std::uint32_t z) const { return Needle(trees_[z].winner()); }
  TimeKey winning_key(std::uint32_t z) const { return trees_[z].winning_key(); }
  /// Gives a needle of a tournament a new key. Reads no events: of equal keys that of the lower
  /// needle wins.
  void follow(Needle i, std::uint32_t z, TimeKey key) {
    follow(i, z, key, [](std::uint32_t a, std::uint32_t b) { return a < b; });
  }

 private:
  static constexpr std::uint32_t none = ~std::uint32_t{0};

  // Any thread may read the key and the cell; they may be out of date.
  struct Place {
    std::atomic<TimeKey> key{no_event};
    std::atomic<CellIndex> cell{0};
    std::uint32_t slot = 0;  ///< in a shown cell

    Place() = default;
    Place(Place&& other) noexcept
        : key(other.key.load()), cell(other.cell.load()), slot(other.slot) {}
  };
  // Of all that it holds, an event accesses the same few lines of memory.
  struct alignas(64) Content {
    using Keys = std::array<TimeKey, KeyLine::width>;

    TimeKey first_key = no_event;
    // By slot; keys of unused slots are `no_event`.
    boost::container::small_vector<Keys, 2> keys;
    boost::container::small_vector<Needle, 2 * KeyLine::width> needles;

    TimeKey& key(std::size_t slot) { return keys[slot / KeyLine::width][slot % KeyLine::width]; }
  };
  // Of a cell. Side by side, as an event reads both.
  struct Assignment {
    std::uint32_t subdomain;
    std::uint32_t content;  ///< index, or none
  };
  struct PublishedKey : std::atomic<TimeKey> {
    PublishedKey() : std::atomic<TimeKey>(no_event) {}
    PublishedKey(PublishedKey&& other) noexcept : std::atomic<TimeKey>(other.load()) {}
  };

  Content& content(CellIndex c) { return contents_[assigned_[c].content]; }
  const Content& content(CellIndex c) const { return contents_[assigned_[c].content]; }

  /// The subdomain with the first of all events.
  std::uint32_t first_subdomain() const {
    std::uint32_t first = 0;
    for (std::uint32_t z = 1; z < subdomains(); ++z) {
      const TimeKey key = winning_key(z), least = winning_key(first);
      if (key < least || (key == least && events_.before(winner(z), winner(first)))) first = z;
    }
    return first;
  }

  template <class Before>
  void follow(Needle i, std::uint32_t z, TimeKey key, const Before& before) {
    trees_[z].update(i.index, key, before,
                     [&](std::uint32_t near) { events_.prefetch(Needle(near)); });
  }
  void insert(Needle i, CellIndex c, TimeKey key) {
    Content& of = content(c);
    const std::size_t slot = of.needles.size();
    if (slot == of.keys.size() * KeyLine::width) of.keys.emplace_back().fill(no_event);
    of.needles.push_back(i);
    of.key(slot) = key;
    places_[i].slot = static_cast<std::uint32_t>(slot);
  }
  void remove(CellIndex c, std::uint32_t slot) {
    Content& of = content(c);
    const std::size_t last = of.needles.size() - 1;
    of.key(slot) = of.key(last);
    of.key(last) = no_event;
    if (slot != last) {
      of.needles[slot] = of.needles[last];
      places_[of.needles[slot]].slot = slot;
    }
    of.needles.pop_back();
  }
  void find_next(CellIndex c) {
    Content& of = content(c);
    of.first_key = no_event;
    for (const auto& line : of.keys) {
      of.first_key = std::min(of.first_key, LeastKeys(line).key);
    }
  }

  EventTable events_;
  LargeArray<Place> places_;
  std::vector<Assignment> assigned_;
  std::vector<Content> contents_;  ///< of the cells that are shown
  std::vector<PublishedKey> published_keys_;
  std::vector<WinnerTree> trees_;  ///< one for each subdomain
  std::vector<CellIndex> changed_;
};

}  // namespace needlework
