// A tournament tree: matches of eight players, whose winners meet in the next round.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "src/calendar/event_table.h"
#include "src/memory/large_array.h"
#include "src/memory/prefetch.h"

namespace needlework {

/// Eight keys in a cache line. Unused positions hold distinct keys greater than all others.
struct alignas(64) KeyLine {
  static constexpr std::uint32_t width = 8;

  std::array<TimeKey, width> key = {~TimeKey{0}, ~TimeKey{1}, ~TimeKey{2}, ~TimeKey{3},
                                    ~TimeKey{4}, ~TimeKey{5}, ~TimeKey{6}, ~TimeKey{7}};
};

/// The smallest key; bit n is set if the key at position n is equal to it. Without branches,
/// because which key is smallest cannot be predicted.
struct LeastKeys {
  explicit LeastKeys(const std::array<TimeKey, KeyLine::width>& of)
      : key(std::min(std::min(std::min(of[0], of[1]), std::min(of[2], of[3])),
                     std::min(std::min(of[4], of[5]), std::min(of[6], of[7])))) {
    for (std::uint32_t n = 0; n < KeyLine::width; ++n) {
      places |= static_cast<std::uint32_t>(of[n] == key) << n;
    }
  }

  TimeKey key;
  std::uint32_t places = 0;
};

/// Players 0 to n - 1, each with a key, initially equal ones. The smallest key wins. A complete
/// tree with eight players to a match instead of two: a match is a cache line, and a tree of 1e6
/// players has 7 rounds instead of 20.
///
/// 9.7 bytes per player.
class WinnerTree {
 public:
  explicit WinnerTree(std::size_t n, TimeKey key) : players_(n) {
    std::size_t players = n;
    // n / 8 + n / 64 + ..., and one more line for each round that is not full.
    lines_.reserve(n / 7 + 32);
    winner_.reserve(n / 7 + 32);
    do {
      const std::size_t lines = (players + KeyLine::width - 1) / KeyLine::width;
      first_.push_back(lines_.size());
      lines_.resize(lines_.size() + lines);
      for (std::size_t i = 0; i < players; ++i) {
        lines_[first_.back() + i / KeyLine::width].key[i % KeyLine::width] = key;
      }
      players = lines;
    } while (players > 1);
    for (std::size_t round = 0, span = KeyLine::width; round < first_.size(); ++round) {
      const std::size_t end = round + 1 < first_.size() ? first_[round + 1] : lines_.size();
      for (std::size_t i = 0; first_[round] + i < end; ++i) {
        winner_.push_back(static_cast<std::uint32_t>(i * span));
      }
      span *= KeyLine::width;
    }
  }

  /// The player with the smallest key.
  std::uint32_t winner() const { return winner_.back(); }
  /// The smallest of those that the winner beats in the last round, which is often the next to
  /// win. Any player if the tree has one round.
  std::uint32_t second() const {
    if (first_.size() == 1) return winner();
    const KeyLine& final = lines_.back();
    const std::size_t place = winner() >> ((first_.size() - 1) * log2_width);
    std::size_t best = place == 0 ? 1 : 0;
    for (std::size_t n = best + 1; n < KeyLine::width; ++n) {
      if (n != place && final.key[n] < final.key[best]) best = n;
    }
    const std::size_t finalists = lines_.size() - 1 - first_[first_.size() - 2];
    return best < finalists ? winner_[first_[first_.size() - 2] + best] : winner();
  }
  /// The key of the winner.
  TimeKey winning_key() const {
    return lines_.back().key[winner() >> ((first_.size() - 1) * log2_width)];
  }

  /// Prefetches what update() accesses in the first rounds; the matches of later ones are few.
  void prefetch(std::uint32_t player) const {
    std::size_t match = player;
    for (std::size_t round = 0; round < std::min<std::size_t>(first_.size(), 3); ++round) {
      match /= KeyLine::width;
      needlework::prefetch(&lines_[first_[round] + match]);
      needlework::prefetch(&winner_[first_[round] + match]);
    }
  }
  /// Gives each player the key key_of(player), and plays all matches again. Of equal keys before
  /// `end`, before(a, b) is whether player a is before b; of others the lower player wins.
  template <class KeyOf, class Before>
  void play_all(const KeyOf& key_of, TimeKey end, const Before& before) {
    const auto lower = [](std::uint32_t a, std::uint32_t b) { return a < b; };
    std::size_t contestants = players_;
    for (std::size_t round = 0; round < first_.size(); ++round) {
      for (std::size_t at = 0; at < contestants; ++at) {
        lines_[first_[round] + at / KeyLine::width].key[at % KeyLine::width] =
            round == 0 ? key_of(static_cast<std::uint32_t>(at))
                       : LeastKeys(lines_[first_[round - 1] + at].key).key;
      }
      const std::size_t matches = (contestants + KeyLine::width - 1) / KeyLine::width;
      for (std::size_t match = 0; match < matches; ++match) {
        const LeastKeys least(lines_[first_[round] + match].key);
        const std::size_t at = match * KeyLine::width;
        winner_[first_[round] + match] = least.key < end
                                             ? winner_among(round, at, least.places, before)
                                             : winner_among(round, at, least.places, lower);
      }
      contestants = matches;
    }
  }
  /// Gives a player a new key and plays its matches again, up to the first whose outcome does not
  /// change. If keys are equal, before(a, b) is whether player a is before b. `near(player)` is
  /// called for a player that wins all rounds but the last. O(log n).
  template <class Before, class Near>
  void update(std::uint32_t player, TimeKey key, const Before& before, const Near& near) {
    std::size_t contestant = player;    // a player, then the number of the match that it won
    std::uint32_t challenger = player;  // the winner of the match just played
    for (std::size_t round = 0;; ++round) {
      const std::size_t match = first_[round] + contestant / KeyLine::width;
      KeyLine& line = lines_[match];
      line.key[contestant % KeyLine::width] = key;
      std::uint32_t& winner = winner_[match];
      if (winner != player) {
        // A winner from the same position has lost in the previous round.
        const std::size_t place = (winner >> (round * log2_width)) % KeyLine::width;
        if (place != contestant % KeyLine::width) {
          const TimeKey best = line.key[place];
          if (best < key || (best == key && !before(challenger, winner))) return;
        }
        winner = challenger;
      } else {
        const LeastKeys least(line.key);
        key = least.key;
        winner = challenger = winner_among(round, contestant, least.places, before);
      }
      if (round + 1 == first_.size()) return;
      if (round + 2 == first_.size()) near(winner);
      contestant /= KeyLine::width;
    }
  }

 private:
  static constexpr std::size_t log2_width = 3;

  // Decides a match among the contestants whose keys are equal.
  template <class Before>
  std::uint32_t winner_among(std::size_t round, std::size_t contestant, std::uint32_t places,
                             const Before& before) const {
    const auto player_at = [&](std::uint32_t bits) {
      const std::size_t at = contestant / KeyLine::width * KeyLine::width +
                             static_cast<std::size_t>(std::countr_zero(bits));
      return round == 0 ? static_cast<std::uint32_t>(at) : winner_[first_[round - 1] + at];
    };
    std::uint32_t best = player_at(places);
    while ((places &= places - 1) != 0) {
      if (const std::uint32_t other = player_at(places); before(other, best)) best = other;
    }
    return best;
  }

  std::size_t players_;
  std::vector<std::size_t> first_;     ///< index of the first line of each round
  LargeArray<KeyLine> lines_;          ///< the matches, round by round
  std::vector<std::uint32_t> winner_;  ///< winner of each match
};

}  // namespace needlework
