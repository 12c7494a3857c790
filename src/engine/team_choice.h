// Whether several threads work together or one alone, by what each costs at present.
//
// Threads that work together often wait for each other. Where other programs keep a thread off its
// core, each such wait lasts a slice of the scheduler's time, some milliseconds, in which one
// thread alone would have processed hundreds of collisions.
#pragma once

#include <algorithm>

namespace needlework {

/// Compares wall times per collision. It begins with one thread alone, tries all together, and
/// tries the slower of the two again from time to time. Before it leaves all for one because they
/// are a little slower, it measures one again: the cost of a collision changes in the course of a
/// run, and so does the speed of the machine.
class TeamChoice {
 public:
  /// Collisions of a trial, few enough to lose little time.
  static constexpr double trial = 512;

  struct Turn {
    bool together;
    double most;  ///< collisions until the next turn
  };

  Turn next() const {
    if (!alone_.is_known() || checking_) return {false, trial};
    if (together_best_) {
      return since_trial_ < until_trial_ ? Turn{true, most_} : Turn{false, trial};
    }
    if (since_trial_ >= until_trial_) return {true, trial};
    return {false, std::max(trial, (until_trial_ - since_trial_) / alone_.each())};
  }

  /// To be called after each stretch, of whichever kind it became, with the number of its
  /// collisions and with wall times [s]: its own, and that of preparing it. Collisions that were
  /// rolled back do not count, but their time does.
  void took(bool together, double collisions, double seconds, double preparing = 0) {
    since_trial_ += seconds + preparing;
    if (!together) {
      alone_.add(collisions, seconds);
      if (!together_best_) return;
      if (checking_) {
        tried_ += collisions;
        if (tried_ < trial) return;
        checking_ = false;
        if (together_.each() >= alone_.each()) return leave_to_one();
      }
      since_trial_ = 0;
      until_trial_ = std::max(shortest_break, breaks_alone * (seconds + preparing));
      return;
    }
    if (!together_best_ && !on_trial_) together_ = {}, tried_ = 0;
    together_.add(collisions, seconds);
    tried_ += collisions;
    // A trial may take several stretches, of which the last count most, because threads start
    // slowly, and is over early when one of them was given up.
    on_trial_ =
        !together_best_ && collisions > 0 && together_.collisions() < trial && tried_ < 2 * trial;
    if (on_trial_) return;
    if (together_.each() < alone_.each()) {
      if (!together_best_) since_trial_ = 0, until_trial_ = shortest_break;
      together_best_ = true;
      if (collisions == 0) return;  // a stretch that was given up
      most_ = std::min(2 * std::max(most_, trial), longest_turn);
      if (most_ == longest_turn) break_ = 0;
    } else if (together_best_ && !is_far_slower()) {
      checking_ = true;
      alone_ = {};
      tried_ = 0;
    } else {
      leave_to_one();
    }
  }

 private:
  // Whether other programs keep all together waiting, and not only the cost of a collision has
  // changed since one thread was measured.
  bool is_far_slower() const { return together_.each() >= 1.5 * alone_.each(); }

  // One thread works alone until another trial of all threads.
  void leave_to_one() {
    together_best_ = checking_ = false;
    most_ = 0;
    const double lost = together_.seconds() - together_.collisions() * alone_.each();
    const double cost = is_far_slower() ? together_.seconds() : lost;
    break_ = std::min(longest_break, std::max(2 * break_, breaks_together * cost));
    since_trial_ = 0;
    until_trial_ = break_;
  }

  // Times between trials. Of all threads: in wall times that the last one took, or has lost if it
  // was little slower than one thread; of one thread: in wall times of the last one.
  static constexpr double breaks_together = 12, breaks_alone = 100;
  static constexpr double shortest_break = 0.5, longest_break = 10;
  static constexpr double longest_turn = 0x1p20;

  /// Wall time per collision in the last stretches.
  class Cost {
   public:
    void add(double collisions, double seconds) {
      constexpr double kept = 0.7;
      collisions_ = kept * collisions_ + collisions;
      seconds_ = kept * seconds_ + seconds;
    }
    double collisions() const { return collisions_; }
    double seconds() const { return seconds_; }
    bool is_known() const { return collisions_ > 0; }
    double each() const { return seconds_ / collisions_; }

   private:
    double collisions_ = 0, seconds_ = 0;
  };

  Cost alone_, together_;
  bool together_best_ = false;
  bool on_trial_ = false;
  bool checking_ = false;  ///< whether one thread is measured again, because all together, which
                           ///< were faster, seem to be slower now
  double tried_ = 0;       ///< collisions of the trial, or of the check, that is going on
  double most_ = 0;        ///< collisions of the next stretch together; grows while that is faster
  double break_ = 0;       ///< length of the last break after a trial together that was slower [s]
  double since_trial_ = 0, until_trial_ = 0;  ///< wall time since and between trials [s]
};

}  // namespace needlework
