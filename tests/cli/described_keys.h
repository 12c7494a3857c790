// The keys that a document describes, to be compared with those that the program prints.
#pragma once

#include <algorithm>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace needlework {

/// The keys in the first cells of the tables of docs/NAME, by the heading above them.
inline std::map<std::string, std::vector<std::string>> described_keys(const std::string& name) {
  std::map<std::string, std::vector<std::string>> described;
  std::ifstream document(NEEDLEWORK_SOURCE "/docs/" + name);
  std::string heading;
  for (std::string line; std::getline(document, line);) {
    if (line.starts_with("##")) heading = line.substr(line.find(' ') + 1);
    if (!line.starts_with("| `")) continue;
    const std::string cell = line.substr(2, line.find(" |", 2) - 2);
    for (std::size_t begin = 0; (begin = cell.find('`', begin)) != cell.npos;) {
      const std::size_t end = cell.find('`', begin + 1);
      described[heading].push_back(cell.substr(begin + 1, end - begin - 1));
      begin = end + 1;
    }
  }
  return described;
}

/// In the order of the alphabet.
inline std::vector<std::string> keys_of(const nlohmann::json& object) {
  std::vector<std::string> found;
  for (const auto& [key, value] : object.items()) found.push_back(key);
  return found;
}

inline std::vector<std::string> sorted(std::vector<std::string> keys) {
  std::sort(keys.begin(), keys.end());
  return keys;
}

}  // namespace needlework
