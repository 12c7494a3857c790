// One collision of two needles, as the engine reports it.
#pragma once

#include <array>
#include <cstdint>

namespace needlework {

/// The state of one needle just after a collision, bit for bit as the engine continues with it.
struct StateAfterCollision {
  std::array<double, 3> position, velocity, orientation, angular_velocity;
};

/// One collision, as passed to the callback. `first` is the needle with the lower id. Vectors and
/// signs refer to it.
struct Collision {
  std::int64_t epoch = 0;                    ///< the time is exactly epoch * epoch_length + offset
  double offset = 0;                         ///< [time]
  double time = 0;                           ///< the time rounded to a double [time]
  std::uint32_t first = 0;                   ///< lower id
  std::uint32_t second = 0;                  ///< higher id
  std::array<std::int32_t, 3> shift{};       ///< number of boxes added to the second needle's
                                             ///< recorded centre
  double arm_first = 0;                      ///< s12 [L]
  double arm_second = 0;                     ///< s21 [L]
  double sin_angle = 0;                      ///< |u1 x u2|
  double normal_velocity = 0;                ///< V_n before the collision [L / time]
  std::array<double, 3> impulse{};           ///< on `first` [m L / time]
  double energy_change = 0;                  ///< change of the total energy, <= 0 up to rounding
                                             ///< but for what growth adds
  bool contact_time_rule = false;            ///< the t_c rule applied, so that epsilon = 1 and, of
                                             ///< needles, beta = -1
  std::array<StateAfterCollision, 2> after;  ///< states of `first` and `second`; set for callbacks
                                             ///< only
};

}  // namespace needlework
