#include "tests/support/rod_families.h"

#include <algorithm>
#include <cmath>
#include <ostream>

#include "src/physics/director.h"
#include "tests/support/random.h"

namespace needlework::test {
namespace {

Vec3d rod_direction(Random& random) {
  const Vec<double> a = random.direction();
  return {a[0], a[1], a[2]};
}
Vec3d rod_normal(Random& random, double sigma) {
  const Vec<double> a = random.normal_vector(sigma);
  return {a[0], a[1], a[2]};
}
Vec3d across(Random& random, const Vec3d& u) {
  return normalised(project_out(rod_direction(random), u));
}
double sign(Random& random) { return random.coin() ? 1 : -1; }
double power_of_ten(Random& random, double low, double high) {
  return std::exp(std::log(10.0) * random.uniform(low, high));
}

// The rod before a time, or after it.
void fly(kernels::Flight& rod, double time) {
  rod.r = centre_after(rod, time);
  rod.u = normalised(director_after(rod, time));
  rod.w = project_out(rod.w, rod.u);
  set_rotation(rod);
}

struct Drawing {
  Random& random;
  RodCase out;
  double scale = 1;  // of both rods, about

  explicit Drawing(Random& r) : random(r) {}

  void shape(double least = -2, double most = 5) {
    const double aspect = random.below(3) == 0 ? 5 : power_of_ten(random, least, most);
    const double diameter = aspect > 1 ? 1 / aspect : 1;
    const double length = diameter * aspect;
    out.pair.half_first = 0.5 * length;
    out.pair.half_second = random.coin() ? 0.5 * length : 0.5 * length * random.uniform(0, 1);
    out.pair.distance = diameter * random.uniform(0.8, 1.2);
    out.pair.touch_within = 0x1p-44 * 20;
    scale = out.pair.half_first + out.pair.half_second + out.pair.distance;
  }
  double half(int i) const { return i == 0 ? out.pair.half_first : out.pair.half_second; }

  void move(double rotation = 1) {
    kernels::Flight* rods[2] = {&out.first, &out.second};
    for (int i = 0; i < 2; ++i) {
      rods[i]->v = rod_normal(random, 1);
      const double size = half(i) > 0 ? rotation * 2 / std::max(half(i), 0.05 * scale) : 0;
      rods[i]->w = project_out(rod_normal(random, size), rods[i]->u);
      set_rotation(*rods[i]);
    }
    out.horizon = 3 * scale;
  }
  void direct() {
    out.first.u = rod_direction(random);
    out.second.u = rod_direction(random);
  }
  void direct(double angle) {
    out.first.u = rod_direction(random);
    const Vec3d e = across(random, out.first.u);
    out.second.u = normalised((out.first.u * std::cos(angle) + e * std::sin(angle)) * sign(random));
  }

  // At a contact, with the normal n and arms for which these points are nearest.
  void place(const Vec3d& n, double s12, double s21) {
    out.first.r = rod_normal(random, scale);
    out.second.r = out.first.r + (out.first.u * s12 - out.second.u * s21) - n * out.pair.distance;
    arms[0] = s12;
    arms[1] = s21;
    normal = n;
  }
  double inside(int i) { return half(i) * random.uniform(-1, 1); }
  void touch_faces() {
    const Vec3d x = cross(out.first.u, out.second.u);
    place(normalised(x) * sign(random), inside(0), inside(1));
  }
  // `off`, so far from the tip.
  void touch_side() {
    const Vec3d n = across(random, out.second.u);
    place(n, dot(n, out.first.u) < 0 ? half(0) : -half(0), inside(1));
  }
  void touch_tips() {
    const Vec3d n = rod_direction(random);
    place(n, dot(n, out.first.u) < 0 ? half(0) : -half(0),
          dot(n, out.second.u) > 0 ? half(1) : -half(1));
  }
  void touch_any() {
    const int kind = random.below(3);
    kind == 0 ? touch_faces() : kind == 1 ? touch_side() : touch_tips();
  }
  double normal_velocity() const {
    return dot(normal,
               (out.first.v - out.second.v) + (cross(out.first.w, out.first.u) * arms[0] -
                                               cross(out.second.w, out.second.u) * arms[1]));
  }
  void turn_velocities(double wanted) {
    if (normal_velocity() * wanted > 0) return;
    for (kernels::Flight* rod : {&out.first, &out.second}) {
      rod->v = -rod->v;
      rod->w = -rod->w;
      set_rotation(*rod);
    }
  }
  // Moves both back from a contact at which they approach.
  void back(double time) {
    turn_velocities(-1);
    fly(out.first, -time);
    fly(out.second, -time);
    out.horizon = 2 * time + scale;
  }
  void collided() {
    turn_velocities(1);
    out.pair.touch = {.touching = true, .collided = true, .side = 1, .gap = 0};
  }
  bool is_apart() const {
    const RodMotion<long double> motion(out);
    const long double above = motion.distance(0) - out.pair.distance * (1 + 1e-9L);
    if (std::abs(above) > 1e-15L * (motion.reach + scale)) return above > 0;
    return rod_distance(out, 0) > Quad(out.pair.distance) * (1 + Quad(1e-9));
  }
  double time() { return scale * power_of_ten(random, -3, 0); }

  Vec3d normal;
  double arms[2] = {0, 0};
};

// Again and again, until the rods are apart.
template <class Draw>
RodCase until_apart(Random& random, const Draw& draw) {
  for (;;) {
    Drawing d(random);
    draw(d);
    if (d.is_apart()) return d.out;
  }
}

RodCase any_rods(Random& random) {
  return until_apart(random, [&](Drawing& d) {
    d.shape();
    d.direct();
    d.out.first.r = rod_normal(random, d.scale);
    d.out.second.r = d.out.first.r + rod_normal(random, 0.6 * d.scale);
    d.move();
  });
}

RodCase contact_of_rods(Random& random) {
  return until_apart(random, [&](Drawing& d) {
    d.shape();
    d.direct();
    d.touch_any();
    d.move();
    d.back(d.time());
  });
}

RodCase parallel_rods(Random& random) {
  return until_apart(random, [&](Drawing& d) {
    d.shape();
    d.direct(power_of_ten(random, -12, -2));
    d.touch_any();
    d.move();
    d.back(d.time() * (random.coin() ? 1e-3 : 1));
  });
}

RodCase exactly_parallel_rods(Random& random) {
  return until_apart(random, [&](Drawing& d) {
    d.shape();
    d.out.first.u = rod_direction(random);
    d.out.second.u = d.out.first.u * sign(random);
    d.place(across(random, d.out.first.u), d.inside(0), d.inside(1));
    d.move(random.coin() ? 1 : 0);
    if (random.coin()) {
      d.out.second.w = d.out.first.w;
      set_rotation(d.out.second);
    }
    d.turn_velocities(-1);
    const double t = d.time();
    d.out.first.r = centre_after(d.out.first, -t);
    d.out.second.r = centre_after(d.out.second, -t);
  });
}

RodCase collinear_rods(Random& random) {
  return until_apart(random, [&](Drawing& d) {
    d.shape();
    d.out.first.u = rod_direction(random);
    d.out.second.u = d.out.first.u * sign(random);
    d.place(d.out.first.u, -d.half(0), dot(d.out.first.u, d.out.second.u) * d.half(1));
    d.move(random.coin() ? 1 : 0);
    d.turn_velocities(-1);
    const double t = d.time();
    d.out.first.r = centre_after(d.out.first, -t);
    d.out.second.r = centre_after(d.out.second, -t);
  });
}

RodCase grazing_rods(Random& random) {
  for (;;) {
    Drawing d(random);
    d.shape(-2, 2);
    d.direct();
    d.touch_any();
    d.move();
    d.back(d.time());
    // A minimum of the distance, by sampling and golden sections.
    const int steps = 64;
    const RodMotion<double> motion(d.out);
    double best = -1, least = 1e300;
    for (int n = 1; n < steps; ++n) {
      const double s = d.out.horizon * n / steps, at = motion.distance(s);
      if (at < least) least = at, best = s;
    }
    double low = best - d.out.horizon / steps, high = best + d.out.horizon / steps;
    for (int i = 0; i < 40; ++i) {
      const double p = high - (high - low) * 0.6180339887498949,
                   q = low + (high - low) * 0.6180339887498949;
      const bool is_before = motion.distance(p) < motion.distance(q);
      (is_before ? high : low) = is_before ? q : p;
    }
    const double minimum = motion.distance((low + high) / 2);
    if (!(minimum > 0.01 * d.scale)) continue;
    d.out.pair.distance = minimum * (1 + sign(random) * power_of_ten(random, -5.5, -2));
    if (d.is_apart()) return d.out;
  }
}

RodCase tip_of_rods(Random& random) {
  return until_apart(random, [&](Drawing& d) {
    d.shape();
    d.direct();
    const double off = power_of_ten(random, -15, -2);
    if (random.coin()) {
      const Vec3d x = cross(d.out.first.u, d.out.second.u);
      d.place(normalised(x) * sign(random), d.half(0) * (1 - off) * sign(random),
              random.coin() ? d.inside(1) : d.half(1) * (1 - off) * sign(random));
    } else {
      // Nearly normal to the side, or beyond the tip of it.
      const Vec3d n = normalised(across(random, d.out.second.u) + d.out.second.u * off);
      d.place(n, dot(n, d.out.first.u) < 0 ? d.half(0) : -d.half(0), d.half(1));
    }
    d.move();
    d.back(d.time());
  });
}

RodCase just_collided_rods(Random& random) {
  Drawing d(random);
  d.shape();
  d.direct();
  d.touch_any();
  d.move(random.coin() ? 1 : 10);
  d.collided();
  return d.out;
}

RodCase just_collided_parallel_rods(Random& random) {
  Drawing d(random);
  d.shape(0, 2);
  d.direct(power_of_ten(random, -9, -2));
  d.touch_faces();
  d.move(random.coin() ? 1 : 10);
  d.collided();
  return d.out;
}

RodCase spheres(Random& random) {
  return until_apart(random, [&](Drawing& d) {
    d.shape();
    d.out.pair.half_first = d.out.pair.half_second = 0;
    d.scale = d.out.pair.distance;
    d.direct();
    d.touch_tips();
    d.move();
    if (random.coin()) {
      d.back(d.time());
    } else {
      d.out.first.r = d.out.first.r + rod_normal(random, d.scale);
    }
  });
}

RodCase sphere_and_rod(Random& random) {
  return until_apart(random, [&](Drawing& d) {
    d.shape();
    (random.coin() ? d.out.pair.half_first : d.out.pair.half_second) = 0;
    d.direct();
    d.touch_any();
    d.move();
    d.back(d.time());
  });
}

// Of lengths from 1 : 1 to 1 : 1e4.
RodCase unequal_rods(Random& random) {
  return until_apart(random, [&](Drawing& d) {
    d.shape();
    (random.coin() ? d.out.pair.half_first : d.out.pair.half_second) *= power_of_ten(random, -4, 0);
    d.direct();
    d.touch_any();
    d.move();
    d.back(d.time());
  });
}

// A thin needle, and a sphere that does not move, of a radius from 1e-3 to 30 needle lengths.
RodCase needle_and_fixed_sphere(Random& random) {
  return until_apart(random, [&](Drawing& d) {
    d.out.pair.half_first = 0.5;
    d.out.pair.half_second = 0;
    d.out.pair.distance = power_of_ten(random, -3, 1.5);
    d.out.pair.touch_within = 0x1p-44 * 20;
    d.scale = 0.5 + d.out.pair.distance;
    d.direct();
    d.touch_any();
    d.move();
    d.out.second.v = d.out.second.w = {};
    set_rotation(d.out.second);
    d.back(std::min(1.0, d.scale) * power_of_ten(random, -3, 0));
    if (random.coin()) d.out = d.out.exchanged();
  });
}

RodCase just_collided_spheres(Random& random) {
  Drawing d(random);
  d.shape();
  d.out.pair.half_first = d.out.pair.half_second = 0;
  d.scale = d.out.pair.distance;
  d.direct();
  d.touch_tips();
  d.move();
  d.collided();
  return d.out;
}

RodCase fast_rods(Random& random) {
  return until_apart(random, [&](Drawing& d) {
    d.shape();
    d.direct();
    d.touch_any();
    d.move(power_of_ten(random, 2, 4));
    d.back(d.time() * 1e-2);
    d.out.horizon = std::min(d.out.horizon, 300 / (d.out.first.omega + d.out.second.omega));
  });
}

RodCase still_rods(Random& random) {
  return until_apart(random, [&](Drawing& d) {
    d.shape();
    d.direct();
    d.touch_any();
    d.move();
    d.out.first.w = {};
    set_rotation(d.out.first);
    if (random.coin()) d.out.second.w = {};
    set_rotation(d.out.second);
    d.back(d.time());
  });
}

RodCase rods_of_unlike_records(Random& random) {
  return until_apart(random, [&](Drawing& d) {
    d.shape();
    d.direct();
    d.touch_any();
    d.move();
    d.back(d.time());
    const double box = 10 * d.scale;
    d.out.pair.shift = {box, -box, 0.0};
    d.out.second.r = d.out.second.r - Vec3d{box, -box, 0};
    const double ago = 20 * d.scale * random.uniform();
    const bool first = random.coin();
    kernels::Flight& rod = first ? d.out.first : d.out.second;
    fly(rod, -ago);
    const DoubleDouble elapsed{ago, 0x1p-55 * ago};
    (first ? d.out.pair.elapsed_first : d.out.pair.elapsed_second) = elapsed;
    if (random.coin()) {
      const Vec3dd gain = to_double_double(rod_normal(random, 0.5 / d.scale)) * elapsed;
      const Vec3dd place = gain * (elapsed * DoubleDouble(0.5));
      rod.v = rod.v - to_double(gain);
      rod.r = rod.r + to_double(place);
      d.out.pair.fall = first ? kernels::Fall{gain, place} : kernels::Fall{-gain, -place};
    }
  });
}

RodCase far_rods(Random& random) {
  return until_apart(random, [&](Drawing& d) {
    d.shape(-2, 2);
    d.direct();
    d.touch_any();
    d.move(random.uniform());
    d.back(d.scale * power_of_ten(random, 2, 4));
  });
}

RodCase slow_rods(Random& random) {
  RodCase out = contact_of_rods(random);
  for (kernels::Flight* rod : {&out.first, &out.second}) {
    rod->v = rod->v * 0x1p-300;
    rod->w = rod->w * 0x1p-300;
    set_rotation(*rod);
  }
  out.horizon *= 0x1p300;
  return out;
}

// By up to a few of their sizes until the horizon, so that they may grow faster than they part.
RodCase that_grow(Random& random, RodCase rods) {
  rods.pair.growth = power_of_ten(random, -4, 0.5) / rods.horizon;
  return rods;
}

RodCase growing_rods(Random& random) {
  constexpr RodCase (*draws[])(Random&) = {any_rods,    contact_of_rods, parallel_rods,
                                           tip_of_rods, collinear_rods,  unequal_rods,
                                           still_rods,  sphere_and_rod,  rods_of_unlike_records,
                                           slow_rods};
  return that_grow(random, draws[random.below(std::size(draws))](random));
}

RodCase growing_spheres(Random& random) { return that_grow(random, spheres(random)); }

RodCase growing_collided(Random& random) {
  return that_grow(random,
                   random.coin() ? just_collided_spheres(random) : just_collided_rods(random));
}

}  // namespace

const std::vector<RodFamily>& rod_families() {
  static const std::vector<RodFamily> all = {
      {"any", any_rods},
      {"contact", contact_of_rods},
      {"parallel", parallel_rods},
      {"exactly_parallel", exactly_parallel_rods},
      {"collinear", collinear_rods},
      {"grazing", grazing_rods},
      {"tip", tip_of_rods},
      {"just_collided", just_collided_rods},
      {"just_collided_parallel", just_collided_parallel_rods},
      {"spheres", spheres},
      {"sphere_and_rod", sphere_and_rod},
      {"unequal", unequal_rods},
      {"needle_and_fixed_sphere", needle_and_fixed_sphere},
      {"just_collided_spheres", just_collided_spheres},
      {"fast", fast_rods},
      {"still", still_rods},
      {"records", rods_of_unlike_records},
      {"far", far_rods},
      {"slow", slow_rods},
      {"growing", growing_rods},
      {"growing_spheres", growing_spheres},
      {"growing_collided", growing_collided}};
  return all;
}

}  // namespace needlework::test
