// Hands over to a module of the Python package.
#pragma once

#include <string>
#include <vector>

namespace needlework::cli {

/// Replaces this process by Python, which runs the module, such as "needlework.reproduce", with
/// these arguments. The package is that of the build tree or of the installation that the program
/// is part of, or else what the interpreter finds. The interpreter is $NEEDLEWORK_PYTHON, or the
/// one that the package was built for, or python3. Where something is missing, Python says what to
/// install and ends with input_output_error before the module begins. Returns only where no
/// interpreter can be run, after a message, with that code.
int become_python(const std::string& module, const std::vector<std::string>& arguments);

/// The path of this program, for modules that call it.
std::string path_of_program();

}  // namespace needlework::cli
