// A scene that is not valid is refused in the same words by every way in: file, --set, C, a pipe
// and a Scene made in code; tests/python/test_errors.py reads the same table for Python.
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include "needlework.h"
#include "needlework/error.h"
#include "needlework/initial_state.h"
#include "needlework/simulation.h"
#include "src/scene/schema.h"
#include "src/scene/validity.h"
#include "src/scene_text/document.h"
#include "src/serve/server.h"
#include "tests/cli/program.h"
#include "tests/scene/message.h"

namespace needlework::one_validity {
namespace {

using Json = nlohmann::json;

struct InvalidScene {
  std::string rule, base, text, set, set_says, key, file_key, message;
  bool engine;      // whether the engine refuses it, made in code
  bool front_ends;  // whether those do that do not run it to its end
};

// What an entry does not say: its base is the plain one, its key and its text follow from what is
// set, which stands above the base, or in the last entry of it.
std::vector<InvalidScene> invalid_scenes() {
  std::ifstream file(NEEDLEWORK_SOURCE "/tests/scene/invalid_scenes.json");
  std::vector<InvalidScene> out;
  for (const Json& each : Json::parse(file)) {
    const auto say = [&](const char* name, const std::string& otherwise) {
      return each.value(name, otherwise);
    };
    const std::string base = say("base", "needles = { count = 10, box = 12 }\nuntil.time = 5\n");
    const std::string set = say("set", "");
    const std::size_t equals = std::min(set.find('='), set.size());
    std::string key = set.substr(0, equals), text;
    if (std::regex entry("((?:species|pairs|walls)\\.)[^.]*\\.(.*)");
        std::regex_match(key, entry)) {
      text = base + std::regex_replace(key, entry, "$2") + " = " + set.substr(equals + 1) + "\n";
      key = std::regex_replace(key, entry, "$1$2");
    } else if (!set.empty()) {
      text = key + " = " + set.substr(equals + 1) + "\n" + base;
    }
    key = say("key", key);
    out.push_back({say("rule", "range"), base, say("text", text), set, say("set_says", set), key,
                   say("file_key", key), each["message"], each.value("engine", true),
                   each.value("front_ends", true)});
  }
  return out;
}

// The scene as code would make it: no rule is asked, numbers have no ranges, and nothing is known
// of a text.
Scene made_in_code(const std::string& text) {
  Scene scene;
  const Document document(text, "text", {});
  for (const Entry& entry : document.entries()) {
    const SceneSection* section = find_scene_section(entry.section);
    if (entry.is_head) {
      if (section->is_repeated()) section->entries.append(scene);
      continue;
    }
    const SceneKey* key = find_scene_key(entry.section, entry.key);
    if (!key->store(scene, entry.value, ValueRange{})) {
      // Words that are not known, which no reader stores.
      const std::string word = *entry.value.as<std::string>();
      if (entry.key == "packing") scene.initial.packing = word;
      if (entry.key == "search") scene.engine.search = word;
    }
  }
  if (!scene.species.empty()) scene.needles.count = scene.composition().count();
  return scene;
}

std::string refusal_of(const Scene& scene) {
  return test::refusal([&] { const Simulation simulation(scene); });
}

std::string refusal_by_c(const std::string& text) {
  needlework_error error{};
  needlework_simulation* simulation = needlework_create(text.c_str(), 0, &error);
  EXPECT_EQ(simulation, nullptr) << text;
  EXPECT_EQ(error.code, NEEDLEWORK_INPUT) << text;
  needlework_destroy(simulation);
  return error.message;
}

std::string refusal_over_a_pipe(const std::string& text) {
  std::stringstream in(Json{{"do", "create"}, {"scene", text}}.dump() + "\n"), out;
  serve::serve(in, out);
  std::string line;
  std::getline(out, line);
  return Json::parse(line).value("message", "accepted");
}

// "PLACE: message", where the place names the key; of a scene as a whole, it is the scene.
void expect_place_and_message(const std::string& found, const std::string& begin,
                              const std::string& key, const InvalidScene& scene) {
  EXPECT_TRUE(found.starts_with(begin)) << found << "\nof " << scene.rule;
  EXPECT_TRUE(contains(found, key.empty() ? begin : key));
  EXPECT_TRUE(found.ends_with(": " + scene.message))
      << found << "\nexpected " << scene.message << "\nof " << scene.rule;
}

std::string last_line(const std::string& text) {
  const std::string all = text.substr(0, text.find_last_not_of('\n') + 1);
  return all.substr(all.rfind('\n') + 1);
}

using OneValidity = ProgramTest;

TEST_F(OneValidity, OfAFileAndOfOverrides) {
  for (const InvalidScene& each : invalid_scenes()) {
    write("s.toml", each.text);
    const Outcome outcome = run("check s.toml");
    EXPECT_EQ(outcome.exit_code, 3) << each.rule;
    expect_place_and_message(
        last_line(outcome.err),
        each.key.empty() ? "needlework: s.toml: " : "needlework: s.toml: line ", each.file_key,
        each);
    if (each.set.empty()) continue;
    write("s.toml", each.base);
    std::string quoted;  // for the shell
    for (const char c : each.set) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    const Outcome set = run("check s.toml --set '" + quoted + "'");
    EXPECT_EQ(set.exit_code, 3) << each.rule;
    EXPECT_EQ(last_line(set.err), "needlework: --set " + each.set_says + ": " + each.message)
        << each.rule;
  }
}

TEST_F(OneValidity, OfCAndOfAPipe) {
  for (const InvalidScene& each : invalid_scenes()) {
    if (!each.front_ends) continue;
    const std::string place = each.key.empty() ? "scene: " : "scene: line ";
    expect_place_and_message(refusal_by_c(each.text), place, each.file_key, each);
    expect_place_and_message(refusal_over_a_pipe(each.text), place, each.file_key, each);
  }
}

TEST_F(OneValidity, OfASceneMadeInCode) {
  for (const InvalidScene& each : invalid_scenes()) {
    if (!each.engine) continue;
    expect_place_and_message(refusal_of(made_in_code(each.text)), "the scene: " + each.key,
                             each.key, each);
  }
}

// And with what completes or restores a scene.
TEST_F(OneValidity, OfACheckpoint) {
  constexpr Aspects asked = Aspect::species | Aspect::bodies | Aspect::pairs | Aspect::effects |
                            Aspect::output | Aspect::room | Aspect::sizes;
  int refused = 0;
  for (const InvalidScene& each : invalid_scenes()) {
    const Scene scene = made_in_code(each.text);
    const bool is_asked =
        each.rule == "range" || std::ranges::any_of(scene_rules(), [&](const SceneRule& rule) {
          return asked.has(rule.aspect) && rule.violation(scene);
        });
    // A checkpoint has the sum of all counts as well, which is out of its range.
    if (!is_asked || each.rule == "more needles than ids") continue;
    // Built in code, a distribution always has a shape.
    if (each.rule == "distribution is missing") continue;
    ++refused;
    expect_place_and_message(test::refusal([&] { require_restored(scene); }),
                             "the scene: " + each.key, each.key, each);
  }
  EXPECT_GT(refused, 40);
}

// Each rule is broken by a scene of the table, but for those of restored scenes, which
// tests/scene/restored_scene.cpp has, and the one about this processor.
TEST_F(OneValidity, IsTestedOfEveryRule) {
  std::set<std::size_t> broken;
  const auto rules = scene_rules();
  for (const InvalidScene& each : invalid_scenes()) {
    if (each.rule == "range") continue;
    Scene scene = made_in_code(each.text);
    for (std::size_t n = 0; n < rules.size(); ++n) {
      if (rules[n].violation(scene)) broken.insert(n);
    }
  }
  Scene other;
  other.engine.isa = "bogus";
  for (std::size_t n = 0; n < rules.size(); ++n) {
    if (rules[n].aspect == Aspect::restored) continue;
    if (rules[n].aspect == Aspect::machine && rules[n].violation(other)) continue;
    EXPECT_TRUE(broken.contains(n))
        << "rule " << n << " of aspect " << static_cast<unsigned>(rules[n].aspect);
  }
}

}  // namespace
}  // namespace needlework::one_validity
