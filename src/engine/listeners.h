// Who wants to know what happens in a run.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "needlework/happening.h"
#include "src/physics/gas.h"

namespace needlework {

/// What listeners will need of what has happened.
struct Reports {
  std::vector<Happening> happenings;
  std::vector<double> times;  ///< of collisions
};

/// The callbacks of a run.
struct Listeners {
  std::function<void(const Collision&)> collision;
  std::function<void(std::span<const double>)> times;  ///< of collisions
  std::function<void(const Happening&)> happening;
  std::function<void()> kick;  ///< after one of all needles, or when they have been cooled

  /// Whether anybody wants to know of collisions, or of what else happens.
  bool any() const { return collision || times || happening; }
  /// Whether anybody wants more than times.
  bool want_happenings() const { return collision || happening; }
  /// Passes what has happened to these two needles, or to the one if b is none, to the callbacks,
  /// or appends what they need to `later`. Kept out of the event loops, whose code it would
  /// enlarge.
  void report(const Gas& gas, Happening& what, Needle a, Needle b, Reports* later) const;
  /// Passes it to the callbacks that want whole happenings.
  void pass_on(const Happening& what) const;
};

}  // namespace needlework
