// Hard walls at edges of the box: at rest, in motion, or of a temperature.
//
// The surface of a wall that moves at constant velocity is that of the edge of the box; one with a
// temperature may slide in its plane, as belts do.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kernels/wall_contact.h"
#include "src/box/moving_edge.h"
#include "src/effects/event_source.h"
#include "src/physics/contact_time.h"

namespace needlework {

/// One wall. What a scene calls both are two, first the low one.
struct Wall {
  kernels::WallPlane plane;
  double epsilon = 1;
  double temperature = 0;  ///< 0: none; above, all velocities are drawn anew
  double turns = 0;        ///< phase of its motion at the start of the run, in turns
  MovingEdge edge;         ///< its place, if that moves
  Vec3d sliding{};         ///< its velocity in its plane; smooth walls have none [L / time]
};

/// The t_c rule for hits of walls: elastic if the needle's own last collision is less than this
/// ago.
struct ContactTimeOfWalls {
  const ContactTimeRule* rule = nullptr;  ///< null: there is none
  const double* contact_time = nullptr;   ///< as it is in this window [time]
  bool elastic_strikes = false;           ///< hits of needles in contact are elastic, too
  /// For a tip that comes back too soon.
  const char* advice = "a longer contact time helps, unless it rests on the wall";
};

/// Tips of needles hit the walls. A hit on a wall at rest or in motion is smooth, with the wall's
/// own restitution; a wall of a temperature draws the needle's velocities from the Maxwell
/// distribution of those that leave it. Heights of tips that are at a wall are continued from 0, so
/// that rounding a record never moves a tip through it.
class Walls final : public EventSource {
 public:
  /// Adds its columns to the gas. `seed` is that of the scene.
  Walls(Gas& gas, std::vector<Wall> walls, std::uint64_t seed, ContactTimeOfWalls contact_time);

  const char* name() const override { return "wall"; }
  Happening::Kind kind() const override { return Happening::wall; }
  std::size_t objects() const override { return walls_.size(); }
  SourceEvent next(const Gas& gas, Needle i, Time now, Time until) const override;
  SourceOutcome happen(const Gas& gas, const NeedleAt& at, std::int8_t detail) override;
  double usual_time() const override;
  double usual_temperature() const override;
  std::vector<double> parameters() const override;
  std::string message(const Gas& gas, const NeedleAt& at, std::int8_t detail) const override;

 private:
  DoubleDouble turns_at(const Clock& clock, const Wall& wall, Time time) const;
  kernels::WallPlane plane_at(const Clock& clock, const Wall& wall, Time time) const;
  unsigned touching(const Record& record, Needle i, std::size_t wall) const;
  void leave_with_temperature(const NeedleAt& at, const Wall& wall, const Vec3d& normal, double arm,
                              SourceOutcome& outcome);

  std::vector<Wall> walls_;
  double heaviest_ = 0;  ///< mass of the heaviest species
  std::uint64_t seed_;
  ContactTimeOfWalls contact_time_;
  /// Which tips are at which walls: two bits for each wall, above them the serial number of the
  /// record for which that is so.
  Column<std::uint64_t>& touching_;
  Column<std::uint64_t>* draws_ = nullptr;  ///< of hits on walls with a temperature
};

}  // namespace needlework
