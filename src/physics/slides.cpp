#include "src/physics/slides.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/archive/archive.h"
#include "src/physics/director.h"
#include "src/physics/gas.h"
#include "src/physics/transfer.h"
#include "src/physics/vectors.h"

namespace needlework {
namespace {

double length_of(const Vec3d& a) { return std::sqrt(dot(a, a)); }

}  // namespace

kernels::BodyState Slide::at(int needle, const kernels::Flight& record, const Vec3d& gravity,
                             double elapsed) const {
  const kernels::SlidingState state = step.at(elapsed);
  const double part = needle == 0 ? share[0] : -share[1];
  kernels::BodyState out;
  out.r = (record.r + drift * elapsed) + ((state.r - apart) * part);
  out.v = drift + state.v * part;
  out.r += gravity * (0.5 * elapsed * elapsed);
  out.v += gravity * elapsed;
  out.u = needle == 0 ? state.u_first : state.u_second;
  out.w = needle == 0 ? state.w_first : state.w_second;
  return out;
}

kernels::SlidingBodies sliding_bodies(const Gas& gas, Needle first, Needle second) {
  const auto body = [&](Needle i) {
    const Body& of = gas.body(i);
    return kernels::SlidingBody{of.half_length, 1 / of.inverse_mass, 1 / of.inverse_inertia};
  };
  return {body(first), body(second)};
}

Slide make_slide(const Gas& gas, Needle i, Needle j, const Shift& shift, int side) {
  const Record &first = gas.records[i], &second = gas.records[j];
  const kernels::SlidingBodies bodies = sliding_bodies(gas, i, j);
  const kernels::Flight &a = first.flight, &b = second.flight;
  const Image<double> image = gas.box_at(first.time).image(shift);
  Slide out;
  out.side = side;
  out.apart = (a.r - b.r) - image.place;
  const double mass = bodies.first.mass + bodies.second.mass;
  out.drift = (a.v * bodies.first.mass + b.v * bodies.second.mass) * (1 / mass);
  out.share[0] = bodies.second.mass / mass;
  out.share[1] = bodies.first.mass / mass;
  const kernels::SlidingState begin =
      kernels::in_contact(bodies, {out.apart, (a.v - b.v) - image.velocity, a.u, b.u, a.w, b.w});
  // Not to the time at which the records would be renewed.
  const auto lasts = [&](Needle needle) {
    return 0.5 * gas.motion(gas.records[needle]).lasts(gas.body(needle).length());
  };
  double limit = std::min(lasts(i), lasts(j));
  for (;;) {
    out.step = kernels::sliding_step(bodies, begin, side, limit);
    const kernels::SlidingStep::Most& most = out.most = out.step.most();
    const double time = out.step.duration, half = 0.5 * time * time;
    const auto departs = [&](double share, double turned_faster, double half_length) {
      return (share * most.acceleration + half_length * turned_faster) * half >
             most_departure * 2 * half_length * (1 - 0x1p-10);
    };
    out.faster[0] = out.share[0] * most.acceleration * out.step.span;
    out.faster[1] = out.share[1] * most.acceleration * out.step.span;
    if (out.step.end == kernels::SlidingEnd::Unresolvable) return out;
    if (!departs(out.share[0], most.turned_faster_first, bodies.first.half) &&
        !departs(out.share[1], most.turned_faster_second, bodies.second.half))
      return out;
    limit = 0.5 * time;
  }
}

void Slides::put(Id first, std::uint32_t serial, const Slide& slide) {
  auto made = std::make_unique<Slide>(slide);
  const std::lock_guard lock(mutex_);
  std::unique_ptr<Slide>& entry = slides_[key_of(first, serial)];
  // In place, as a phase that is repeated makes the same numbers again.
  if (entry)
    *entry = slide;
  else
    entry = std::move(made);
}

const Slide* Slides::find(Id first, std::uint32_t serial) const {
  const std::lock_guard lock(mutex_);
  const auto found = slides_.find(key_of(first, serial));
  return found == slides_.end() ? nullptr : found->second.get();
}

NeedleTrajectory::NeedleTrajectory(const Gas& gas, Id id, const Record& record, const Slide* slide,
                                   double delay)
    : gas_(gas),
      record_(record),
      slide_(slide),
      index_(slide && record.first_touch.partner < id ? 1 : 0),
      delay_(delay) {
  acceleration = length_of(gas.gravity);
  if (!slide_) {
    lasts = std::numeric_limits<double>::infinity();
    speed = gas.fastest_of(record);
    turning = record.flight.omega;
    return;
  }
  const kernels::SlidingStep::Most& most = slide_->most;
  lasts = std::max(0.0, slide_->step.duration - delay);
  speed = length_of(slide_->drift) + slide_->share[index_] * most.speed +
          acceleration * slide_->step.span;
  acceleration += slide_->share[index_] * most.acceleration;
  turning = index_ == 0 ? most.turning_first : most.turning_second;
  turning_faster = index_ == 0 ? most.turned_faster_first : most.turned_faster_second;
}

kernels::BodyState NeedleTrajectory::at(double s) const {
  const double elapsed = delay_ + s;
  if (slide_) return slide_->at(index_, record_.flight, gas_.gravity, elapsed);
  const FreeFlight motion = gas_.motion(record_);
  return {motion.centre(elapsed), motion.velocity(elapsed), motion.director(elapsed),
          motion.angular_velocity(elapsed)};
}

void transfer(Archive& archive, Slide& slide) {
  kernels::SlidingStep& step = slide.step;
  archive(step.begin.r, step.begin.v, step.begin.u_first, step.begin.u_second, step.begin.w_first,
          step.begin.w_second, step.span, step.duration);
  auto end = static_cast<std::uint8_t>(step.end);
  std::int32_t side = slide.side;
  archive(end, step.slopes, slide.apart, slide.drift, side);
  for (int n = 0; n < 2; ++n) archive(slide.share[n], slide.faster[n]);
  if (!archive.reads()) return;
  bool is_sound = end <= static_cast<std::uint8_t>(kernels::SlidingEnd::Unresolvable) &&
                  std::abs(side) == 1 && step.span >= 0 && step.duration >= 0 &&
                  step.duration <= step.span && std::isfinite(step.span);
  for (const auto& component : step.slopes) {
    for (const double each : component) is_sound = is_sound && std::isfinite(each);
  }
  for (const Vec3d& each : {step.begin.r, step.begin.v, step.begin.u_first, step.begin.u_second,
                            step.begin.w_first, step.begin.w_second, slide.apart, slide.drift}) {
    is_sound = is_sound && is_finite(each);
  }
  for (int n = 0; n < 2; ++n) {
    is_sound = is_sound && slide.share[n] >= 0 && slide.share[n] <= 1 && slide.faster[n] >= 0 &&
               std::isfinite(slide.faster[n]);
  }
  archive.require(is_sound);
  step.end = static_cast<kernels::SlidingEnd>(end);
  slide.most = step.most();
  slide.side = side;
}

}  // namespace needlework
