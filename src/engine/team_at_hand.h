// The threads that can share work on all needles without being started.
#pragma once

#include <unistd.h>

namespace needlework {

class TeamAtHand {
 public:
  /// To be set to the number of threads that have just worked together, or to 1.
  void set(int threads) { threads_ = threads, process_ = getpid(); }
  /// Is 1 in a forked child, where OpenMP would wait for its threads without end.
  int threads() const { return process_ == getpid() ? threads_ : 1; }

 private:
  int threads_ = 1;
  pid_t process_ = 0;  ///< in which these are
};

}  // namespace needlework
