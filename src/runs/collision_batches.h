// Hands collisions to a front end, many at once.
#pragma once

#include <cstddef>
#include <exception>
#include <functional>
#include <span>
#include <vector>

#include "needlework/collision.h"
#include "needlework/simulation.h"

namespace needlework::runs {

/// Collects the collisions of a simulation and passes them on in order of time. A call costs far
/// more than a collision in some languages, so it is made for many at once.
///
/// The engine cannot continue from an exception in the middle of a collision. When the function
/// throws, the simulation is therefore interrupted, and flush() throws the exception after that.
/// Collisions from then on are kept for the next call.
class CollisionBatches {
 public:
  using Callback = std::function<void(std::span<const Collision>)>;

  /// Calls for each `batch` collisions (at least 1), or for fewer where memory does not suffice.
  /// Both must outlive this object.
  CollisionBatches(Simulation& simulation, std::size_t batch, Callback callback);

  void add(const Collision& collision);
  /// Passes on what is left, or throws what the function has thrown since the last flush().
  void flush();

 private:
  void make_room();
  /// Calls for one batch after the other while at least so many collisions are left, until the
  /// function throws. More than a batch is there after it has thrown.
  void pass_on(std::size_t least);

  Simulation& simulation_;
  std::size_t batch_;
  Callback callback_;
  std::vector<Collision> collected_;
  std::exception_ptr failure_;
};

}  // namespace needlework::runs
