// A simulation as C programs have it, freed at the end of a test.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "needlework.h"

namespace needlework::test {

/// Some needles that cool: collisions at once, and with the t_c rule no collapse.
inline const std::string cooling =
    "needles = { count = 60, box = 5 }\n"
    "collisions = { epsilon = 0.9, tc_relative = 1e-3 }\n";

class CSimulation {
 public:
  explicit CSimulation(const std::string& scene, unsigned flags = 0)
      : handle_(needlework_create(scene.c_str(), flags, &error)) {}
  CSimulation(const std::string& scene, const needlework_initial& initial)
      : handle_(needlework_create_from(scene.c_str(), &initial, 0, &error)) {}
  CSimulation(const std::string& scene, const needlework_initial& initial,
              const std::vector<std::int32_t>& image)
      : handle_(needlework_create_with_images(scene.c_str(), &initial, image.data(), 0, &error)) {}
  /// Continues the run of a file.
  static CSimulation resumed(const std::string& file) { return CSimulation(File{file}); }
  ~CSimulation() { needlework_destroy(handle_); }
  CSimulation(const CSimulation&) = delete;
  CSimulation& operator=(const CSimulation&) = delete;

  operator needlework_simulation*() const { return handle_; }
  std::string hash() const {
    char text[33] = "";
    EXPECT_EQ(needlework_get_hash(handle_, text), NEEDLEWORK_OK);
    return text;
  }
  needlework_totals totals() const {
    needlework_totals out{};
    EXPECT_EQ(needlework_get_totals(handle_, &out), NEEDLEWORK_OK);
    return out;
  }
  /// Runs until so many collisions, counted from the start.
  void run_to(std::uint64_t collisions) const {
    needlework_limits limits{};
    limits.collisions = collisions;
    int stop = -1;
    EXPECT_EQ(needlework_run_until(handle_, &limits, &stop), NEEDLEWORK_OK) << message();
    EXPECT_EQ(stop, NEEDLEWORK_STOP_COLLISIONS);
  }
  std::string message() const { return needlework_message(handle_); }

  needlework_error error{};

 private:
  struct File {
    const std::string& name;
  };
  explicit CSimulation(File file) : handle_(needlework_resume(file.name.c_str(), &error)) {}

  needlework_simulation* handle_;
};

/// A state in arrays of C, row by row.
struct Arrays {
  explicit Arrays(std::size_t count)
      : position(3 * count),
        velocity(3 * count),
        orientation(3 * count),
        angular_velocity(3 * count),
        image(3 * count),
        id(count) {}
  explicit Arrays(needlework_simulation* simulation) : Arrays(needlework_count(simulation)) {
    const needlework_state into{{position.data(), 0, 0},
                                {velocity.data(), 0, 0},
                                {orientation.data(), 0, 0},
                                {angular_velocity.data(), 0, 0},
                                image.data(),
                                id.data()};
    EXPECT_EQ(needlework_get_state(simulation, &into), NEEDLEWORK_OK);
  }

  /// To start from; `edge` is that of a cube.
  needlework_initial initial(double edge) const {
    return {id.size(),
            {edge, edge, edge},
            {position.data(), 0, 0},
            {velocity.data(), 0, 0},
            {orientation.data(), 0, 0},
            {angular_velocity.data(), 0, 0},
            id.data()};
  }

  std::vector<double> position, velocity, orientation, angular_velocity;
  std::vector<std::int32_t> image;
  std::vector<std::uint32_t> id;
};

/// Directors are normalised when a simulation starts, and angular velocities made normal to them,
/// which may change their last bits.
inline void expect_same_start(const Arrays& actual, const Arrays& expected) {
  EXPECT_EQ(actual.id, expected.id);
  EXPECT_EQ(actual.position, expected.position);
  EXPECT_EQ(actual.velocity, expected.velocity);
  for (std::size_t n = 0; n < expected.orientation.size(); ++n) {
    EXPECT_NEAR(actual.orientation[n], expected.orientation[n], 1e-15);
    EXPECT_NEAR(actual.angular_velocity[n], expected.angular_velocity[n], 1e-14);
  }
}

/// Every function that returns a code or a setting refuses this simulation, which may be null.
inline void expect_all_refuse(needlework_simulation* simulation) {
  const needlework_limits limits{1, 0, 0, 0, 0};
  const needlework_state into{};
  const double numbers[180] = {};
  const needlework_const_vectors vectors{numbers, 0, 0};
  double box[3];
  char hash[33];
  needlework_totals totals;
  std::uint64_t value;
  EXPECT_EQ(needlework_run_until(simulation, &limits, nullptr), NEEDLEWORK_USAGE);
  EXPECT_EQ(needlework_advance(simulation, &limits, nullptr), NEEDLEWORK_USAGE);
  EXPECT_EQ(needlework_checkpoint(simulation), NEEDLEWORK_USAGE);
  EXPECT_EQ(needlework_close(simulation), NEEDLEWORK_USAGE);
  EXPECT_EQ(needlework_set_callback(simulation, 1, nullptr, nullptr), NEEDLEWORK_USAGE);
  EXPECT_EQ(needlework_get_box(simulation, box), NEEDLEWORK_USAGE);
  EXPECT_EQ(needlework_get_state(simulation, &into), NEEDLEWORK_USAGE);
  EXPECT_EQ(needlework_write_state(simulation, "refused.h5", 0), NEEDLEWORK_USAGE);
  EXPECT_EQ(needlework_set_velocities(simulation, &vectors, &vectors), NEEDLEWORK_USAGE);
  EXPECT_EQ(needlework_get_totals(simulation, &totals), NEEDLEWORK_USAGE);
  EXPECT_EQ(needlework_get_bodies(simulation, nullptr, nullptr, nullptr, nullptr),
            NEEDLEWORK_USAGE);
  EXPECT_EQ(needlework_get_hash(simulation, hash), NEEDLEWORK_USAGE);
  EXPECT_EQ(needlework_get_counter(simulation, "events", &value), NEEDLEWORK_USAGE);
  EXPECT_EQ(needlework_setting(simulation, "isa"), nullptr);
}

}  // namespace needlework::test
