#include "src/engine/effect_totals.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>

#include "src/scene/effect_names.h"

namespace needlework {
namespace {

// Whether any two bodies pass through each other, besides fixed ones, which never meet.
bool pass_through_each_other(const Composition& composition) {
  for (std::size_t a = 0; a < composition.size(); ++a) {
    for (std::size_t b = a; b < composition.size(); ++b) {
      const bool may_move = !composition[a].fixed || !composition[b].fixed;
      if (may_move && !composition.meets(a, b)) return true;
    }
  }
  return false;
}

// In radians, as exact as a double at any age of the run.
double phase_of(const std::optional<Scene::WallMotion>& motion, const Clock& clock, Time now) {
  if (!motion || motion->velocity || motion->tangential)
    return std::numeric_limits<double>::quiet_NaN();
  constexpr double turn = 2 * std::numbers::pi;
  const DoubleDouble turns =
      clock.turns(now, motion->frequency) + DoubleDouble(motion->phase / turn);
  const double rest = to_double(turns - DoubleDouble(std::floor(turns.hi)));
  return rest > 0 && rest < 1 ? turn * rest : 0;
}

}  // namespace

std::string name_effects(const Run& run) {
  const auto& rules = run.gas.composition.rules();
  const bool inelastic = std::any_of(rules.begin(), rules.end(),
                                     [](const Restitution& rule) { return rule.epsilon < 1; });
  const auto has_source = [&](std::string_view name) {
    return std::ranges::any_of(run.sources, [&](const auto& each) { return each->name() == name; });
  };
  const std::array<bool, effect_names.size()> are_in = {
      run.effects.rough,
      run.effects.contact_time,
      run.gas.composition.is_mixture(),
      pass_through_each_other(run.gas.composition),
      run.effects.width,
      run.gas.composition.has_own_sizes(),
      run.gas.composition.has_fixed(),
      bool(run.sliding),
      has_source("wall"),
      has_source("thermostat"),
      run.gas.falls,
      bool(run.kicks),
      bool(run.gas.shear),
      bool(run.growing)};
  std::string out = inelastic ? "inelastic" : "elastic";
  for (std::size_t n = 0; n < are_in.size(); ++n)
    if (are_in[n]) out += fmt::format(" {}", effect_names[n]);
  return out;
}

std::vector<std::uint64_t> collisions_by_pair(const Run& run) {
  if (!run.gas.composition.is_mixture()) return {run.tally.collisions};
  std::vector<std::uint64_t> out = run.tally.by_pair;
  out.resize(run.gas.composition.pairs());
  // The event loop of needles of one species counts no pairs of species.
  if (const std::optional<std::size_t> only = run.gas.composition.only())
    out[run.gas.composition.pair_index(*only, *only)] = run.tally.collisions;
  return out;
}

std::vector<std::vector<ObjectTotals>> objects_by_source(const Run& run) {
  std::vector<std::vector<ObjectTotals>> out;
  for (std::size_t n = 0; n < run.sources.size(); ++n) {
    out.emplace_back(run.sources[n]->objects());
    if (run.tally.by_object.empty()) continue;
    for (std::size_t object = 0; object < out.back().size(); ++object) {
      const ObjectTally& sums = run.tally.by_object[run.first_object[n] + object];
      out.back()[object] = {
          sums.events,
          sums.impulse.value(),
          sums.normal_impulse.value(),
          {sums.momentum[0].value(), sums.momentum[1].value(), sums.momentum[2].value()},
          sums.work.value()};
    }
  }
  return out;
}

std::vector<WallTotals> wall_totals(const Run& run, const Scene& scene) {
  const Vector edges = run.gas.edges_at(run.now), low = run.gas.low_at(run.now);
  std::vector<WallTotals> out;
  std::vector<double> mean_areas;
  for (const Scene::WallSide& side : scene.wall_sides()) {
    WallTotals& wall = out.emplace_back();
    wall.axis = static_cast<int>(side.axis);
    wall.high = side.is_high;
    const auto area = [&](const Vector& of) {
      return of[(side.axis + 1) % 3] * of[(side.axis + 2) % 3];
    };
    const auto& motion = scene.walls[side.entry].motion;
    wall.area = area(edges);
    mean_areas.push_back(run.gas.mean_of_edges(run.now, area));
    wall.phase = phase_of(motion, run.gas.clock, run.now);
    wall.place = low[side.axis] + (side.is_high ? edges[side.axis] : 0);
    if (motion && motion->amplitude > 0) wall.place += motion->amplitude * std::sin(wall.phase);
  }
  const auto by_source = objects_by_source(run);
  for (std::size_t n = 0; n < by_source.size(); ++n) {
    if (run.sources[n]->kind() != Happening::wall) continue;
    for (std::size_t wall = 0; wall < std::min(out.size(), by_source[n].size()); ++wall) {
      out[wall].hits = by_source[n][wall].events;
      out[wall].impulse = by_source[n][wall].impulse;
      out[wall].normal_impulse = by_source[n][wall].normal_impulse;
      out[wall].impulse_x = by_source[n][wall].momentum[0];
      out[wall].impulse_y = by_source[n][wall].momentum[1];
      out[wall].impulse_z = by_source[n][wall].momentum[2];
      out[wall].work =
          by_source[n][wall].work / static_cast<double>(std::max<std::size_t>(run.gas.moving(), 1));
    }
  }
  const EnergyBudget budget = run.energy_budget();
  for (std::size_t n = 0; n < out.size(); ++n) {
    out[n].energy = n < budget.walls.size() ? budget.walls[n] : 0;
    out[n].pressure = out[n].normal_impulse / (mean_areas[n] * run.gas.clock.since_start(run.now));
  }
  return out;
}

std::optional<SlidingContacts> sliding_contacts(const Run& run) {
  if (!run.sliding) return std::nullopt;
  const SlidingTally& tally = run.tally.sliding;
  const double of_all = static_cast<double>(run.gas.size()) * run.gas.clock.since_start(run.now);
  return SlidingContacts{.entered = tally.entered,
                         .ended_by_force = tally.by_force,
                         .ended_by_tip = tally.by_tip,
                         .ended_by_strike = tally.by_strike,
                         .crowded = tally.crowded,
                         .time = tally.time.value(),
                         .share = 2 * tally.time.value() / of_all};
}

// The gas has them in the largest ones, of which the quotient is rounded: at the start this must
// not show.
double present_scale(const Run& run, const Scene& scene, const Composition& at_start) {
  if (!run.gas.growth) return 1;
  const double scale =
      run.gas.scale_at(run.now) * (run.gas.composition.longest() / at_start.longest());
  const double first = scene.driving.growth->from;
  return scale <= first * (1 + 0x1p-50) ? first : scale;
}

std::optional<GrowthTotals> growth_totals(const Run& run, const Scene& scene,
                                          const Composition& at_start) {
  if (!run.growing) return std::nullopt;
  const Vector edges = run.gas.edges_at(run.now);
  const double scale = run.gas.scale_at(run.now), pressure = run.growing->pressure();
  const double largest = run.gas.composition.longest() / at_start.longest();
  return GrowthTotals{
      .scale = present_scale(run, scene, at_start),
      .rate = run.gas.growth->rate() * largest,
      .packing_fraction = run.gas.composition.packing_fraction(edges[0] * edges[1] * edges[2]) *
                          (scale * scale * scale),
      .pressure = pressure > 0 ? pressure : std::numeric_limits<double>::quiet_NaN()};
}

}  // namespace needlework
