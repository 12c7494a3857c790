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
    const std::string key = line.substr(3, line.find('`', 3) - 3);
    EXPECT_TRUE(keys.insert(section + "." + key).second) << section << "." << key << " twice";
  }
  return keys;
}

TEST(SceneReference, ListsEveryKeyAndNoOther) { EXPECT_EQ(keys_of_document(), keys_of_schema()); }

}  // namespace
}  // namespace needlework
