// Instants at which the velocities of all needles change: kicks, and the cooling of bodies that
// grow.
#include <algorithm>
#include <bit>
#include <cmath>

#include "needlework/error.h"
#include "src/audit/audit.h"

namespace needlework::audit {

void Audit::add_kick(const State& after, double time) {
  if (!kicks_ && !cooling_) throw InputError("kick: expected none in this scene");
  if (after.id != ids_) throw InputError("state after a kick: expected the needles of the run");
  const double epochs = time / setup_.epoch_length;
  const Instant now = kicks_ ? instant_at(static_cast<double>(findings_.kicks + 1) *
                                          setup_.driving.kicks->every / setup_.epoch_length)
                             : cooling_->next(epochs);
  ++(kicks_ ? findings_.kicks : findings_.coolings);
  note_in_fingerprint(static_cast<std::uint64_t>(now.epoch));
  note_in_fingerprint(std::bit_cast<std::uint64_t>(now.offset));
  settle_cuts(now, true);
  check_owed(now, nullptr);
  advance_windows(now);
  std::vector<Needle> changed = replaced(after, now);
  const double before = energy();
  if (!resumed_) {
    if (std::abs(since_start(now) - epochs) > 0x1p-50 * epochs)
      report(Kind::wrong_order, 0, 0, now);
    kicks_ ? check_kick(now, changed) : check_cooling(now, changed);
  }
  if (cooling_) {
    for (const Needle& needle : needles_) cooling_->add_flight(needle, space_.gravity, now);
    cooling_->pass(epochs, findings_.collisions, needles_.size());
    space_.growth->count_anew();
  }
  needles_ = std::move(changed);
  part_all(now);
  last_energy_change_ = energy() - before;
  windows_.begin_again(now, needles_);
  // What it brings about at its instant begins a new order.
  last_ = {now, {-1, 0, 0, 0, 0, 0}};
  go_on_if_resumed();
}

void Audit::check_kick(const Instant& now, const std::vector<Needle>& after) {
  // Fixed bodies are not kicked, and take up the momentum that others get.
  const auto is_fixed = [&](Index i) { return std::isinf(needles_[i].body.mass); };
  Kicks::Change of_all{};
  bool any_fixed = false;
  Quad mass = 0;
  double largest = 0;
  std::vector<Kicks::Change> changes;
  for (Index i = 0; i < needles_.size(); ++i) {
    const Kicks::Change& change =
        changes.emplace_back(is_fixed(i) ? Kicks::Change{} : kicks_->of(ids_[i], findings_.kicks));
    const Quad its_mass = needles_[i].body.moving_mass();
    of_all.v = of_all.v + change.v * its_mass;
    of_all.v_off += change.v_off * needles_[i].body.moving_mass();
    mass += its_mass;
    any_fixed |= is_fixed(i);
    largest = std::max(largest, magnitude(norm(change.v)));
  }
  if (any_fixed) {
    of_all = {};
  } else if (mass > 0) {
    of_all.v = of_all.v * Quad(1 / mass);
    of_all.v_off /= magnitude(mass);
  }
  check_replaced(now, [&](Index i) {
    return excess_over_kick(present(i, now), space_.gravity, after[i].record, changes[i], of_all,
                            largest, space_);
  });
}

void Audit::check_cooling(const Instant& now, const std::vector<Needle>& after) {
  const Quad factor = cooling_->factor(needles_, space_.gravity, now);
  check_replaced(now, [&](Index i) {
    return excess_over_cooling(needles_[i], after[i].record, factor, space_);
  });
}

// What happens at this instant happens before it. `excess` is that of a needle over the rule.
void Audit::check_replaced(const Instant& now, const std::function<double(Index)>& excess) {
  for (Index i = 0; i < needles_.size(); ++i) {
    if (now < needles_[i].record.time) {
      report(Kind::wrong_order, i, i, now);
      continue;
    }
    check_held(i, now);
    if (excess(i) > 1) report(Kind::wrong_rule, i, i, now);
    check_walls(i, now, nullptr);
    for (Index j = i + 1; j < needles_.size(); ++j) {
      check_flight(i, j, now);
      go_on_from_contact(i, j, now);
    }
  }
}

}  // namespace needlework::audit
