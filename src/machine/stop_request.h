// Lets long work be stopped that has no result until it is done: reading, drawing and sorting the
// needles of a run.
#pragma once

#include <chrono>
#include <cstddef>
#include <exception>
#include <functional>
#include <string>
#include <utility>

namespace needlework {

/// Thrown by StopRequest::check() when somebody asks to stop. It is no error, and nothing that
/// handles errors, such as a file that cannot be read, may take it for one.
class StoppedEarly : public std::exception {
 public:
  explicit StoppedEarly(std::string why) : why_(std::move(why)) {}
  const char* what() const noexcept override { return why_.c_str(); }

 private:
  std::string why_;
};

/// During its life, this thread's calls of check() ask now and then whether to stop.
class StopRequest {
 public:
  /// `asked` returns why to stop, or nothing. It is called about twenty times a second, and not
  /// within the first twentieth of one.
  explicit StopRequest(std::function<std::string()> asked);
  ~StopRequest();
  StopRequest(const StopRequest&) = delete;
  StopRequest& operator=(const StopRequest&) = delete;

  /// Throws StoppedEarly if the latest StopRequest of this thread, if there is one, asks to stop.
  /// Costs some tens of nanoseconds.
  static void check();
  /// The same in a loop over needles, in few of its turns.
  static void check_in_turn(std::size_t turn) {
    if (turn % 4096 == 0) check();
  }
  /// The same for work of which a share, of [0, 1], is done: whoever is asked may show that.
  struct Stage {
    const char* what = nullptr;  ///< null where nothing is known
    double share = 0;
  };
  static void check(const Stage& stage);
  const Stage& stage() const { return stage_; }
  /// For a forked child, where `asked` must not be called: check() does nothing from now on.
  static void forget();

 private:
  std::function<std::string()> asked_;
  std::chrono::steady_clock::time_point next_;
  StopRequest* outer_;
  Stage stage_;
};

}  // namespace needlework
