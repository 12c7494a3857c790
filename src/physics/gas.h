// The needles of a run: their records, and the pairs that they form.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "kernels/contact_function.h"
#include "src/box/box.h"
#include "src/box/moving_edge.h"
#include "src/composition/total_mass.h"
#include "src/memory/large_array.h"
#include "src/physics/body.h"
#include "src/physics/clock.h"
#include "src/physics/columns.h"
#include "src/physics/growth.h"
#include "src/physics/ids.h"
#include "src/physics/motion.h"
#include "src/physics/record.h"
#include "src/physics/slides.h"

namespace needlework {

/// All needles. Contacts are pure functions of a pair, which is made here from two records and a
/// shift.
struct Gas {
  LargeArray<Record> records;
  std::vector<Id> ids;
  LargeArray<Shift> images;  ///< total number of boxes by which each centre has been wrapped
  std::unique_ptr<FurtherTouches> further_touches = std::make_unique<FurtherTouches>();
  Clock clock;
  Box box;                     ///< its edges, and which axes are periodic: those without walls
  std::optional<Shear> shear;  ///< if rows of boxes slide
  std::optional<MovingEdges> moving_edges;  ///< if walls with a velocity move edges of the box
  std::optional<Growth> growth;             ///< if bodies grow; sizes below are the largest ones
  Vec3d gravity{};                          ///< acceleration of all needles [L / time^2]
  bool falls = false;                       ///< gravity is not 0
  Vec3d pull{};                        ///< gravity along periodic axes, where it has no potential
  Columns columns;                     ///< what effects keep for each needle
  Composition composition;             ///< indexed by Record::species
  LargeArray<BodyNumbers> own_bodies;  ///< of each needle; empty where those of a species are alike
  double longest = 1;              ///< largest extent of a body, with departures from flights [L]
  std::unique_ptr<Slides> slides;  ///< null where needles do not slide on each other
  /// How far apart two axes in contact may be by the flights of their records, the largest diameter
  /// of rods left out. [L]
  double margin = 0;
  /// State::peculiar_x of each needle at the time of its record; null where nobody observes it. [L]
  Column<double>* peculiar_x = nullptr;

  std::size_t size() const { return records.size(); }
  void set_clock(const Clock& its_clock) {
    clock = its_clock;
    if (shear) shear->set_epoch(clock.epoch_length());
  }
  /// The box at a time. Images, and what is wrapped, are those of that time. As double, it is for
  /// searches, which have room for a slide that is rounded.
  template <class Real = DoubleDouble>
  Box box_at(Time now) const {
    return shear ? box.with_rows(shear->at<Real>(now.epoch, now.offset)) : box;
  }
  /// The distances of the edges at a time: those of the box, but where walls move them. Images,
  /// cells and what is wrapped know nothing of that, as there are none along such an axis.
  Vector edges_at(Time now) const {
    return moving_edges ? moving_edges->distances(clock.exact_difference(now, {})) : box.edges();
  }
  /// Where the low edges are. [L]
  Vector low_at(Time now) const {
    return moving_edges ? moving_edges->low(clock.exact_difference(now, {})) : Vector{};
  }
  /// Present sizes as a share of those of this gas.
  double scale_at(Time now) const { return growth ? growth->scale_at(clock, now) : 1; }
  double volume_at(Time now) const {
    const Vector edges = edges_at(now);
    return edges[0] * edges[1] * edges[2];
  }
  /// The mean of a product of edges from the start to a time.
  template <class Product>
  double mean_of_edges(Time now, const Product& product) const {
    return moving_edges ? moving_edges->mean(clock.since_start(now), product)
                        : product(box.edges());
  }
  /// How fast the image of a needle flies past it. [L / time]
  Vec3d image_velocity(const Shift& shift) const {
    return {shear ? shear->velocity() * shift[1] : 0, 0, 0};
  }
  /// The velocity of the uniform flow at a place. [L / time]
  Vec3d flow_at(const Vec3d& centre) const { return {shear ? shear->rate() * centre.y : 0, 0, 0}; }
  /// The integral of needle i's velocity beside the flow, along x, from its record to `now`. [L]
  double way_beside_flow(Needle i, Time now) const {
    const double elapsed = clock.difference(now, records[i].time);
    const Vec3d c = records[i].flight.v - flow_at(records[i].flight.r);
    return elapsed * (c.x - 0.5 * elapsed * (shear->rate() * c.y));
  }
  /// Number density at the start [L^-3].
  double density() const { return static_cast<double>(size()) / box.volume(); }

  void set_composition(Composition its_composition);
  /// Lets needles slide on each other. To be called after set_composition().
  void let_slide();
  /// Length, mass and inertia of needle i. Whether those of a species have the same is known to
  /// this and the next five functions alone.
  Body body(Needle i) const { return has_own_bodies() ? own_body(i) : body_of_species(i); }
  double half_length(Needle i) const {
    return has_own_bodies() ? 0.5 * own_bodies[i].length : body_of_species(i).half_length;
  }
  double radius(Needle i) const {
    return has_own_bodies() ? 0.5 * own_bodies[i].diameter : body_of_species(i).radius;
  }
  /// Body::reach() of needle i. [L]
  double reach(Needle i) const {
    return has_own_bodies() ? own_body(i).reach() : body_of_species(i).reach();
  }
  bool is_fixed(Needle i) const { return composition[records[i].species].fixed; }
  /// Number of needles that move.
  std::size_t moving() const { return size() - composition.fixed(); }
  bool has_own_bodies() const { return !own_bodies.empty(); }
  /// Whether the needles of a species have the mass and the moment of inertia that it has.
  bool bodies_are_of(std::size_t species) const {
    const Species& its = composition[species];
    return !has_own_bodies() && bodies_[species].mass == its.mass &&
           bodies_[species].inertia == its.inertia();
  }
  /// Of all needles that move. [m]
  double mass() const { return total_mass(composition); }
  /// How a needle moves from its record on.
  FreeFlight motion(const Record& record) const {
    return FreeFlight(record.flight, falls ? &gravity : nullptr);
  }
  /// The same from `now` on.
  MotionFrom<FreeFlight> motion_from(const Record& record, Time now) const {
    return {motion(record), clock.difference(now, record.time)};
  }
  /// Where needle i is at `now`, and how it moves, whether or not it slides. The centre is not
  /// wrapped.
  kernels::BodyState present(Needle i, Time now) const { return present(ids[i], records[i], now); }
  kernels::BodyState present(Id id, const Record& record, Time now) const;
  /// Of a place or a velocity what is the same for all images but for whole edges: all of it or,
  /// where rows of boxes slide along x, the rest.
  Vec3d across_flow(const Vec3d& a) const { return {shear ? 0 : a.x, a.y, a.z}; }
  /// The centre moves no faster until the record is replaced; where rows of boxes slide, across the
  /// flow. [L / time]
  double fastest_of(const Record& record) const {
    kernels::Flight across = record.flight;
    across.v = across_flow(across.v);
    const double flight = FreeFlight(across, falls ? &gravity : nullptr)
                              .fastest(0, clock.difference(record.renewal, record.time));
    return slides && record.is_sliding() ? flight + record.first_touch.gap : flight;
  }
  /// Makes room for so many needles, in columns too.
  void resize(std::size_t needles) {
    records.resize(needles);
    ids.resize(needles);
    images.resize(needles);
    columns.resize(needles);
    if (composition.has_own_sizes()) own_bodies.resize(needles);
  }

  /// Largest |f| that can result from rounding two records, including what accumulates in a
  /// sequence of bounces. [L]
  double touch_tolerance() const { return 0x1p-44 * (longest + box.sum_of_edges()); }

  /// Adds a touch to those of needle i's record.
  void add_touch(Needle i, const RecordedTouch& touch);

  /// The later of the times of two records, from which the time of their pair is counted.
  static Time start_of(const Record& a, const Record& b) { return std::max(a.time, b.time); }

 private:
  void look_up_bodies();
  const Body& body_of_species(Needle i) const { return bodies_[records[i].species]; }
  Body own_body(Needle i) const {
    return as_in_this_gas(needlework::body_of(own_bodies[i]), records[i].species);
  }
  Body as_in_this_gas(Body body, std::size_t species) const {
    if (slides) body.departure = most_departure * body.length();
    return composition[species].fixed ? fixed(body) : body;
  }

  std::vector<Body> bodies_ = {needlework::body_of(Species{})};  ///< of each species
};

/// The pair of two records. Needle a has the lower id; `shift` is added to b's centre. The half
/// lengths of the pair are set to those of needles of length 1.
kernels::Pair make_pair(const Gas& gas, Needle a, const Record& record_a, Needle b,
                        const Record& record_b, const Shift& shift);

/// Time at which a record of a needle of this length [L] is renewed, to keep its precision.
inline Time renewal_time(const Gas& gas, const Record& record, double length) {
  return gas.clock.add(record.time, gas.motion(record).lasts(length));
}

/// Most boxes by which the centre of a record has been wrapped along an axis. Files hold up to
/// 2^31 - 1, and until its record is renewed a needle crosses no more than 2^11.
inline constexpr std::int32_t most_boxes = 0x7fffffff - (1 << 11);
/// The number of boxes that a needle has crossed, with those just subtracted. Throws
/// InvalidStateError beyond `most_boxes`, but for those along x where rows slide, which count
/// modulo 2^32.
Shift add_boxes(const Gas& gas, Needle i, const Boxes& boxes);

/// Replaces the record of needle i by a state at `now`: the centre is wrapped into the box, the
/// director is normalised, w is made normal to it unless the body is a sphere, and touches are
/// forgotten. Returns the number of boxes by which the centre was wrapped. Throws
/// InvalidStateError, and changes nothing, if that makes too many; see add_boxes().
Shift renew_record(Gas& gas, Needle i, Time now, const kernels::BodyState& state, const Body& body);
/// What of an angular velocity a body with this director can have: a rod none about its axis, a
/// rough sphere all, a smooth one nothing.
inline Vec3d turned(const Body& body, const Vec3d& w, const Vec3d& director) {
  if (body.has_axis()) return project_out(w, director);
  return body.turns() ? w : Vec3d{};
}
/// Fills in how the director turns by w, which is normal to it; that of a sphere is at rest.
void set_rotation(kernels::Flight& flight, const Body& body);
/// Enters a collision that two needles have just had, which leaves them on this side of each other,
/// into their records; `shift` is that of the records.
void part(Gas& gas, Needle first, Needle second, const Shift& shift, int side);
/// Two needles as bodies that slide on each other.
kernels::SlidingBodies sliding_bodies(const Gas& gas, Needle first, Needle second);

}  // namespace needlework
