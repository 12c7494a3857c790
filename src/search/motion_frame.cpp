#include "src/search/motion_frame.h"

#include "kernels/power_of_two.h"

namespace needlework {
namespace {

// So far the frame falls, by sides of cells or lengths of needles, before it is brought to rest.
constexpr double fallen_of_side = 0.125;

}  // namespace

void MotionFrame::begin(Time now, double most_fallen) {
  double sum = 0;
  for (const Record& record : gas.records) {
    const Vec3d v = (record.flight.v - gas.flow_at(record.flight.r)) * per_length;
    sum += dot(v, v) + 0.25 * record.flight.omega * record.flight.omega;
  }
  const double speed = std::sqrt(sum / static_cast<double>(gas.size()));
  per_time = speed > 0 && std::isfinite(speed) ? times_power_of_two(1, exponent_of(speed)) : 1;
  base = now;
  longest_time = kernels::longest_time;
  if (falls) {
    const double pull = std::sqrt(dot(gas.gravity, gas.gravity));
    longest_time = std::min(longest_time, std::sqrt(2 * most_fallen / pull) * per_time);
  }
}

double MotionFrame::most_fallen(double side, double longest) const {
  return falls ? fallen_of_side * std::min(side, longest) : 0;
}

MotionFrame::Range MotionFrame::along_curve(int axis, const kernels::Seeker& seeker,
                                            float ahead) const {
  const auto pull =
      static_cast<float>(component(gas.gravity, axis) * per_length / (per_time * per_time));
  const float r = seeker.motion.r[axis] + 0.5f * pull * (seeker.now * seeker.now);
  const float v = seeker.motion.v[axis] + pull * seeker.now;
  const float end = (v + 0.5f * pull * ahead) * ahead;
  Range out{r + std::min(0.0f, end), r + std::max(0.0f, end)};
  // It turns back on the way.
  if (v * pull < 0 && std::abs(v) < std::abs(pull) * ahead) {
    const float turn = r - 0.5f * v * v / pull;
    out = {std::min(out.low, turn), std::max(out.high, turn)};
  }
  return out;
}

}  // namespace needlework
