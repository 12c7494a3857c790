#include "src/engine/gas_sums.h"

#include <array>
#include <utility>

#include "src/engine/exact_sums.h"
#include "src/physics/mean_free_time.h"

namespace needlework {

namespace {

// Along axes with walls, where there is a potential.
Vec3d weight(const Gas& gas) { return gas.gravity - gas.pull; }

// Where gravity has no component along an axis, the place there does not count.
Vec3d lowest(const Gas& gas) {
  const Vec3d g = weight(gas);
  const auto edge = [&](double along, std::size_t axis) {
    return along > 0 ? gas.box.edge(axis) : 0;
  };
  return {edge(g.x, 0), edge(g.y, 1), edge(g.z, 2)};
}

Needle needle_of(const Gas& gas, const Record& record) {
  return Needle(static_cast<std::size_t>(&record - gas.records.data()));
}

// Calls sum(weight) with a function that gives the weights of records of a species.
template <class Sum>
auto with_weights(const Gas& gas, std::size_t species, const Sum& sum) {
  // To look at each body would cost half as much again as the sums.
  if (gas.bodies_are_of(species)) return sum([](const Record&) { return Weight{}; });
  return sum([&gas](const Record& a) { return weight_of(gas, needle_of(gas, a)); });
}

// SumsOfSquares::height and pulled of a species.
std::array<double, 2> falls_of(const Gas& gas, Time now, std::size_t species, int threads) {
  if (!gas.falls) return {};
  const Vec3d g = weight(gas), low = lowest(gas);
  const auto [height, pulled] = with_weights(gas, species, [&](const auto& weight_of_record) {
    return exact_sums(gas.records, threads, [&](const Record& a) {
      if (a.species != species) return std::array{0.0, 0.0};
      const Needle i = needle_of(gas, a);
      const Vec3d centre = gas.slides ? gas.present(i, now).r : gas.motion_from(a, now).centre();
      const Vec3d way = centre + gas.box_at(now).image(gas.images[i]).place;
      const double mass = weight_of_record(a).mass;
      return std::array{mass * dot(g, low - centre), mass * dot(gas.pull, way)};
    });
  });
  return {height, pulled};
}

struct Velocities {
  Vec3d v, w;
};
struct VelocitiesOfRecord {
  const Vec3d &v, &w;
};

// Calls sum(velocities_of) with a function that gives the present velocities of a record; in a
// uniform flow, beside it.
template <class Sum>
auto with_velocities(const Gas& gas, Time now, const Sum& sum) {
  if (gas.slides) {
    return sum([&](const Record& a) {
      const kernels::BodyState present = gas.present(needle_of(gas, a), now);
      return Velocities{present.v, present.w};
    });
  }
  if (gas.shear) {
    return sum([&](const Record& a) {
      const auto motion = gas.motion_from(a, now);
      return Velocities{motion.velocity() - gas.flow_at(motion.centre()), a.flight.w};
    });
  }
  if (gas.falls) {
    return sum([&](const Record& a) {
      return Velocities{gas.motion_from(a, now).velocity(), a.flight.w};
    });
  }
  return sum([](const Record& a) { return VelocitiesOfRecord{a.flight.v, a.flight.w}; });
}

// The present velocities of a record, and its weight.
template <class VelocitiesOf, class WeightOf>
struct MotionOf {
  const VelocitiesOf& velocities;
  const WeightOf& weight;
};

// Calls sum(of) with what gives both of the records of a species.
template <class Sum>
auto with_motion(const Gas& gas, Time now, std::size_t species, const Sum& sum) {
  return with_velocities(gas, now, [&]<class VelocitiesOf>(const VelocitiesOf& velocities_of) {
    return with_weights(gas, species, [&]<class WeightOf>(const WeightOf& weight_of) {
      return sum(MotionOf<VelocitiesOf, WeightOf>{velocities_of, weight_of});
    });
  });
}

}  // namespace

Weight weight_of(const Gas& gas, Needle i) {
  const Body body = gas.body(i);
  const Species& species = gas.composition[gas.records[i].species];
  return {.mass = body.mass / species.mass,
          .inertia = body.turns() ? body.inertia / species.inertia() : 1};
}

std::vector<SumsOfSquares> sums_of_squares(const Gas& gas, Time now, int threads) {
  std::vector<SumsOfSquares> out(gas.composition.size());
  if (gas.size() == 0) return out;
  for (std::size_t species = 0; species < out.size(); ++species) {
    if (gas.composition[species].fixed) continue;
    const auto [v2, w2] = with_motion(gas, now, species, [&](const auto& of) {
      return exact_sums(gas.records, threads, [&](const Record& a) {
        if (a.species != species) return std::array{0.0, 0.0};
        const auto [v, w] = of.velocities(a);
        const auto [mass, inertia] = of.weight(a);
        return std::array{mass * dot(v, v), inertia * dot(w, w)};
      });
    });
    const auto [height, pulled] = falls_of(gas, now, species, threads);
    out[species] = {v2, w2, height, pulled};
  }
  return out;
}

FlightCarries flight_carries(const Gas& gas, Needle i, Time now) {
  const Record& record = gas.records[i];
  const Vec3d c = record.flight.v - gas.flow_at(record.flight.r);
  // The flow is faster where a needle gets to.
  Vec3d gain = gas.gravity;
  if (gas.shear) gain.x -= gas.shear->rate() * c.y;
  return {gas.is_fixed(i) ? 0 : gas.body(i).mass,
          carried(c, gain, gas.clock.difference(now, record.time))};
}

Tensor carried_in_flights(const Gas& gas, Time now, int threads) {
  const auto sums = exact_sums(gas.records, threads, [&](const Record& record) {
    const auto [mass, cc] = flight_carries(gas, needle_of(gas, record), now);
    return std::array{mass * cc[0][0], mass * cc[0][1], mass * cc[0][2],
                      mass * cc[1][1], mass * cc[1][2], mass * cc[2][2]};
  });
  return {{{sums[0], sums[1], sums[2]}, {sums[1], sums[3], sums[4]}, {sums[2], sums[4], sums[5]}}};
}

double work_of_flow_in_flights(const Gas& gas, Time now, int threads) {
  const auto [carried] = exact_sums(gas.records, threads, [&](const Record& record) {
    const auto [mass, cc] = flight_carries(gas, needle_of(gas, record), now);
    return std::array{mass * cc[0][1]};
  });
  return -gas.shear->rate() * carried;
}

std::vector<SpeciesTotals> species_totals(const Gas& gas, const std::vector<SumsOfSquares>& sums) {
  std::vector<SpeciesTotals> out;
  for (std::size_t index = 0; index < sums.size(); ++index) {
    const Species& species = gas.composition[index];
    SpeciesTotals& of = out.emplace_back();
    of.count = species.count;
    if (of.count == 0 || species.fixed) continue;
    const double count = static_cast<double>(species.count);
    of.t_tr = species.mass * sums[index].v2 / (3 * count);
    if (species.has_axis())
      of.t_rot = species.mass * (species.length * species.length) * sums[index].w2 /
                 (4 * species.k * count);
    else if (species.turns())
      of.t_rot = species.inertia() * sums[index].w2 / (3 * count);
  }
  return out;
}

namespace {

// Means over all needles that move; T_rot over their rotational degrees of freedom. Fixed ones have
// temperatures of 0.
void set_temperatures(const Gas& gas, const std::vector<SumsOfSquares>& sums, Totals& out) {
  if (gas.moving() == 0) return;
  out.t_tr = out.t_rot = 0;
  const std::vector<SpeciesTotals> totals = species_totals(gas, sums);
  for (std::size_t index = 0; index < totals.size(); ++index) {
    const SpeciesTotals& of = totals[index];
    const double share = static_cast<double>(of.count) / static_cast<double>(gas.moving());
    out.t_tr += share * of.t_tr;
    out.t_rot += 0.5 * gas.composition[index].rotations() * (share * of.t_rot);
  }
  const double turning = gas.composition.turning_share();
  if (turning > 0) out.t_rot /= turning;
  out.energy = 1.5 * out.t_tr + turning * out.t_rot;
}

double potential_of(const Gas& gas, const std::vector<SumsOfSquares>& sums) {
  double out = 0;
  for (std::size_t index = 0; index < sums.size(); ++index) {
    out += gas.composition[index].mass * sums[index].height;
  }
  return out;
}

}  // namespace

double translational_temperature(const Gas& gas, const std::vector<SumsOfSquares>& sums) {
  Totals totals;
  set_temperatures(gas, sums, totals);
  return totals.t_tr;
}

double energy_of_motion(const Gas& gas, const std::vector<SumsOfSquares>& sums) {
  Totals totals;
  set_temperatures(gas, sums, totals);
  return totals.energy * static_cast<double>(gas.moving());
}

double energy_of(const Gas& gas, const std::vector<SumsOfSquares>& sums) {
  const double motion = energy_of_motion(gas, sums);
  return gas.falls ? motion + potential_of(gas, sums) : motion;
}

double energy_of_low_edges(const Gas& gas) { return gas.mass() * dot(weight(gas), lowest(gas)); }

double work_of_pull(const Gas& gas, const std::vector<SumsOfSquares>& sums) {
  double out = 0;
  for (std::size_t index = 0; index < sums.size(); ++index) {
    out += gas.composition[index].mass * sums[index].pulled;
  }
  return out;
}

Totals totals_of(const Gas& gas, Time now, int threads) {
  Totals out;
  if (gas.size() == 0) return out;
  std::vector<SumsOfSquares> sums;
  for (std::size_t species = 0; species < gas.composition.size(); ++species) {
    if (gas.composition[species].fixed) {
      sums.emplace_back();
      continue;
    }
    // All at once: reading the records takes most of the time.
    const auto [v2, w2, x, y, z] = with_motion(gas, now, species, [&](const auto& of) {
      return exact_sums(gas.records, threads, [&](const Record& a) {
        if (a.species != species) return std::array<double, 5>{};
        const auto [v, w] = of.velocities(a);
        const auto [mass, inertia] = of.weight(a);
        return std::array{mass * dot(v, v), inertia * dot(w, w), mass * v.x, mass * v.y,
                          mass * v.z};
      });
    });
    const auto [height, pulled] = falls_of(gas, now, species, threads);
    sums.push_back({v2, w2, height, pulled});
    const double mass = gas.composition[species].mass;
    for (const auto& [axis, sum] : {std::pair(0, x), std::pair(1, y), std::pair(2, z)}) {
      out.momentum[axis] += mass * sum;
    }
  }
  set_temperatures(gas, sums, out);
  if (gas.falls) {
    const double energy = potential_of(gas, sums) - energy_of_low_edges(gas);
    out.energy += energy / static_cast<double>(gas.moving());
  }
  return out;
}

double mean_free_time_of(const Gas& gas, const std::vector<SumsOfSquares>& sums, Time now) {
  const double volume = gas.volume_at(now);
  std::vector<SpeciesTemperatures> temperatures;
  for (const SpeciesTotals& of : species_totals(gas, sums)) {
    temperatures.push_back({of.t_tr, of.t_rot});
  }
  const std::optional<std::size_t> only = gas.composition.only();
  if (!only || gas.composition.has_width() || !gas.composition.all_meet()) {
    return mean_free_time(gas.composition, volume, temperatures);
  }
  const Species& species = gas.composition[*only];
  return mean_free_time({.density = static_cast<double>(gas.size()) / volume,
                         .t_tr = temperatures[*only].t_tr,
                         .t_rot = temperatures[*only].t_rot,
                         .length = species.length,
                         .mass = species.mass,
                         .k = species.k});
}

GasNumbers numbers_of(const Gas& gas, const std::vector<SumsOfSquares>& sums, bool moves) {
  GasNumbers out{.count = static_cast<double>(gas.moving()), .species = {}, .moves = moves};
  for (std::size_t index = 0; index < sums.size(); ++index) {
    const Species& species = gas.composition[index];
    if (species.fixed) continue;
    out.species.push_back({.mass = species.mass,
                           .inertia = species.inertia(),
                           .v2 = sums[index].v2,
                           .w2 = sums[index].w2,
                           .extent = species.extent()});
  }
  return out;
}

}  // namespace needlework
