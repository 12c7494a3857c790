// A scene: all parameters of a run, as plain data. parse.h reads scene files.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "needlework/composition.h"

namespace needlework {

/// Largest size of the text of a scene [bytes].
inline constexpr std::size_t max_scene_bytes = std::size_t{1} << 20;

/// What to simulate, in the engine's units: needle length L = 1 and mass m = 1, unless a
/// species says otherwise. A temperature is then an energy, and times are in L sqrt(m / T). Members
/// are keys of a scene file, besides those that say where the scene comes from.
struct Scene {
  struct Needles {
    std::uint64_t count = 0;  ///< number of needles; 0 and 1 are allowed
    std::array<double, 3>
        box{};               ///< edges of the box [L], each >= 2.01, or 1 along an axis with walls
    double k = 6.0;          ///< m L^2 / (2 I) > 0; 6: uniform rod, 2: mass at the tips
    double diameter = 0.0;   ///< above 0: rods of finite width, whose axes have length 1 [L]
    std::uint64_t seed = 1;  ///< of the counter-based generator that draws the initial state
  };
  /// One species of needles. If there are any, they replace needles.count, needles.k and the
  /// temperatures of Initial.
  using Species = needlework::Species;
  struct Initial {
    double t_tr = 1.0;   ///< translational temperature of a drawn state, (2/3) <m v^2 / 2>
    double t_rot = 1.0;  ///< rotational temperature of a drawn state, <I w^2 / 2>, of rough
                         ///< spheres <I w^2> / 3
    std::string file;    ///< H5MD file whose last frame is the initial state, or "" to draw it
    std::string packing =
        "auto";  ///< of rods: "insertion", "lattice", "crossed", "compress", or what serves first
  };
  struct Collisions {
    double epsilon = 1.0;               ///< normal restitution, [0, 1]
    double beta = -1.0;                 ///< tangential restitution, [-1, 1]; -1 is smooth
    std::optional<double> tc;           ///< contact time of the t_c rule [time]
    std::optional<double> tc_relative;  ///< the same, in present mean free times
    bool sliding = false;               ///< needles that bounce ever faster stay in contact
    double sliding_below = 1e-3;   ///< in flights shorter than this, in present mean free times
    bool elastic_strikes = false;  ///< what needles in contact hit, and they then, is elastic
  };
  /// What is different from Collisions where two species collide.
  struct Pair {
    std::array<std::string, 2> between;  ///< names of the species, which may be one
    std::optional<double> epsilon;       ///< normal restitution, [0, 1]
    std::optional<double> beta;          ///< tangential restitution, [-1, 1]
    bool meet = true;                    ///< or they pass through each other
  };
  /// Motion of a wall, t from the start of the scene. Along its axis, its surface is at
  /// A sin(2 pi f t + phase) from where the wall is, or at velocity * t until it comes to rest; or
  /// it slides in its plane, of a thermal wall alone.
  struct WallMotion {
    double amplitude = 0;            ///< A >= 0 [L]
    double frequency = 1;            ///< f > 0 [cycles per time]
    double phase = 0;                ///< [radians]
    std::optional<double> velocity;  ///< along the positive axis, on both sides [L / time]
    std::optional<double> stop_at;   ///< coordinate at which it comes to rest [L]
    /// Velocity along the two other axes, in the order x, y, z [L / time]
    std::optional<std::array<double, 2>> tangential;
  };
  /// A smooth hard wall at an edge of the box, or one at both. Needles touch it by their tips.
  struct Wall {
    std::string axis;                   ///< "x", "y" or "z"
    std::string side;                   ///< "low", "high" or "both"
    double epsilon = 1;                 ///< normal restitution, [0, 1]
    std::optional<double> temperature;  ///< all velocities of a needle that hits it are drawn anew
    std::optional<WallMotion> motion;   ///< absent: at rest
  };
  struct Forces {
    std::array<double, 3> gravity{};  ///< acceleration of all needles [L / time^2]
  };
  /// Uniform shear: a flow along x that grows with y, by images whose rows slide along x.
  struct Shear {
    double rate = 0;  ///< d v_x / d y, of either sign [1 / time]
    double offset =
        0;  ///< by how much the row of boxes above has slid at the start, in [0, L_x) [L]
  };
  /// White noise in steps: at the multiples of `every`, each component of a velocity changes by a
  /// Gaussian number of variance translational^2 every, and each component of an angular velocity
  /// normal to the director by one of variance rotational^2 every.
  struct Kicks {
    double every = 1;          ///< > 0 [time]
    double translational = 0;  ///< [L / time^(3/2)]
    double rotational = 0;     ///< [1 / time^(3/2)]
  };
  /// Andersen thermostat: at exponentially distributed times each needle's velocities are drawn
  /// anew.
  struct Andersen {
    double rate = 1;         ///< > 0, of each needle [1 / time]
    double temperature = 1;  ///< > 0, of the velocities that are drawn
  };
  /// All bodies grow in proportion, linearly in time, while their temperature is held: by the rule
  /// of Lubachevsky and Stillinger, towards jammed packings. Masses and moments of inertia stay.
  struct Growth {
    double rate = 1e-2;  ///< of the mean diameter, over sqrt(T / m) at the start [1]
    std::optional<double> until_packing;   ///< a packing fraction at which they have grown
    std::optional<double> until_pressure;  ///< P V / (N T) that ends the run
    /// Collisions, as a multiple of the number of bodies, after which velocities are scaled back to
    /// the temperature at the start; 0: never. Absent: 1, or 0.01 / rate of slower growth.
    std::optional<double> cool_every;
    /// No key of scene files: bodies begin as this share of the sizes of the scene and, where it is
    /// below 1, grow to these.
    double from = 1;
  };
  struct Driving {
    std::optional<Kicks> kicks;
    std::optional<Andersen> andersen;
    std::optional<Growth> growth;
  };
  struct Engine {
    std::string search = "auto";
    std::string queue = "auto";
    std::string accuracy = "standard";      ///< a level; the next five keys override parts of it
    std::optional<std::string> isolation;   ///< "sampling", "bounds" or "intervals"
    std::optional<std::string> escalation;  ///< "never", "undecided" or "always"
    std::optional<std::string> filter;      ///< "float" or "double"
    std::optional<double> root_tolerance;   ///< see needlework/accuracy.h
    std::optional<double> sampling_step;    ///< see needlework/accuracy.h
    std::optional<int> threads;             ///< absent: OMP_NUM_THREADS, else 1
    bool threads_by_size = false;           ///< "auto": `threads` follows from needles and cores
    std::string team = "auto";  ///< "auto": one thread works alone where that is faster; or "all"
    std::string isa = "auto";
    std::optional<double> cell_side;       ///< least side of cells [L]; absent: chosen
    std::optional<double> capsule_radius;  ///< radius of capsules [L]; absent: chosen
    std::string storage = "sorted";        ///< "sorted" in space, or "by-id" to measure the gain of
                                           ///< sorting
  };
  /// The first condition that is met ends the run. All count from the start of the run.
  struct Until {
    std::optional<double> time;
    std::optional<double> collisions_per_needle;  ///< 2 collisions / N
    std::optional<double> energy_ratio;           ///< ends the run when E / E(0) is at most this
    std::optional<double> wall_s;                 ///< wall-clock time [s]
  };
  struct Output {
    std::string file;                         ///< H5MD file to write, or "" for none
    double series_per_decade = 10.0;          ///< samples of /series per decade of time
    std::optional<double> series_every;       ///< samples at its multiples instead [time]
    std::vector<double> frame_times;          ///< `frames = [t, ...]`: times of frames
    std::optional<double> frames_per_decade;  ///< `frames = n`: frames per decade of time
    std::optional<double> frames_every;       ///< frames at its multiples instead [time]
    std::vector<std::string> observables;     ///< names of what /series holds besides Totals
    std::optional<std::array<int, 3>> grid;   ///< cells along each axis; absent: of 20 needles
    std::optional<int> size_classes;          ///< of each species, for /series/by_size
    bool events = false;                      ///< whether to record every collision
    double checkpoint_every = 300;            ///< wall time between two checkpoints beside the
                                              ///< file [s]; 0: none
  };

  std::string title;
  Needles needles;
  std::vector<Species> species;  ///< empty: one species of length 1 and mass 1, given by Needles
                                 ///< and Initial
  std::vector<Pair> pairs;
  Initial initial;
  Collisions collisions;
  std::vector<Wall> walls;
  Forces forces;
  std::optional<Shear> shear;
  Driving driving;
  Engine engine;
  Until until;
  Output output;

  /// One side of the box that has a wall.
  struct WallSide {
    std::size_t axis = 0;   ///< 0, 1, 2 for x, y, z
    bool is_high = false;   ///< at the edge of the box, else at 0
    std::size_t entry = 0;  ///< in `walls`
  };
  /// Wherever walls are listed or indexed, they are these: in the order of `walls`, where "both"
  /// counts as low, then high.
  std::vector<WallSide> wall_sides() const;
  /// Along which axes the box is periodic: those without walls.
  std::array<bool, 3> periodic() const;
  /// Whether walls have a velocity, so that edges of the box move.
  bool has_moving_walls() const;

  /// What the gas is made of, with everything that the short form leaves unsaid.
  Composition composition() const;

  std::string text;  ///< the scene file as read, with overrides appended; stored in the output
  /// Where each key "section.key" was given, and its value, as messages quote it: "FILE: line N:
  /// section.key = VALUE" or "--set section.key=VALUE". Keys that were not read from a text have
  /// no entry.
  std::map<std::string, std::string, std::less<>> places;
};

}  // namespace needlework
