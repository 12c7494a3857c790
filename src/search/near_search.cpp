#include "src/search/near_search.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "kernels/four.h"
#include "kernels/power_of_two.h"
#include "src/physics/permutation.h"
#include "src/search/choice.h"

namespace needlework {
namespace {

using kernels::BlockLink;
using kernels::Motion;
using kernels::NeedleBlock;
using kernels::PairColumns;

// A needle stays in its cell until it is out of it by so much of the cell's side: one that goes to
// and fro at a border, or crosses a corner, has not to be placed anew so often.
constexpr double overlap_of_side = 0.2;
// Cells that a search may choose to have, by needles: those around a cloud are empty, and take half
// a kilobyte each.
constexpr double most_cells = 2;
// What rounding does to the place of a hull, by far. [L]
constexpr double hull_margin = 0x1p-12;
// What the roundings of times in blocks and motions amount to, twice; see near_needles_body.h. Ends
// of searches may be far ahead and have more added.
constexpr double time_margin = 0x1p-18;
constexpr double roundup = 1 + 0x1p-20;

void store(float (&to)[3], const Vec3d& a) {
  to[0] = static_cast<float>(a.x);
  to[1] = static_cast<float>(a.y);
  to[2] = static_cast<float>(a.z);
}

double side_for(Hulls::Kind kind, double density) {
  return kind == Hulls::Kind::cell ? auto_cell_side(density) : auto_side_for_capsules(density);
}

// Fills in the pairs of the seeker with what it has found, four at once: most of the work is to
// turn rows into columns.
void fill_pairs(const kernels::Seeker& seeker, const Motion* motions,
                const kernels::CellView* cells, const kernels::Found& found, std::size_t count,
                const PairColumns& pairs) {
  using C = PairColumns;
  using kernels::four, kernels::Four;
  static_assert(offsetof(Motion, r) == 0 && offsetof(Motion, v) == 12 &&
                offsetof(Motion, u) == 24 && offsetof(Motion, p) == 36 &&
                offsetof(Motion, omega) == 48 && offsetof(Motion, time) == 52 &&
                offsetof(Motion, until) == 56 && offsetof(Motion, half) == 60 &&
                offsetof(kernels::CellView, offset) == 4);
  for (std::size_t k = 0; k < count; k += 4) {
    Four part[4][4], offset[4];  // of the motions; of the cells, after their block
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t n = std::min(k + i, count - 1);
      const auto* row = reinterpret_cast<const char*>(&motions[found.needle[n]]);
      for (int quarter = 0; quarter < 4; ++quarter) {
        part[quarter][i] = kernels::load_four(row + 16 * quarter);
      }
      offset[i] = kernels::load_four(&cells[found.cell[n]]);
    }
    for (Four(&rows)[4] : part) kernels::transpose(rows);
    kernels::transpose(offset);
    const Four r[3] = {part[0][0], part[0][1], part[0][2]},
               v[3] = {part[0][3], part[1][0], part[1][1]};
    const Four age = four(seeker.now) - part[3][1];
    const auto put = [&](int column, const Four& a) {
      kernels::store_four(a, pairs.column[column] + k);
    };
    for (int axis = 0; axis < 3; ++axis) {
      put(C::r_x + axis,
          (four(seeker.motion.r[axis]) - offset[1 + axis] - r[axis]) - v[axis] * age);
      put(C::v_x + axis, four(seeker.motion.v[axis]) - v[axis]);
    }
    put(C::u_x, part[1][2]);
    put(C::u_y, part[1][3]);
    for (int n = 0; n < 4; ++n) put(C::u_z + n, part[2][n]);
    put(C::omega, part[3][0]);
    put(C::half, part[3][3]);
    put(C::age, age);
    const Four left = part[3][2] - four(seeker.now), zero = four(0);
    const Four until = (left > zero ? left : zero) + four(static_cast<float>(time_margin));
    put(C::until, until < four(seeker.ahead) ? until : four(seeker.ahead));
  }
}

}  // namespace

Hulls::Hulls(const Gas& all, const SearchSetup& setup, Kind which)
    : gas(all),
      kind(which),
      radius(kind == Kind::cell ? 0
                                : setup.capsule_radius.value_or(
                                      auto_capsule_radius(setup.density.value_or(gas.density())))),
      grid(setup.cell_side
               ? CellGrid(gas.box, *setup.cell_side, gas.size())
               : CellGrid(gas.box, side_for(kind, setup.density.value_or(gas.density())),
                          gas.size(), setup.count_multiples, most_cells)),
      places(gas.size()),
      motions(gas.size()) {
  // With room for all that may ever be chained, as only full blocks have others after them: threads
  // must not find their blocks moved.
  const std::size_t most = grid.size() + gas.size() / kernels::block_size;
  blocks.reserve(most);
  blocks.resize(grid.size());
  links.reserve(most);
  links.resize(grid.size());
  const auto sides = grid.sides();
  if (kind == Kind::cell) overlap = overlap_of_side * std::min({sides[0], sides[1], sides[2]});
  margin =
      static_cast<float>(0x1p-16 + (std::max({sides[0], sides[1], sides[2]}) + overlap) * 0x1p-19);
}

NearSearch::NearSearch(const Gas& gas, Counters& counters, const SearchSetup& setup,
                       Hulls::Kind kind)
    : hulls_(std::make_shared<Hulls>(gas, setup, kind)),
      counters_(counters),
      kernels_(kernels::near_kernels(setup.isa)),
      by_lanes_(setup.float_filter) {}

NearSearch::NearSearch(const NearSearch& other, Counters& counters)
    : hulls_(other.hulls_),
      counters_(counters),
      kernels_(other.kernels_),
      by_lanes_(other.by_lanes_) {}

Time NearSearch::place(Needle i, Time now) {
  Hulls& hulls = *hulls_;
  if (hulls.unit == 0 || hulls.since_base(now) > kernels::longest_time) hulls.rebase(now);
  const Record& record = hulls.gas.records[i];
  const kernels::Flight& flight = record.flight;
  const double elapsed = hulls.gas.clock.difference(now, record.time);
  Hulls::Place& place = hulls.places[i];
  counters_.rebuilds += place.until <= now;
  Vec3d r = centre_after(flight, elapsed), a;
  double stay;
  if (hulls.kind == Hulls::Kind::cell) {
    stay = hulls.grid.time_to_leave(hulls.grid.cell_of(r), r, flight.v, hulls.overlap);
    a = flight.v * (1 / hulls.unit);
  } else {
    // The capsule is around where the needle will be in half of its time there, so that it may
    // move by the radius before that and after.
    const double half = hulls.radius / (std::sqrt(dot(flight.v, flight.v)) + 0.5 * flight.omega);
    stay = 2 * half;
    const double middle = std::isfinite(half) ? elapsed + half : elapsed;
    r = centre_after(flight, middle);
    a = director_after(flight, middle);
  }
  counters_.crossings += hulls.enter(i, hulls.grid.cell_of(r));
  place.until = hulls.gas.clock.add(now, stay);
  hulls.write_entry(i, r, a, now);
  hulls.set_motion(i, now);
  return place.until;
}

// Sets unit and origin of time in blocks and motions anew, before times grow so long that floats
// lose digits of them.
void Hulls::rebase(Time now) {
  double sum = 0;
  for (const Record& record : gas.records) {
    sum += dot(record.flight.v, record.flight.v) + 0.25 * record.flight.omega * record.flight.omega;
  }
  const double speed = std::sqrt(sum / static_cast<double>(gas.size()));
  unit = speed > 0 && std::isfinite(speed) ? times_power_of_two(1, exponent_of(speed)) : 1;
  base = now;
  for (Needle i{0}; i < gas.size(); ++i) {
    if (places[i].block == BlockLink::none) continue;
    set_motion(i, now);
    if (kind == Kind::capsule) continue;
    const Record& record = gas.records[i];
    const double elapsed = gas.clock.difference(now, record.time);
    write_entry(i, centre_after(record.flight, elapsed), record.flight.v * (1 / unit), now);
  }
}

void Hulls::set_motion(Needle i, Time now) {
  const Record& record = gas.records[i];
  const kernels::Flight& flight = record.flight;
  const double elapsed = gas.clock.difference(now, record.time);
  const SineCosine<double> sc = sine_cosine(flight.omega * elapsed);
  const double per_unit = 1 / unit;
  Motion& out = motions[i];
  store(out.r, centre_after(flight, elapsed) - grid.corner(places[i].cell));
  store(out.v, flight.v * per_unit);
  store(out.u, flight.u * sc.cosine + flight.p * sc.sine);
  store(out.p, flight.p * sc.cosine - flight.u * sc.sine);
  out.omega = static_cast<float>(flight.omega * per_unit);
  out.time = static_cast<float>(since_base(now));
  out.until = static_cast<float>(since_base(places[i].until) * roundup);
  out.half = 0.5f;
}

// Writes the needle's entry into the block of its cell.
void Hulls::write_entry(Needle i, const Vec3d& centre, const Vec3d& a, Time now) {
  const Place& place = places[i];
  NeedleBlock& block = blocks[place.block];
  const Vec3d r = centre - grid.corner(place.cell);
  const double values[NeedleBlock::columns] = {r.x, r.y, r.z, a.x, a.y, a.z, since_base(now)};
  for (int column = 0; column < NeedleBlock::columns; ++column) {
    block.column[column][place.lane] = static_cast<float>(values[column]);
  }
  block.needle[place.lane] = i.index;
}

// Moves needle i to this cell. It takes the next free place there; a block is chained where all are
// full.
bool Hulls::enter(Needle i, const Cell& cell) {
  Place& place = places[i];
  const bool entered = place.block != BlockLink::none;
  const std::size_t index = grid.index_of(cell);
  const bool stays = entered && index == grid.index_of(place.cell);
  if (entered && !stays) leave(i);
  place.cell = cell;
  if (stays) return false;
  std::uint32_t b = static_cast<std::uint32_t>(index);
  std::size_t chain = 1;
  for (; links[b].size == kernels::block_size; ++chain) {
    if (links[b].next == BlockLink::none) {
      const std::lock_guard alone(chaining);
      if (free_blocks.empty()) {
        free_blocks.push_back(static_cast<std::uint32_t>(blocks.size()));
        blocks.emplace_back();
        links.emplace_back();
      }
      links[b].next = free_blocks.back();
      free_blocks.pop_back();
      if (chain + 1 > longest_chain) longest_chain = chain + 1;
    }
    b = links[b].next;
  }
  place.block = b;
  place.lane = links[b].size++;
  return entered;
}

// Takes needle i from its cell. The last needle of the cell moves to its place, so that only the
// last block has free ones.
void Hulls::leave(Needle i) {
  const Place& place = places[i];
  std::uint32_t last = place.block, previous = BlockLink::none;
  for (std::uint32_t b = static_cast<std::uint32_t>(grid.index_of(place.cell));
       links[b].next != BlockLink::none; b = links[b].next) {
    previous = b;
    last = links[b].next;
  }
  const std::uint32_t lane = --links[last].size;
  const Needle moved(blocks[last].needle[lane]);
  if (moved != i) {
    NeedleBlock& to = blocks[place.block];
    for (int column = 0; column < NeedleBlock::columns; ++column) {
      to.column[column][place.lane] = blocks[last].column[column][lane];
    }
    to.needle[place.lane] = moved.index;
    places[moved].block = place.block;
    places[moved].lane = place.lane;
  }
  if (links[last].size == 0 && previous != BlockLink::none) {
    links[previous].next = BlockLink::none;
    links[last] = {};
    const std::lock_guard alone(chaining);
    free_blocks.push_back(last);
  }
}

void NearSearch::renumber(const std::vector<Needle>& ranks) {
  Hulls& hulls = *hulls_;
  const std::vector<Needle> order = ranks_of(ranks);
  permute(hulls.places, order);
  permute(hulls.motions, order);
  for (std::size_t b = 0; b < hulls.blocks.size(); ++b) {
    for (std::uint32_t lane = 0; lane < hulls.links[b].size; ++lane) {
      hulls.blocks[b].needle[lane] = ranks[hulls.blocks[b].needle[lane]].index;
    }
  }
}

PairColumns NearSearch::pair_columns(std::size_t n) {
  if (n + 2 * kernels::block_size > pair_capacity_) {
    pair_capacity_ = 2 * n + 2 * kernels::block_size;
    pair_storage_.assign(pair_capacity_ * PairColumns::columns, 0.0f);
  }
  PairColumns out;
  for (int c = 0; c < PairColumns::columns; ++c) {
    out.column[c] = pair_storage_.data() + c * pair_capacity_;
  }
  return out;
}

// Makes views of the cells in which needles may be found: those that a needle within reach of this
// one's hull, or of its way in the time ahead, can have been placed in.
void NearSearch::look_around(const kernels::Seeker& seeker, const Cell& cell, double ahead) {
  const Hulls& hulls = *hulls_;
  // The margin covers the rounding of the seeker's place in its cell.
  double reach = 1 + hull_margin + hulls.margin;
  double way = ahead * hulls.unit;
  if (hulls.kind == Hulls::Kind::capsule) {
    // Another centre is not farther from this axis than half a length and both radii.
    reach = 0.5 + 2 * hulls.radius + hull_margin + hulls.margin;
    way = 0;
  }
  const auto sides = hulls.grid.sides();
  for (int axis = 0; axis < 3; ++axis) {
    const double r = cell[axis] * sides[axis] + seeker.r[axis];
    const double span = hulls.kind == Hulls::Kind::capsule ? 0.5 * std::abs(seeker.u[axis]) : 0;
    const double end = r + seeker.motion.v[axis] * way;
    near_[axis].clear();
    hulls.grid.append_near(axis, cell[axis], std::min(r, end) - span, std::max(r, end) + span,
                           hulls.overlap, reach, near_[axis]);
  }
  const float reach_squared = static_cast<float>(reach * reach);
  const std::size_t most = near_[0].size() * near_[1].size() * near_[2].size();
  if (most > views_.size()) {
    views_.resize(most);
    view_cells_.resize(most);
  }
  // Copied, for what is stored might be these, as far as a compiler can tell.
  const NeedleBlock* const blocks = hulls.blocks.data();
  kernels::CellView* view = views_.data();
  Cell* view_cell = view_cells_.data();
  for (const auto& z : near_[2]) {
    for (const auto& y : near_[1]) {
      const float gap_squared = z.gap_squared + y.gap_squared;
      if (gap_squared > reach_squared) continue;
      const std::size_t row = hulls.grid.index(0, y.wrapped, z.wrapped);
      for (const auto& x : near_[0]) {
        const std::uint32_t first = static_cast<std::uint32_t>(row + x.wrapped);
        if (gap_squared + x.gap_squared > reach_squared) continue;
        needlework::prefetch(&blocks[first]);
        *view++ = {first, {x.offset, y.offset, z.offset}};
        *view_cell++ = {x.cell, y.cell, z.cell};
      }
    }
  }
  view_count_ = static_cast<std::size_t>(view - views_.data());
  const std::size_t room = (view_count_ * hulls.longest_chain + 1) * kernels::block_size;
  if (2 * room > found_.size()) found_.resize(4 * room);
}

std::span<const NearSearch::Candidate> NearSearch::candidates(Needle i, Needle just_hit,
                                                              Time /*now*/, double ahead) {
  const Hulls& hulls = *hulls_;
  kernels::Seeker seeker;
  seeker.motion = hulls.motions[i];
  seeker.now = seeker.motion.time;
  seeker.ahead = static_cast<float>(ahead * hulls.unit * roundup + time_margin);
  seeker.margin = hulls.margin;
  seeker.longest_half = 0.5f;
  seeker.needle = i.index;
  const Hulls::Place& place = hulls.places[i];
  for (int axis = 0; axis < 3; ++axis) {
    seeker.r[axis] = hulls.blocks[place.block].column[NeedleBlock::x + axis][place.lane];
    seeker.u[axis] = hulls.blocks[place.block].column[NeedleBlock::a_x + axis][place.lane];
  }
  look_around(seeker, place.cell, ahead);
  const kernels::Surroundings around{hulls.blocks.data(), hulls.links.data(), views_.data(),
                                     view_count_, hulls.motions.data()};
  const kernels::Found found{found_.data(), found_.data() + found_.size() / 2};
  const auto [entries, count] =
      hulls.kind == Hulls::Kind::cell
          ? kernels_.approaching(around, seeker, found)
          : kernels_.overlapping(around, seeker, static_cast<float>(hulls.radius), found);
  counters_.candidates += entries;

  for (std::size_t k = 0; k < count; ++k) needlework::prefetch(&hulls.motions[found.needle[k]]);

  candidates_.clear();
  const auto propose = [&](std::size_t k, double from, double to) {
    const Needle j(found.needle[k]);
    needlework::prefetch(&hulls.places[j]);
    needlework::prefetch(&hulls.gas.records[j]);
    candidates_.push_back({from, to, j, found.cell[k], {}});
  };
  constexpr double endless = std::numeric_limits<double>::infinity();
  if (by_lanes_) {
    const PairColumns pairs = pair_columns(count);
    const float speed = std::abs(seeker.motion.v[0]) + std::abs(seeker.motion.v[1]) +
                        std::abs(seeker.motion.v[2]) + seeker.motion.omega;
    const float parting = 0.25f / speed;
    fill_pairs(seeker, hulls.motions.data(), views_.data(), found, count, pairs);
    // A needle just hit is near for sure: this one looks from a little later on.
    for (std::size_t k = 0; k < count; ++k) {
      pairs.column[PairColumns::from][k] = found.needle[k] == just_hit.index ? parting : 0.0f;
    }
    counters_.isolated += kernels_.bracket(seeker, pairs, count);
    for (std::size_t k = 0; k < count; ++k) {
      const float from = pairs.column[PairColumns::from][k];
      const bool met = from <= seeker.ahead;
      if (found.needle[k] == just_hit.index) {
        propose(k, 0, met ? endless : parting / hulls.unit);
      } else if (met) {
        propose(k, from / hulls.unit, endless);
      }
    }
  } else {
    for (std::size_t k = 0; k < count; ++k) propose(k, 0, endless);
  }
  std::sort(candidates_.begin(), candidates_.end(),
            [](const Candidate& a, const Candidate& b) { return a.from < b.from; });
  for (Candidate& candidate : candidates_) {
    candidate.shift =
        hulls.grid.boxes_between(view_cells_[candidate.view], hulls.places[candidate.needle].cell);
  }
  counters_.filtered += entries - candidates_.size();
  return candidates_;
}

}  // namespace needlework
