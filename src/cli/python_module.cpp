#include "src/cli/python_module.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "src/cli/messages.h"
#include "src/runs/exit_codes.h"

namespace needlework::cli {
namespace {

namespace fs = std::filesystem;

// The modules that the package imports are imported first, as an ImportError in the middle of it
// would not say what to install.
constexpr const char* bootstrap = R"(
import runpy, sys
from importlib import import_module
folder, module = sys.argv[1:3]
del sys.argv[1:3]
sys.path[:] = [folder] * bool(folder) + [path for path in sys.path if path]
def give_up(message):
    print(f"needlework: {module}: {sys.executable}: {message}", file=sys.stderr)
    sys.exit(5)
if sys.version_info < (3, 9):
    give_up(f"is Python {sys.version.split()[0]}: expected 3.9 or newer; "
            "NEEDLEWORK_PYTHON names another one")
def is_missing(name):
    try:
        import_module(name)
    except ImportError:
        return True
    return False
needed = ["numpy", "h5py", "matplotlib"] + ["tomli"] * (sys.version_info < (3, 11))
missing = list(filter(is_missing, needed))
if missing:
    give_up(f"cannot import {', '.join(missing)}: expected `apt install "
            f"{' '.join('python3-' + name for name in missing)}` or `pip install "
            f"{' '.join(missing)}`, or another Python in NEEDLEWORK_PYTHON")
try:
    import needlework
except ImportError as error:
    give_up(f"cannot load the Python package needlework: {error}: expected it "
            + (f"in {folder}, built for this Python" if folder else
               "to be built, for which packages.txt has a section, or installed by pip")
            + "; NEEDLEWORK_PYTHON names another Python")
runpy.run_module(module, run_name="__main__", alter_sys=True)
)";

// The folder with the package that belongs to this program; "" if there is none.
std::string package_folder() {
  const fs::path program = path_of_program();
  for (const char* folder : {"python", NEEDLEWORK_PYTHON_FROM_PROGRAM}) {
    const fs::path candidate = (program.parent_path() / folder).lexically_normal();
    std::error_code error;
    if (*folder && fs::exists(candidate / "needlework/__init__.py", error)) {
      return candidate.string();
    }
  }
  return "";
}

}  // namespace

std::string path_of_program() {
  std::error_code error;
  const fs::path path = fs::read_symlink("/proc/self/exe", error);
  return error ? "needlework" : path.string();
}

int become_python(const std::string& module, const std::vector<std::string>& arguments) {
  const char* const chosen = std::getenv("NEEDLEWORK_PYTHON");
  const bool is_chosen = chosen && *chosen;
  std::vector<std::string> interpreters{is_chosen ? chosen : NEEDLEWORK_PYTHON};
  if (!is_chosen) interpreters.push_back("python3");

  std::vector<std::string> words{interpreters[0], "-c", bootstrap, package_folder(), module};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::fflush(stdout);
  int reason = 0;
  for (const std::string& interpreter : interpreters) {
    words[0] = interpreter;
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    execvp(argv[0], argv.data());
    reason = errno;
  }
  print_error(fmt::format(
      "{}: {}{}: cannot be run: {}: expected Python 3.9 or newer with NumPy, h5py and Matplotlib "
      "(apt install python3-numpy python3-h5py python3-matplotlib)",
      module, is_chosen ? "NEEDLEWORK_PYTHON = " : "", interpreters.back(),
      std::generic_category().message(reason)));
  return runs::input_output_error;
}

}  // namespace needlework::cli
