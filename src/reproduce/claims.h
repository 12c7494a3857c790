// What the paper claims, read from profiles/paper/claims.toml.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "src/reproduce/verdict.h"

namespace needlework::reproduce {

/// A statement, with its number if it has one.
struct Claim {
  std::string id;
  std::string figure;     ///< name of the figure of the command that measures it
  std::string statement;  ///< in our words
  std::string where;      ///< in the paper; empty for what goes beyond it
  std::string quantity;   ///< what is measured, in words
  Stated paper;           ///< number and precision
  std::string reading;    ///< how number and precision follow from words; empty where not needed
};

/// Reads claims, each a table of TOML whose name is the id. Throws InputError, "NAME: line N: key =
/// VALUE: expected ...", for the first error.
std::vector<Claim> read_claims(std::string_view text, std::string_view name);

}  // namespace needlework::reproduce
