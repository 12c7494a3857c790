#include "tests/support/reference_gas.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "needlework/predict.h"
#include "src/physics/collision.h"
#include "src/physics/director.h"
#include "tests/support/kernel_pair.h"

namespace needlework::test {
namespace {

/// Length of time in which contacts are searched at once [time].
constexpr double span = 0.25;
/// Distance at which the search continues after a contact that was skipped [time].
constexpr double past = 1e-9;

struct Body {
  double time = 0;
  kernels::Flight flight;
};

struct Next {
  double time = std::numeric_limits<double>::infinity();
  std::size_t i = 0, j = 0;
  std::array<std::int32_t, 3> shift{};
  bool is_return = false;
};

class ReferenceGas {
 public:
  ReferenceGas(const Scene& scene, const Fault& fault) : scene_(scene), fault_(fault) {
    run_.initial = Simulation(scene).copy();
    const State& state = run_.initial;
    for (std::size_t i = 0; i < state.size(); ++i) {
      bodies_.push_back(
          {0, test::flight(vec3(state.position[i]), vec3(state.orientation[i]),
                           vec3(state.velocity[i]), vec3(state.angular_velocity[i]))});
    }
  }

  ReferenceRun run(int collisions) {
    double now = 0;
    while (static_cast<int>(run_.collisions.size()) < collisions) {
      const Next next = find(now, now + span);
      if (!std::isfinite(next.time)) {
        now += span;
        continue;
      }
      now = std::max(now, next.time);
      take(next, now);
    }
    run_.end = now;
    return std::move(run_);
  }

 private:
  using Key = std::pair<std::size_t, std::size_t>;

  bool is_due(Fault::Kind kind) {
    if (fault_.kind != kind || ++occasions_ % fault_.every != 0) return false;
    ++run_.planted;
    return true;
  }

  void take(const Next& next, double& now) {
    const Key key{next.i, next.j};
    if (is_due(Fault::drop) || (next.is_return && is_due(Fault::blind))) {
      passed_[key] = next.time + past;
      return;
    }
    if (is_due(Fault::delay)) now = next.time + fault_.amount;
    collide(next, now, is_due(Fault::restitution) ? 1 + fault_.amount : 1);
    if (is_due(Fault::repeat)) collide(next, now += std::ldexp(1.0, -40), 1);
  }

  FreeNeedle at(const Body& body, double time) const {
    const double elapsed = time - body.time;
    const auto array = [](const Vec3d& a) { return std::array{a.x, a.y, a.z}; };
    const kernels::Flight& flight = body.flight;
    const Vec3d u = elapsed == 0 ? flight.u : director_after(flight, elapsed);
    return {array(centre_after(flight, elapsed)), array(u), array(flight.v), array(flight.w)};
  }

  Next find(double now, double until) {
    Next best;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      for (std::size_t j = i + 1; j < bodies_.size(); ++j) look(i, j, now, until, best);
    }
    return best;
  }

  void look(std::size_t i, std::size_t j, double now, double until, Next& best) {
    const auto passed = passed_.find({i, j});
    double begin = std::max(bodies_[i].time, bodies_[j].time);
    const bool after_collision = begin == bodies_[i].time && begin == bodies_[j].time &&
                                 last_.contains({i, j}) && last_[{i, j}] == begin && begin > 0;
    bool just_collided = after_collision;
    if (passed != passed_.end() && passed->second > begin) {
      begin = passed->second;
      just_collided = false;
    }
    if (begin >= until) return;
    const FreeNeedle first = at(bodies_[i], begin), second = at(bodies_[j], begin);
    const auto touching = nearest(first, second);
    const auto centre = nearest(at(bodies_[i], now), at(bodies_[j], now));
    for (int x = -1; x <= 1; ++x) {
      for (int y = -1; y <= 1; ++y) {
        for (int z = -1; z <= 1; ++z) {
          const std::array<std::int32_t, 3> shift{centre[0] + x, centre[1] + y, centre[2] + z};
          // Both needles moved to where rounding is smallest.
          FreeNeedle near = first, image = second;
          for (int axis = 0; axis < 3; ++axis) {
            const DoubleDouble boxes = two_prod(shift[axis], scene_.needles.box[axis]);
            const DoubleDouble apart = two_sum(first.position[axis], -second.position[axis]);
            near.position[axis] = to_double(apart - boxes);
            image.position[axis] = 0;
          }
          const bool same = shift == touching;
          const FirstContact contact = predict(near, image, until - begin, just_collided && same);
          const double time = begin + contact.time;
          if (time < best.time && time >= now - 1e-12) {
            best = {time, i, j, shift, just_collided && same};
          }
        }
      }
    }
  }

  // Number of boxes to add to the second needle's centre for its image nearest to the first.
  std::array<std::int32_t, 3> nearest(const FreeNeedle& first, const FreeNeedle& second) const {
    std::array<std::int32_t, 3> shift;
    for (int axis = 0; axis < 3; ++axis) {
      const double apart = first.position[axis] - second.position[axis];
      shift[axis] = static_cast<std::int32_t>(std::round(apart / scene_.needles.box[axis]));
    }
    return shift;
  }

  void collide(const Next& next, double now, double factor) {
    Body &a = bodies_[next.i], &b = bodies_[next.j];
    KernelPair pair;
    pair.first = a.flight;
    pair.second = b.flight;
    const double begin = std::max(a.time, b.time);
    pair.elapsed_first = DoubleDouble(begin - a.time);
    pair.elapsed_second = DoubleDouble(begin - b.time);
    const auto boxes = [&](int axis) {
      return two_prod(next.shift[axis], scene_.needles.box[axis]);
    };
    pair.shift = {boxes(0), boxes(1), boxes(2)};
    const auto contact =
        kernels::contact_geometry(pair.view(), DoubleDouble(now) - DoubleDouble(begin));
    const Vec3d v =
        (a.flight.v - b.flight.v) + (cross(a.flight.w, contact.u_first) * contact.arm_first -
                                     cross(b.flight.w, contact.u_second) * contact.arm_second);
    const int side = dot(v, contact.normal) > 0 ? -1 : 1;
    const Restitution restitution{factor * (1 + scene_.collisions.epsilon) - 1,
                                  scene_.collisions.beta};
    const needlework::Body body =
        body_of(Species{.name = {}, .length = 1, .mass = 1, .k = scene_.needles.k});
    const Impact impact = needlework::collide<Surface::rough>(
        {a.flight.v, a.flight.w, b.flight.v, b.flight.w, body, body, contact, side}, restitution);
    Collision report;
    report.epoch = static_cast<std::int64_t>(std::floor(now / reference_epoch));
    report.offset = now - static_cast<double>(report.epoch) * reference_epoch;
    report.time = now;
    report.first = static_cast<std::uint32_t>(next.i);
    report.second = static_cast<std::uint32_t>(next.j);
    report.arm_first = contact.arm_first;
    report.arm_second = contact.arm_second;
    report.sin_angle = contact.sin_angle;
    report.normal_velocity = impact.normal_velocity;
    report.impulse = {impact.impulse.x, impact.impulse.y, impact.impulse.z};
    report.energy_change = impact.energy_change;
    report.shift = next.shift;
    renew(a, now, contact.u_first, impact.v_first, impact.w_first);
    renew(b, now, contact.u_second, impact.v_second, impact.w_second);
    report.after = {after(a), after(b)};
    run_.collisions.push_back(report);
    last_[{next.i, next.j}] = now;
  }

  void renew(Body& body, double now, const Vec3d& u, const Vec3d& v, const Vec3d& w) const {
    const Vec3d centre = centre_after(body.flight, now - body.time);
    std::array<double, 3> r{centre.x, centre.y, centre.z};
    for (int axis = 0; axis < 3; ++axis) {
      const double box = scene_.needles.box[axis];
      r[axis] = to_double(DoubleDouble(r[axis]) - two_prod(std::floor(r[axis] / box), box));
    }
    body = {now, test::flight(vec3(r), u, v, w)};
  }

  StateAfterCollision after(const Body& body) const {
    const FreeNeedle needle = at(body, body.time);
    return {needle.position, needle.velocity, needle.orientation, needle.angular_velocity};
  }

  const Scene& scene_;
  Fault fault_;
  std::vector<Body> bodies_;
  std::map<Key, double> last_;    ///< times of the pairs' last collisions
  std::map<Key, double> passed_;  ///< until when contacts of a pair are ignored
  int occasions_ = 0;
  ReferenceRun run_;
};

}  // namespace

ReferenceRun run_reference(const Scene& scene, int collisions, const Fault& fault) {
  return ReferenceGas(scene, fault).run(collisions);
}

}  // namespace needlework::test
