// docs/scenes.md lists every key of a scene, each in its section, and none that does not exist.
#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <string>

#include "src/scene/schema.h"

namespace needlework {
namespace {

using KeyNames = std::set<std::string>;  // "section.key", ".title"

KeyNames keys_of_schema() {
  KeyNames keys;
  for (const SceneKey& key : scene_keys()) {
    keys.insert(std::string(key.section) + "." + std::string(key.key));
  }
  return keys;
}

// The keys in the first cell of a row; `*.mean` stands for that key of all tables of the section.
KeyNames keys_in(const std::string& row, const std::string& section) {
  KeyNames keys;
  const std::string cell = row.substr(0, row.find('|', 1));
  for (std::size_t begin = cell.find('`'); begin != cell.npos; begin = cell.find('`', begin)) {
    const std::size_t end = cell.find('`', begin + 1);
    const std::string key = cell.substr(begin + 1, end - begin - 1);
    begin = end + 1;
    if (!key.starts_with('*')) {
      keys.insert(section + "." + key);
      continue;
    }
    for (const std::string& each : keys_of_schema()) {
      if (each.starts_with(section + ".") && each.ends_with(key.substr(1))) keys.insert(each);
    }
  }
  return keys;
}

// Rows "| `key` | ..." beneath a heading "## [section]", "## [[section]]" or "## Top level".
KeyNames keys_of_document() {
  std::ifstream file(NEEDLEWORK_SOURCE "/docs/scenes.md");
  EXPECT_TRUE(file) << NEEDLEWORK_SOURCE "/docs/scenes.md cannot be read";
  KeyNames keys;
  std::string section;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("## [")) {
      const std::size_t begin = line.find_first_not_of('[', 3);
      section = line.substr(begin, line.find(']') - begin);
    }
    if (!line.starts_with("| `")) continue;
    for (const std::string& key : keys_in(line, section))
      EXPECT_TRUE(keys.insert(key).second) << key << " twice";
  }
  return keys;
}

TEST(SceneReference, ListsEveryKeyAndNoOther) { EXPECT_EQ(keys_of_document(), keys_of_schema()); }

}  // namespace
}  // namespace needlework
