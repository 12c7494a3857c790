// Runs the program as its users do, in a folder of its own.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/contains.h"
#include "tests/support/temporary_folder.h"

namespace needlework {

using test::contains;

/// The result of a run of the program.
struct Outcome {
  int exit_code = -1;  ///< -1: it was killed
  std::string out, err;

  /// The one object on stdout.
  nlohmann::json json() const { return nlohmann::json::parse(out); }
  /// Whether stderr is just this one line.
  testing::AssertionResult complains(const std::string& part) const;
  /// The same, and whether it ended with this exit code, and with nothing on stdout if that is one
  /// of usage, input or files.
  testing::AssertionResult fails(int code, const std::string& part) const;
};

/// A test with an empty folder, in which the program runs, and a scene there.
class ProgramTest : public testing::Test {
 protected:
  ProgramTest();

  /// Runs `needlework ARGUMENTS`, words as for a shell. `before` is put before the program,
  /// such as VARIABLE=value; stdout goes to `out` if that is given.
  Outcome run(const std::string& arguments, const std::string& before = "",
              const std::string& out = "") const;
  /// The one object that `needlework ARGUMENTS` prints. Another exit code fails the test.
  nlohmann::json json_of(const std::string& arguments, const std::string& before = "",
                         int exit_code = 0) const;
  /// All that `needlework ARGUMENTS` prints. Another exit code than 0 fails the test.
  std::string output_of(const std::string& arguments) const;
  /// The hash of a run, of `needlework ARGUMENTS --json --quiet`.
  std::string hash_of(const std::string& arguments, const std::string& before = "") const;
  /// Runs any command of the shell.
  Outcome shell(const std::string& command, const std::string& out = "") const;
  /// Runs a command in the background, waits until another one, `event`, succeeds, and sends the
  /// signal INT, TERM or KILL to the first ($! in `event`). So how fast the machine is does not
  /// matter. A command that ends before the event gets no signal.
  Outcome shell_and_signal(const std::string& command, const std::string& event,
                           const std::string& signal) const;
  /// The same for `needlework ARGUMENTS`.
  Outcome run_and_signal(const std::string& arguments, const std::string& event,
                         const std::string& signal, const std::string& before = "") const;

  void write(const std::string& name, const std::string& text) const;
  std::string read(const std::string& name) const;
  bool exists(const std::string& name) const;
  /// Names of the files in the folder.
  std::vector<std::string> files() const;
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  /// Name of an elastic scene in equilibrium that takes some milliseconds.
  static constexpr const char* small = "small.toml";

 private:
  test::TemporaryFolder temporary_;
  std::filesystem::path folder_ = temporary_.path();
};

}  // namespace needlework
