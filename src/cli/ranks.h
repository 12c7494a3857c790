// The processes that share a command: one, or the ranks of an MPI job.
#pragma once

#include <functional>
#include <vector>

namespace needlework::cli {

/// The processes that an MPI launcher has started together, as their environment says; MPI itself
/// is not asked.
struct Launch {
  int rank = 0, count = 1;
};
Launch mpi_launch();

/// Joins the other ranks if an MPI launcher has started the program; without one there is a single
/// rank, and MPI is not even initialised. To be made once, on the main thread, and all ranks must
/// call the same members in the same order.
class Ranks {
 public:
  /// Throws InputError when a launcher has started several ranks of a program built without MPI.
  Ranks();
  ~Ranks();
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  int rank() const { return rank_; }
  int count() const { return count_; }

  /// The greatest of all ranks' values, element by element; lengths must be equal.
  std::vector<int> greatest(std::vector<int> values) const;

  /// Does something on all ranks. Where it throws, the first such rank prints why; the result is
  /// the exit code for it on all of them, or 0.
  int do_everywhere(const std::function<void()>& action) const;

 private:
  int rank_ = 0, count_ = 1;
};

}  // namespace needlework::cli
