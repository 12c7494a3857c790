// Hands collisions, or all that happens, to a front end, many at once.
#pragma once

#include <cstddef>
#include <exception>
#include <functional>
#include <span>
#include <vector>

#include "needlework/happening.h"
#include "needlework/simulation.h"

namespace needlework::runs {

/// Collects the reports of a simulation, of type Collision or Happening, and passes them on in
/// order of time. A call costs far more than an event in some languages, so it is made for many at
/// once.
///
/// The engine cannot continue from an exception in the middle of an event. When the function
/// throws, the simulation is therefore interrupted, and flush() throws the exception after that.
/// Reports from then on are kept for the next call.
template <class Report>
class Batches {
 public:
  using Callback = std::function<void(std::span<const Report>)>;

  /// Calls for each `batch` collisions (at least 1), or for fewer where memory does not suffice.
  /// Both must outlive this object.
  Batches(Simulation& simulation, std::size_t batch, Callback callback);
  ~Batches();
  Batches(const Batches&) = delete;
  Batches& operator=(const Batches&) = delete;

  void add(const Report& report);
  /// Passes on what is left, or throws what the function has thrown since the last flush().
  void flush();

 private:
  void make_room();
  /// Calls for one batch after the other while at least so many reports are left, until the
  /// function throws. More than a batch is there after it has thrown.
  void pass_on(std::size_t least);

  Simulation& simulation_;
  std::size_t batch_;
  Callback callback_;
  std::vector<Report> collected_;
  std::exception_ptr failure_;
};

extern template class Batches<Collision>;
extern template class Batches<Happening>;

}  // namespace needlework::runs
