#include "tests/cli/program.h"

#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>

#include "tests/support/whole_file.h"

namespace needlework {

namespace fs = std::filesystem;
using test::bytes_of;

testing::AssertionResult Outcome::complains(const std::string& part) const {
  const bool one_line = std::count(err.begin(), err.end(), '\n') == 1 && err.back() == '\n';
  if (one_line && err.starts_with("needlework: ") && err.find(part) != std::string::npos) {
    return testing::AssertionSuccess();
  }
  return testing::AssertionFailure() << "expected one line with \"" << part << "\", got:\n" << err;
}

testing::AssertionResult Outcome::fails(int code, const std::string& part) const {
  const bool is_error = code == 2 || code == 3 || code == 5;
  if (exit_code == code && (out.empty() || !is_error)) return complains(part);
  return testing::AssertionFailure() << "exit code " << exit_code << ": expected " << code << '\n'
                                     << err << out;
}

ProgramTest::ProgramTest() {
  write(small, R"(title = "Small gas"
needles = { count = 50, box = 5 }
until.collisions_per_needle = 10
)");
}

Outcome ProgramTest::run(const std::string& arguments, const std::string& before,
                         const std::string& out) const {
  return shell(before + " '" + NEEDLEWORK_PROGRAM + "' " + arguments, out);
}

nlohmann::json ProgramTest::json_of(const std::string& arguments, const std::string& before,
                                    int exit_code) const {
  const Outcome outcome = run(arguments, before);
  EXPECT_EQ(outcome.exit_code, exit_code) << arguments << '\n' << outcome.err;
  return outcome.json();
}

std::string ProgramTest::output_of(const std::string& arguments) const {
  const Outcome outcome = run(arguments);
  EXPECT_EQ(outcome.exit_code, 0) << arguments << '\n' << outcome.err;
  return outcome.out;
}

std::string ProgramTest::hash_of(const std::string& arguments, const std::string& before) const {
  return json_of(arguments + " --json --quiet", before)["trajectory_hash"];
}

Outcome ProgramTest::shell(const std::string& command, const std::string& out) const {
  const test::TemporaryFolder temporary;
  const fs::path& streams = temporary.path();
  const std::string out_path = out.empty() ? (streams / "out").string() : out;
  const std::string redirections =
      " </dev/null >'" + out_path + "' 2>'" + (streams / "err").string() + "'";
  const int status =
      std::system(("cd '" + folder_.string() + "' && " + command + redirections).c_str());
  Outcome outcome;
  if (WIFEXITED(status)) outcome.exit_code = WEXITSTATUS(status);
  if (out.empty()) outcome.out = bytes_of(out_path);
  outcome.err = bytes_of(streams / "err");
  return outcome;
}

Outcome ProgramTest::shell_and_signal(const std::string& command, const std::string& event,
                                      const std::string& signal) const {
  return shell("{ " + command + " & until { " + event +
               "; } >&3 2>&3 || ! kill -0 $! 2>&3; do sleep 0.01; done; kill -" + signal +
               " $! 2>&3; wait $!; } 3>/dev/null");
}

Outcome ProgramTest::run_and_signal(const std::string& arguments, const std::string& event,
                                    const std::string& signal, const std::string& before) const {
  return shell_and_signal("env " + before + " '" NEEDLEWORK_PROGRAM "' " + arguments, event,
                          signal);
}

void ProgramTest::write(const std::string& name, const std::string& text) const {
  std::ofstream(folder_ / name, std::ios::binary) << text;
}

std::string ProgramTest::read(const std::string& name) const { return bytes_of(folder_ / name); }

bool ProgramTest::exists(const std::string& name) const { return fs::exists(folder_ / name); }

std::vector<std::string> ProgramTest::files() const {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder_)) {
    names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace needlework
