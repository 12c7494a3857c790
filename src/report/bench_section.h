// What a page says of measured results.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace needlework::report {

/// Reads a file of results in JSON, of one of two forms: `cases`, each with a name and values of
/// "us_per_collision" or "ns_per_item" by repetition, which `needlework bench` and the programs in
/// bench/ write; or `families` of pairs with the first contacts missed. Keeps what the page shows:
/// `about` (machine, compiler, ...), and `unit` with `cases` (name, baseline, values), or
/// `families`. Throws IoError, or InputError that names the file and what it should hold.
nlohmann::ordered_json bench_section(const std::string& path);

}  // namespace needlework::report
