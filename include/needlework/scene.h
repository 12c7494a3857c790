// A scene: everything that a run needs to know, as plain data. Scene files are read by parse.h.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace needlework {

/// What to simulate, in the units of the engine: needle length L = 1, mass m = 1, so that a
/// temperature is an energy and a time is in L sqrt(m / T). Each member is one key of a scene file.
struct Scene {
  struct Needles {
    std::uint64_t count = 0;      ///< number of needles, 0 and 1 included
    std::array<double, 3> box{};  ///< edges of the periodic box [L], each >= 2.01
    double k = 6.0;               ///< m L^2 / (2 I) > 0; 6: uniform rod, 2: mass at the tips
    std::uint64_t seed = 1;       ///< of the counter-based generator that draws the state
  };
  /// One species of needles, in place of needles.count, needles.k and the temperatures of Initial,
  /// which are those of the species then.
  struct Species {
    std::string name;         ///< any text, distinct
    std::uint64_t count = 0;  ///< number of needles
    double length = 1.0;      ///< [L]
    double mass = 1.0;        ///< [m]
    double k = 6.0;           ///< m L^2 / (2 I) > 0
    double t_tr = 1.0;        ///< translational temperature drawn
    double t_rot = 1.0;       ///< rotational temperature drawn
  };
  struct Initial {
    double t_tr = 1.0;   ///< translational temperature drawn, (2/3) <m v^2 / 2>
    double t_rot = 1.0;  ///< rotational temperature drawn, <I w^2 / 2>
    std::string file;    ///< H5MD file whose last frame is the initial state, or ""
  };
  struct Collisions {
    double epsilon = 1.0;               ///< normal restitution, [0, 1]
    double beta = -1.0;                 ///< tangential restitution, [-1, 1]; -1 is smooth
    std::optional<double> tc;           ///< contact time of the t_c rule [time]
    std::optional<double> tc_relative;  ///< the same in present mean free times
  };
  struct Engine {
    std::string search = "auto";
    std::string queue = "auto";
    std::string accuracy = "standard";      ///< a level; what follows departs from it
    std::optional<std::string> isolation;   ///< "sampling", "bounds" or "intervals"
    std::optional<std::string> escalation;  ///< "never", "undecided" or "always"
    std::optional<std::string> filter;      ///< "float" or "double"
    std::optional<double> root_tolerance;   ///< see kernels/accuracy.h
    std::optional<double> sampling_step;    ///< see kernels/accuracy.h
    std::optional<int> threads;             ///< absent: OMP_NUM_THREADS, else 1
    std::string isa = "auto";
    std::optional<double> cell_side;       ///< least side of cells; absent: chosen [L]
    std::optional<double> capsule_radius;  ///< absent: chosen [L]
    std::string storage = "sorted";  ///< "sorted" by place, or "by-id", to see what that gains
  };
  /// The first condition met ends the run; all count from the start of the run.
  struct Until {
    std::optional<double> time;
    std::optional<double> collisions_per_needle;  ///< 2 collisions / N
    std::optional<double> energy_ratio;           ///< E / E(0) <=
    std::optional<double> wall_s;                 ///< wall-clock seconds
  };
  struct Output {
    std::string file;                         ///< H5MD file to write, or "" for none
    double series_per_decade = 10.0;          ///< samples of the series per decade of time
    std::vector<double> frame_times;          ///< `frames = [t, ...]`: times of frames
    std::optional<double> frames_per_decade;  ///< `frames = n`: frames per decade of time
    std::vector<std::string> observables;     ///< by name; those there are always written
    bool events = false;                      ///< record every collision
  };

  std::string title;
  Needles needles;
  std::vector<Species> species;  ///< empty: one of length and mass 1, by Needles and Initial
  Initial initial;
  Collisions collisions;
  Engine engine;
  Until until;
  Output output;

  std::string text;  ///< the scene file as read, overrides appended; kept in the output
  /// Where each key "section.key" was given, with its value, as messages name it; none for what
  /// was not read from a file: "FILE: line N: section.key = VALUE" or "--set section.key=VALUE".
  std::map<std::string, std::string, std::less<>> places;
};

}  // namespace needlework
