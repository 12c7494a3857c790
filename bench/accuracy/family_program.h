// What programs have in common that compare first contacts of one family of pairs with an oracle.
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <string>

#include "needlework/error.h"

namespace needlework {

struct FamilyOptions {
  std::string family;
  std::uint64_t count = 10000, seed = 1;
  bool list_families = false;
};

/// Of families that have a name each. Throws InputError for another name.
template <class Families>
const auto& family_named(const Families& families, const std::string& name) {
  const auto found =
      std::ranges::find_if(families, [&](const auto& family) { return family.name == name; });
  if (found != families.end()) return *found;
  throw InputError(fmt::format("FAMILY {}: expected one that --families prints", name));
}

template <class Families>
void print_names(const Families& families) {
  for (const auto& family : families) fmt::print("{}\n", family.name);
}

/// The program's main(): reads the options, to which add(app) adds, and runs.
template <class Add, class Run>
int family_program(int argc, char** argv, const char* title, FamilyOptions& options, Add&& add,
                   Run&& run) {
  CLI::App app(title);
  app.add_option("FAMILY", options.family);
  app.add_flag("--families", options.list_families, "print the names of the families");
  app.add_option("--pairs", options.count)->capture_default_str();
  app.add_option("--seed", options.seed)->capture_default_str();
  add(app);
  CLI11_PARSE(app, argc, argv);
  try {
    return run();
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 3;
  }
}

}  // namespace needlework
