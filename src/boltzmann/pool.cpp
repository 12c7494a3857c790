#include "src/boltzmann/pool.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include "src/physics/director.h"

namespace needlework::boltzmann {
namespace {

constexpr std::size_t longest_counted = 32;  // encounters of more collisions are counted together
// Covers rounding of a needle's fastest point.
constexpr double roundup = 1 + 0x1p-40;

double size_of(const Vec3d& a) { return std::sqrt(dot(a, a)); }
Vec3d vector(const std::array<double, 3>& a) { return {a[0], a[1], a[2]}; }

}  // namespace

Pool::Pool(const Settings& settings, std::uint64_t number, std::span<const std::uint64_t> needles)
    : pairs_(settings.pairs),
      contact_time_(settings.contact_time),
      random_(settings.seed, number, RandomFor::boltzmann, 0),
      encounters_of_(longest_counted) {
  const Composition& all = settings.composition;
  for (std::size_t n = 0; n < all.size(); ++n) {
    kinds_.push_back({.mass = all[n].mass,
                      .inertia = all[n].inertia(),
                      .body = body_of(all[n]),
                      .first = needles_.size(),
                      .count = needles[n]});
    needles_.resize(needles_.size() + needles[n]);
    draw(kinds_.back(), all[n]);
  }
  for (std::size_t a = 0; a < all.size(); ++a) {
    for (std::size_t b = a; b < all.size(); ++b) {
      const auto of_a = static_cast<double>(needles[a]), of_b = static_cast<double>(needles[b]);
      const double share = of_a / static_cast<double>(needles_.size());
      const double pairs = share * (a == b ? 0.5 * (of_b - 1) : of_b);
      partners_.push_back(
          {.first = a,
           .second = b,
           .rule = all.restitution(a, b),
           .weight = all.meets(a, b) ? pairs * (all[a].length * all[b].length) : 0});
    }
  }
  find_fastest();
}

std::span<Pool::Needle> Pool::needles_of(const Kind& kind) {
  return std::span(needles_).subspan(kind.first, kind.count);
}

std::span<const Pool::Needle> Pool::needles_of(const Kind& kind) const {
  return std::span(needles_).subspan(kind.first, kind.count);
}

// At rest as a whole, and exactly at the temperatures of the species.
void Pool::draw(Kind& kind, const Species& species) {
  Vec3d sum{};
  for (Needle& needle : needles_of(kind)) {
    needle.u = vector(random_.direction());
    needle.v = vector(random_.normal());
    needle.w = project_out(vector(random_.normal()), needle.u);
    sum = sum + needle.v;
  }
  const auto count = static_cast<double>(kind.count);
  double v_squared = 0, w_squared = 0;
  for (Needle& needle : needles_of(kind)) {
    needle.v = needle.v - sum * (1 / count);
    v_squared += dot(needle.v, needle.v);
    w_squared += dot(needle.w, needle.w);
  }
  const double v_scale = std::sqrt(3 * count * species.t_tr * kind.body.inverse_mass / v_squared);
  const double w_scale =
      std::sqrt(2 * count * species.t_rot * kind.body.inverse_inertia / w_squared);
  for (Needle& needle : needles_of(kind)) {
    needle.v = needle.v * v_scale;
    needle.w = needle.w * w_scale;
    set_fastest(needle, kind);
  }
}

void Pool::set_fastest(Needle& needle, Kind& kind) {
  needle.fastest = (size_of(needle.v) + kind.body.half_length * size_of(needle.w)) * roundup;
  kind.fastest = std::max(kind.fastest, needle.fastest);
}

void Pool::find_fastest() {
  double squares = 0;
  for (Kind& kind : kinds_) {
    kind.fastest = 0;
    for (const Needle& needle : needles_of(kind)) {
      kind.fastest = std::max(kind.fastest, needle.fastest);
      squares += kind.mass * dot(needle.v, needle.v);
    }
  }
  t_tr_ = squares / (3 * static_cast<double>(needles_.size()));
  until_looked_ = needles_.size() / 8;
}

// Their rate in n t, above that of collisions: no pair's |u1 x u2| |V_n| is above both of these.
double Pool::candidates(const Partners& partners) const {
  return partners.weight * (kinds_[partners.first].fastest + kinds_[partners.second].fastest);
}

// Each with the share that its candidates have of all.
Pool::Partners& Pool::any_partners(double all) {
  if (partners_.size() == 1) return partners_.front();
  double left = random_.uniform() * all;
  Partners* out = nullptr;
  for (Partners& partners : partners_) {
    const double rate = candidates(partners);
    if (rate > 0) out = &partners;  // rounding may leave more than the last one has
    if ((left -= rate) < 0) break;
  }
  return *out;
}

std::size_t Pool::any_of(std::size_t count) {
  return static_cast<std::size_t>(random_.uniform() * static_cast<double>(count));
}

// At a random phase of its rotation.
Vec3d Pool::director(const Needle& needle) {
  if (needle.w == Vec3d{}) return needle.u;
  for (;;) {
    const Vec3d any = vector(random_.direction());
    const Vec3d out = project_out(any, normalised(needle.w));
    // Not of rounding errors.
    if (dot(out, out) > 0x1p-20) return normalised(out);
  }
}

void Pool::meet(Partners& partners, Needle& a, Needle& b, const Touching& touching) {
  Kind &kind_a = kinds_[partners.first], &kind_b = kinds_[partners.second];
  // The contact time follows the temperature, as it would follow the mean free time.
  const Encounter encounter({kind_a.body, kind_b.body}, partners.rule,
                            contact_time_ / std::sqrt(t_tr_));
  Touching pair = touching;
  EncounterResult result{.collisions = 1};
  if (pairs_ == Pairs::single) {
    encounter.collide(pair);
  } else if (encounter.is_first(pair)) {
    result = encounter.follow(pair);
  } else {
    ++met_before_;
    return;
  }
  a.v = pair.needle[0].v, a.w = pair.needle[0].w;
  b.v = pair.needle[1].v, b.w = pair.needle[1].w;
  a.u = pair.needle[0].u, b.u = pair.needle[1].u;
  set_fastest(a, kind_a);
  set_fastest(b, kind_b);
  partners.collisions += result.collisions;
  kind_a.collisions += result.collisions;
  kind_b.collisions += result.collisions;
  tc_collisions_ += result.tc_collisions;
  unfinished_ += !result.finished;
  ++encounters_of_[std::min<std::size_t>(result.collisions, longest_counted) - 1];
  if (until_looked_-- == 0) find_fastest();
}

void Pool::advance(double tau) {
  const double end = tau / (2.0 / 3 * std::sqrt(std::numbers::pi));
  while (time_ < end) {
    double rate = 0;
    for (const Partners& partners : partners_) rate += candidates(partners);
    time_ += rate > 0 ? random_.exponential() / rate : std::numeric_limits<double>::infinity();
    // Waiting times have no memory: the rest of this one is drawn anew.
    if (time_ >= end) break;
    Partners& partners = any_partners(rate);
    const Kind &kind_a = kinds_[partners.first], &kind_b = kinds_[partners.second];
    const bool alike = partners.first == partners.second;
    const std::size_t i = any_of(kind_a.count);
    std::size_t j = any_of(kind_b.count - alike);
    j += alike && j >= i;
    Needle &a = needles_of(kind_a)[i], &b = needles_of(kind_b)[j];
    const double drawn = (kind_a.fastest + kind_b.fastest) * random_.uniform();
    if (drawn >= a.fastest + b.fastest) continue;
    const std::array u{director(a), director(b)};
    const auto any_arm = [&](const Kind& kind) {
      return (random_.uniform() - 0.5) * (2 * kind.body.half_length);
    };
    const std::array arm{any_arm(kind_a), any_arm(kind_b)};
    const Vec3d v = a.v - b.v + cross(a.w, u[0]) * arm[0] - cross(b.w, u[1]) * arm[1];
    if (drawn >= std::abs(dot(cross(u[0], u[1]), v))) continue;
    meet(partners, a, b, touching({a.v, b.v}, u, {a.w, b.w}, arm));
  }
  time_ = end;
}

std::vector<Sums> Pool::sums() const {
  std::vector<Sums> out;
  for (const Kind& kind : kinds_) {
    Sums& sums = out.emplace_back();
    for (const Needle& needle : needles_of(kind)) {
      const double tr = kind.mass * dot(needle.v, needle.v);
      const double rot = kind.inertia * dot(needle.w, needle.w);
      sums.tr += tr, sums.rot += rot;
      sums.tr_tr += tr * tr, sums.rot_rot += rot * rot, sums.tr_rot += tr * rot;
    }
    sums.needles = static_cast<double>(kind.count);
    sums.collisions = static_cast<double>(kind.collisions);
  }
  return out;
}

std::vector<std::uint64_t> Pool::collisions_between() const {
  std::vector<std::uint64_t> out;
  for (const Partners& partners : partners_) out.push_back(partners.collisions);
  return out;
}

void Pool::add_to(Result& result) const {
  result.met_before += met_before_;
  result.tc_collisions += tc_collisions_;
  result.unfinished += unfinished_;
  result.encounters_of.resize(longest_counted);
  for (std::size_t n = 0; n < longest_counted; ++n) {
    result.encounters_of[n] += encounters_of_[n];
    result.encounters += encounters_of_[n];
  }
}

}  // namespace needlework::boltzmann
