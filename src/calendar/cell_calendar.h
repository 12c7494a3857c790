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

/// Each needle is in a block, which stands for a cell of the search. The blocks are divided among
/// subdomains, initially one, and each subdomain has a tournament of the needles in its blocks.
/// Blocks that are `shown` hold the keys of the events of their needles, and publish the earliest.
///
/// With `set` alone it is a calendar like the others. Several threads, each with a subdomain, use
/// it in three steps. `put` replaces the event of a needle; no other thread may read or write it at
/// the time, nor the shown blocks that the needle leaves and enters. `publish` makes the earliest
/// key of a shown block visible; all threads may read these at any time. `follow`, called by the
/// thread of a subdomain, updates that tournament.
///
/// `set` is O(log n), and O(1) on average for an event that does not become the next one. `top` is
/// O(number of subdomains). About 90 bytes per needle, 10 more for each further subdomain, and 40
/// for each needle in a shown block.
class CellCalendar {
 public:
  static constexpr const char* name = "cell-calendar";
  static constexpr bool by_block = true;
  using Block = BlockIndex;
  /// Later than any event.
  static constexpr TimeKey no_event = ~TimeKey{8};

  /// Makes this number of blocks. All needles are in the first until they are set.
  CellCalendar(std::size_t n, const Clock& clock, std::size_t blocks)
      : events_(n, clock), places_(n) {
    for (Needle i{0}; i < n; ++i) places_[i].key = events_.key(i);
    divide(std::vector<std::uint32_t>(blocks, 0), 1, std::vector<std::uint8_t>(blocks, false));
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

  void set(const Event& event, Block block) {
    const std::uint32_t before = subdomain_of(block_of(event.owner)), now = subdomain_of(block);
    changed_.clear();
    put(event, block, changed_);
    for (const Block b : changed_) publish(b);
    const auto in_order = [&](std::uint32_t a, std::uint32_t b) {
      return events_.before(Needle(a), Needle(b));
    };
    if (before != now) follow(event.owner, before, no_event, in_order);
    follow(event.owner, now, key_of(event.owner), in_order);
  }
  /// Prefetches what set() accesses for an event of needle i, now in `block`.
  void prefetch(Needle i, Block block) const {
    prefetch(i);
    trees_[subdomain_of(block)].prefetch(i.index);
    if (!is_shown(block)) return;
    needlework::prefetch(&content(block));
    needlework::prefetch(&published_keys_[block]);
  }
  /// Prefetches the event of a needle and its place.
  void prefetch(Needle i) const {
    events_.prefetch(i);
    needlework::prefetch(&places_[i]);
  }

  // Blocks and subdomains.

  Block blocks() const { return static_cast<Block>(assigned_.size()); }
  std::uint32_t subdomains() const { return static_cast<std::uint32_t>(trees_.size()); }
  std::uint32_t subdomain_of(Block b) const { return assigned_[b].subdomain; }
  bool is_shown(Block b) const { return assigned_[b].content != none; }
  /// The block of a needle. Any thread may call this.
  Block block_of(Needle i) const { return places_[i].block.load(std::memory_order_relaxed); }
  /// The key of a needle's event. Any thread may call this.
  TimeKey key_of(Needle i) const { return places_[i].key.load(std::memory_order_relaxed); }
  TimeKey key_of(Time time) const { return events_.key_of(time); }
  /// The number of needles in each block.
  std::vector<std::size_t> needles_in_blocks() const {
    std::vector<std::size_t> count(blocks());
    for (Needle i{0}; i < events_.size(); ++i) ++count[block_of(i)];
    return count;
  }

  /// Assigns block b to subdomain `subdomain_of[b]`, shows it if `shown[b]`, and sets up all
  /// tournaments.
  void divide(const std::vector<std::uint32_t>& subdomain_of, std::uint32_t subdomains,
              const std::vector<std::uint8_t>& shown) {
    assigned_.clear();
    std::uint32_t contents = 0;
    for (std::size_t b = 0; b < subdomain_of.size(); ++b) {
      assigned_.push_back({subdomain_of[b], shown[b] ? contents++ : none});
    }
    contents_.clear();
    contents_.resize(contents);
    published_keys_ = std::vector<PublishedKey>(blocks());
    for (Needle i{0}; i < events_.size(); ++i) {
      if (is_shown(block_of(i))) insert(i, block_of(i), key_of(i));
    }
    for (Block b = 0; b < blocks(); ++b) {
      if (is_shown(b)) find_next(b);
    }
    trees_.clear();
    for (std::uint32_t z = 0; z < subdomains; ++z) trees_.emplace_back(events_.size(), no_event);
    order_again();
  }
  /// Publishes all keys and sets up all tournaments again, whatever steps are missing, with events
  /// of equal keys in the full order.
  void order_again() {
    for (Block b = 0; b < blocks(); ++b) {
      if (is_shown(b)) publish(b);
    }
    for (std::uint32_t z = 0; z < subdomains(); ++z) {
      trees_[z].play_all(
          [&](std::uint32_t i) {
            return subdomain_of(block_of(Needle(i))) == z ? key_of(Needle(i)) : no_event;
          },
          no_event,
          [&](std::uint32_t a, std::uint32_t b) { return events_.before(Needle(a), Needle(b)); });
    }
  }

  /// Replaces the event of event.owner, which is now in `block`, and appends the shown blocks whose
  /// earliest key may have changed to `changed`.
  void put(const Event& event, Block block, std::vector<Block>& changed) {
    const Needle i = event.owner;
    const TimeKey key = events_.put(event);
    const Block old = block_of(i);
    const std::uint32_t old_slot = places_[i].slot;
    // Before key and block are stored, as memory may run out here.
    if (old != block && is_shown(block)) insert(i, block, key);
    places_[i].key.store(key, std::memory_order_relaxed);
    places_[i].block.store(block, std::memory_order_relaxed);
    bool was_first = false;
    if (is_shown(old)) {
      was_first = content(old).key(old_slot) == content(old).first_key;
      if (old == block) {
        content(old).key(old_slot) = key;
      } else {
        remove(old, old_slot);
      }
      if (was_first) {
        find_next(old);
        changed.push_back(old);
      }
      if (old == block && was_first) return;
    }
    if (!is_shown(block) || key >= first_key(block)) return;
    content(block).first_key = key;
    changed.push_back(block);
  }
  /// The earliest key of a shown block as last published; `no_event` for other blocks. Any thread
  /// may call this.
  TimeKey published_key(Block b) const {
    return published_keys_[b].load(std::memory_order_acquire);
  }
  /// The same, published or not.
  TimeKey first_key(Block b) const { return content(b).first_key; }
  void publish(Block b) { published_keys_[b].store(first_key(b), std::memory_order_release); }

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

  // Any thread may read the key and the block; they may be out of date.
  struct Place {
    std::atomic<TimeKey> key{no_event};
    std::atomic<Block> block{0};
    std::uint32_t slot = 0;  ///< in a shown block

    Place() = default;
    Place(Place&& other) noexcept
        : key(other.key.load()), block(other.block.load()), slot(other.slot) {}
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
  // Of a block. Side by side, as an event reads both.
  struct Assignment {
    std::uint32_t subdomain;
    std::uint32_t content;  ///< index, or none
  };
  struct PublishedKey : std::atomic<TimeKey> {
    PublishedKey() : std::atomic<TimeKey>(no_event) {}
    PublishedKey(PublishedKey&& other) noexcept : std::atomic<TimeKey>(other.load()) {}
  };

  Content& content(Block b) { return contents_[assigned_[b].content]; }
  const Content& content(Block b) const { return contents_[assigned_[b].content]; }

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
  void insert(Needle i, Block b, TimeKey key) {
    Content& of = content(b);
    const std::size_t slot = of.needles.size();
    if (slot == of.keys.size() * KeyLine::width) of.keys.emplace_back().fill(no_event);
    of.needles.push_back(i);
    of.key(slot) = key;
    places_[i].slot = static_cast<std::uint32_t>(slot);
  }
  void remove(Block b, std::uint32_t slot) {
    Content& of = content(b);
    const std::size_t last = of.needles.size() - 1;
    of.key(slot) = of.key(last);
    of.key(last) = no_event;
    if (slot != last) {
      of.needles[slot] = of.needles[last];
      places_[of.needles[slot]].slot = slot;
    }
    of.needles.pop_back();
  }
  void find_next(Block b) {
    Content& of = content(b);
    of.first_key = no_event;
    for (const auto& line : of.keys) {
      of.first_key = std::min(of.first_key, LeastKeys(line).key);
    }
  }

  EventTable events_;
  LargeArray<Place> places_;
  std::vector<Assignment> assigned_;
  std::vector<Content> contents_;  ///< of the blocks that are shown
  std::vector<PublishedKey> published_keys_;
  std::vector<WinnerTree> trees_;  ///< one for each subdomain
  std::vector<Block> changed_;
};

}  // namespace needlework
