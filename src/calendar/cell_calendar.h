// A calendar by position: the needles of one cell of space share a block, and the next events of
// all blocks compete in a tournament, or in several, one for each thread.
#pragma once

#include <array>
#include <atomic>
#include <bit>
#include <boost/container/small_vector.hpp>
#include <cstdint>
#include <utility>
#include <vector>

#include "src/calendar/calendar.h"
#include "src/calendar/event_table.h"
#include "src/calendar/winner_tree.h"
#include "src/memory/large_array.h"
#include "src/memory/prefetch.h"

namespace needlework {

/// A block holds the keys of the events of its needles, and knows its next event. Blocks are
/// divided among subdomains, initially one, and each subdomain has a tournament of its own blocks.
///
/// With `set` alone it is a calendar like the others. Several threads, each with a subdomain, use
/// it in three steps. `put` changes blocks that no other thread reads or writes at the time.
/// `publish` makes the keys of their next events visible; all threads may read these at any time.
/// `follow`, called by the thread of the subdomain, updates the tournament.
///
/// `set` is O(1) on average for an event that does not become the next one, else O(log n). `top`
/// is O(number of subdomains). About 110 bytes per needle.
class CellCalendar {
 public:
  static constexpr const char* name = "cell-calendar";
  static constexpr bool by_block = true;
  using Block = BlockIndex;
  /// Later than any event.
  static constexpr TimeKey no_event = ~TimeKey{8};

  /// Makes this number of blocks. Needles are distributed over them by index until they are set.
  CellCalendar(std::size_t n, const Clock& clock, std::size_t blocks)
      : events_(n, clock), places_(n), blocks_(blocks), published_keys_(blocks) {
    for (Needle i{0}; i < n; ++i) insert(i, static_cast<Block>(i * blocks / n), events_.key(i));
    for (Block b = 0; b < blocks; ++b) find_next(b);
    divide(std::vector<std::uint32_t>(blocks, 0), 1);
  }

  bool empty() const { return events_.size() == 0; }
  const Event& of(Needle i) const { return events_[i]; }
  const Event& top() const {
    std::uint32_t best = 0;
    for (std::uint32_t z = 1; z < subdomains_.size(); ++z) {
      if (earlier(winner(z), winner(best))) best = z;
    }
    return top_of(winner(best));
  }
  Needle likely_next() const { return likely_next_in(0); }
  Needle likely_next_in(std::uint32_t subdomain) const {
    const Subdomain& of = subdomains_[subdomain];
    if (of.blocks.empty()) return Needle(0);
    const Needle i = blocks_[of.blocks[of.order.second()]].next;
    events_.prefetch(i);
    return i;
  }

  void set(const Event& event, Block block) {
    changed_.clear();
    put(event, block, changed_);
    for (const Block b : changed_) {
      publish(b);
      follow(b);
    }
  }

  // Blocks and subdomains.

  Block blocks() const { return static_cast<Block>(blocks_.size()); }
  Block block_of(Needle i) const { return places_[i].block.load(std::memory_order_relaxed); }
  /// The next event of a block that has one.
  const Event& top_of(Block b) const {
    const Content& content = blocks_[b];
    return events_[content.tied ? first_of_equal(content) : content.next];
  }
  /// The key of a block's next event as last published: none of its events is earlier. Any thread
  /// may call this.
  TimeKey published_key(Block b) const {
    return published_keys_[b].load(std::memory_order_acquire);
  }
  TimeKey key_of(Time time) const { return events_.key_of(time); }
  std::uint32_t subdomain_of(Block b) const { return owners_[b].subdomain; }
  std::size_t needles_in(Block b) const { return blocks_[b].needles.size(); }

  /// Assigns block b to subdomain `subdomain_of[b]`, and sets up all tournaments.
  void divide(const std::vector<std::uint32_t>& subdomain_of, std::uint32_t subdomains) {
    owners_.resize(blocks_.size());
    subdomains_.clear();
    std::vector<std::vector<Block>> parts(subdomains);
    for (Block b = 0; b < blocks(); ++b) {
      owners_[b] = {subdomain_of[b], static_cast<std::uint32_t>(parts[subdomain_of[b]].size())};
      parts[subdomain_of[b]].push_back(b);
    }
    for (auto& part : parts) {
      const std::size_t size = std::max<std::size_t>(part.size(), 1);
      subdomains_.push_back({WinnerTree(size, no_event), std::move(part)});
    }
    for (Block b = 0; b < blocks(); ++b) {
      publish(b);
      follow(b);
    }
  }
  /// Sets up all tournaments again, and sorts events of equal keys by the full order.
  void order_again() {
    for (Block b = 0; b < blocks(); ++b) {
      publish(b);
      follow(b, no_event);
    }
    for (Block b = 0; b < blocks(); ++b) follow(b);
  }

  /// Replaces the event of event.owner, which is now in `block`, and appends the blocks whose next
  /// event may have changed to `changed`.
  void put(const Event& event, Block block, std::vector<Block>& changed) {
    const Needle i = event.owner;
    const TimeKey key = events_.put(event);
    Content& content = blocks_[block];
    const Block old = block_of(i);
    const std::uint32_t slot = places_[i].slot;
    const bool was_next = blocks_[old].may_be_next(slot);
    if (old == block) {
      content.key(slot) = key;
    } else {
      remove(i);
      insert(i, block, key);
    }
    if (was_next) {
      find_next(old);
      changed.push_back(old);
      if (old == block) return;
    }
    if (key > content.next_key) return;
    content.tied = key == content.next_key;
    content.next_key = key;
    content.next = i;
    changed.push_back(block);
  }
  /// Prefetches what put() and publish() access for an event of needle i, now in `block`.
  void prefetch(Needle i, Block block) const {
    events_.prefetch(i);
    prefetch_place(i);
    prefetch_keys(block);
    needlework::prefetch(&published_keys_[block]);
    needlework::prefetch(&owners_[block]);
  }
  void prefetch_place(Needle i) const { needlework::prefetch(&places_[i]); }
  void prefetch_keys(Block b) const { needlework::prefetch(&blocks_[b]); }
  /// The key of a block's next event, published or not.
  TimeKey next_key(Block b) const { return blocks_[b].next_key; }
  void publish(Block b) { published_keys_[b].store(next_key(b), std::memory_order_release); }

  /// The block of a subdomain whose event is next, according to the keys that the tournament has
  /// been given.
  Block winner(std::uint32_t z) const {
    const Subdomain& subdomain = subdomains_[z];
    return subdomain.blocks.empty() ? 0 : subdomain.blocks[subdomain.order.winner()];
  }
  TimeKey winning_key(std::uint32_t z) const {
    return subdomains_[z].order.key(subdomains_[z].order.winner());
  }
  /// Updates the tournament of the block's subdomain. Of equal keys the earlier event wins.
  void follow(Block b) { follow(b, published_key(b)); }
  /// The same without reading events: of equal keys the lower block wins.
  void follow_by_key(Block b, TimeKey key) {
    Subdomain& subdomain = subdomains_[owners_[b].subdomain];
    subdomain.order.update(
        owners_[b].rank, key, [](std::uint32_t x, std::uint32_t y) { return x < y; },
        [](std::uint32_t) {});
  }

 private:
  // Any thread may read this; the value may be out of date.
  struct Next {
    std::atomic<Needle> value{Needle(0)};

    Next() = default;
    Next(Next&& other) noexcept : value(Needle(other)) {}
    Next& operator=(Needle i) {
      value.store(i, std::memory_order_relaxed);
      return *this;
    }
    operator Needle() const { return value.load(std::memory_order_relaxed); }
  };
  // Of all that it holds, an event accesses the same few lines of memory.
  struct alignas(64) Content {
    using Keys = std::array<TimeKey, KeyLine::width>;

    Next next;                    ///< a needle that has the block's next event
    bool tied = false;            ///< whether others may have an event with the same key
    TimeKey next_key = no_event;  ///< of that event
    // By slot; keys of unused slots are `no_event`.
    boost::container::small_vector<Keys, 2> keys;
    boost::container::small_vector<Needle, 2 * KeyLine::width> needles;

    TimeKey& key(std::size_t slot) { return keys[slot / KeyLine::width][slot % KeyLine::width]; }
    TimeKey key(std::size_t slot) const {
      return keys[slot / KeyLine::width][slot % KeyLine::width];
    }
    bool may_be_next(std::uint32_t slot) const { return key(slot) == next_key; }
  };
  struct Place {
    std::atomic<Block> block{0};  ///< any thread may read this; the value may be out of date
    std::uint32_t slot = 0;

    Place() = default;
    Place(Place&& other) noexcept : block(other.block.load()), slot(other.slot) {}
  };
  struct Owner {
    std::uint32_t subdomain, rank;
  };
  struct Subdomain {
    WinnerTree order;
    std::vector<Block> blocks;
  };
  struct PublishedKey : std::atomic<TimeKey> {
    PublishedKey() : std::atomic<TimeKey>(no_event) {}
    PublishedKey(PublishedKey&& other) noexcept : std::atomic<TimeKey>(other.load()) {}
  };

  bool earlier(Block a, Block b) const {
    const TimeKey x = next_key(a), y = next_key(b);
    if (x != y || x == no_event) return x < y;
    return top_of(a) < top_of(b);
  }

  void follow(Block b, TimeKey key) {
    Subdomain& subdomain = subdomains_[owners_[b].subdomain];
    subdomain.order.update(
        owners_[b].rank, key,
        [&](std::uint32_t x, std::uint32_t y) {
          return earlier(subdomain.blocks[x], subdomain.blocks[y]);
        },
        [&](std::uint32_t near) { events_.prefetch(blocks_[subdomain.blocks[near]].next); });
  }

  void insert(Needle i, Block b, TimeKey key) {
    Content& content = blocks_[b];
    Place& place = places_[i];
    place.block.store(b, std::memory_order_relaxed);
    place.slot = static_cast<std::uint32_t>(content.needles.size());
    if (place.slot == content.keys.size() * KeyLine::width) {
      content.keys.emplace_back().fill(no_event);
    }
    content.needles.push_back(i);
    content.key(place.slot) = key;
  }
  void remove(Needle i) {
    Content& content = blocks_[block_of(i)];
    const std::uint32_t slot = places_[i].slot;
    const Needle last = content.needles.back();
    content.needles.pop_back();
    content.key(slot) = content.key(content.needles.size());
    content.key(content.needles.size()) = no_event;
    if (last == i) return;
    content.needles[slot] = last;
    places_[last].slot = slot;
  }
  // Equal keys are common, as both needles of a contact have it. They are told apart only when the
  // event comes to the top, because that reads the events.
  void find_next(Block b) {
    Content& content = blocks_[b];
    TimeKey key = no_event;
    std::size_t slot = 0;
    bool tied = false;
    for (std::size_t line = 0; line < content.keys.size(); ++line) {
      const LeastKeys here(content.keys[line]);
      const bool less = here.key < key;
      tied = less ? !std::has_single_bit(here.places) : tied | (here.key == key);
      slot = less ? line * KeyLine::width + std::countr_zero(here.places) : slot;
      key = std::min(key, here.key);
    }
    content.next_key = key;
    content.tied = tied;
    if (key != no_event) content.next = content.needles[slot];
  }
  [[gnu::noinline]] Needle first_of_equal(const Content& content) const {
    Needle best = content.next;
    for (std::size_t slot = 0; slot < content.needles.size(); ++slot) {
      if (content.key(slot) != content.next_key) continue;
      if (events_.before(content.needles[slot], best)) best = content.needles[slot];
    }
    return best;
  }

  EventTable events_;
  LargeArray<Place> places_;
  std::vector<Content> blocks_;
  std::vector<PublishedKey> published_keys_;
  std::vector<Owner> owners_;
  std::vector<Subdomain> subdomains_;
  std::vector<Block> changed_;
};

}  // namespace needlework
