// What a front end over a pipe gets: the runs of the program, and an answer to every line.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>
#include <sstream>
#include <string>
#include <vector>

#include "needlework/error.h"
#include "needlework/h5md.h"
#include "needlework/parse.h"
#include "needlework/simulation.h"
#include "src/json/base64.h"
#include "src/serve/requests.h"
#include "src/serve/server.h"
#include "tests/support/contains.h"
#include "tests/support/temporary_folder.h"

namespace needlework::serve {
namespace {

using json::base64_of;
using json::bytes_of;
using json::rows_of;
using json::text_of;

const std::string scene_text =
    "[needles]\ncount = 60\nbox = 5\n[collisions]\nepsilon = 0.9\n[until]\ncollisions_per_needle = "
    "4\n";

// Callers keep the answers in a variable that is not const, so that a field that is missing reads
// as null and fails the test: on a const object, `[]` of a missing field is undefined behaviour.
std::vector<Json> answers_to(const std::vector<Json>& requests) {
  std::stringstream in, out;
  for (const Json& request : requests) in << request.dump() << "\n";
  serve(in, out);
  std::vector<Json> answers;
  for (std::string line; std::getline(out, line);) answers.push_back(Json::parse(line));
  return answers;
}

std::vector<Json> answers_to_text(const std::string& text) {
  std::stringstream in(text), out;
  serve(in, out);
  std::vector<Json> answers;
  for (std::string line; std::getline(out, line);) answers.push_back(Json::parse(line));
  return answers;
}

Json create_elastic() { return {{"do", "create"}, {"scene", "[needles]\ncount = 60\nbox = 5"}}; }

Json create() { return {{"do", "create"}, {"scene", scene_text}}; }

std::string hash_of_whole_run() {
  const Scene scene = parse_scene(scene_text, "scene");
  Simulation simulation(scene);
  simulation.advance(scene.until);
  return simulation.trajectory_hash();
}

TEST(Serve, GivesTheTrajectoryOfTheLibraryInPieces) {
  auto answers =
      answers_to({create(),
                  {{"do", "advance"}, {"simulation", 1}, {"collisions", 50}, {"id", "a"}},
                  {{"do", "run_until"}, {"simulation", 1}, {"collisions", 70}, {"id", 7}},
                  {{"do", "run_until"}, {"simulation", 1}}});
  ASSERT_EQ(answers.size(), 4u);
  EXPECT_EQ(answers[0]["needles"], 60);
  EXPECT_EQ(answers[1]["id"], "a");
  EXPECT_EQ(answers[1]["collisions"], 50);
  EXPECT_EQ(answers[2]["id"], 7);
  EXPECT_EQ(answers[2]["collisions"], 70);
  EXPECT_EQ(answers[3]["stop"], "collisions");
  EXPECT_EQ(answers[3]["trajectory_hash"], hash_of_whole_run());
}

TEST(Serve, StartsFromTheBoxThatPistonsHaveLeft) {
  const std::string walls =
      "walls = [{ axis = \"z\", side = \"low\", motion = { velocity = 0.5 } },\n"
      "         { axis = \"z\", side = \"high\" }]\n";
  const Json advance{{"do", "advance"}, {"simulation", 1}, {"time", 2}};
  auto first =
      answers_to({{{"do", "create"}, {"scene", "needles = { count = 60, box = 5 }\n" + walls}},
                  advance,
                  {{"do", "state"}, {"simulation", 1}},
                  {{"do", "state"}, {"simulation", 1}, {"arrays", {"low"}}}});
  Json& state = first[2];
  EXPECT_EQ(state["box"], Json({5.0, 5.0, 4.0}));
  EXPECT_EQ(state["low"], Json({0.0, 0.0, 1.0}));
  EXPECT_EQ(first[3]["low"], state["low"]);
  EXPECT_FALSE(first[3].contains("box"));
  Json again{{"do", "create"}, {"scene", "needles.count = 60\n" + walls}};
  for (const char* name : {"position", "velocity", "orientation", "angular_velocity", "image",
                           "needle_id", "species", "bodies", "box", "low"})
    again[name] = state[name];
  Json bad = again;
  bad["low"] = {0, 0};
  auto second = answers_to({again,
                            {{"do", "state"}, {"simulation", 1}},
                            bad,
                            create_elastic(),
                            {{"do", "state"}, {"simulation", 2}},
                            {{"do", "state"}, {"simulation", 2}, {"arrays", {"box", "low"}}}});
  ASSERT_EQ(second[0]["ok"], true) << second[0];
  EXPECT_EQ(second[0]["box"], state["box"]);
  EXPECT_EQ(second[1]["low"], Json({0.0, 0.0, 0.0}));
  const auto before = rows_of<double>(state["position"].get<std::string>(), "a number");
  const auto after = rows_of<double>(second[1]["position"].get<std::string>(), "a number");
  for (std::size_t n = 2; n < before.size(); n += 3) EXPECT_EQ(after[n], before[n] - 1);
  EXPECT_EQ(second[2]["message"], "low = [0,0]: expected three numbers");
  // Of walls at rest, or none, only if asked for.
  EXPECT_FALSE(second[4].contains("box"));
  EXPECT_EQ(second[5]["box"], Json({5.0, 5.0, 5.0}));
  EXPECT_EQ(second[5]["low"], Json({0.0, 0.0, 0.0}));
}

// Whose bodies differ, and of which some are fixed: JSON has no infinity, arrays in base64 have.
TEST(Serve, GivesAndTakesBodiesThatDiffer) {
  const std::string drawn =
      "needles.box = 6\n[[species]]\nname = \"a\"\ncount = 40\nmass.density = 2\n"
      "length = { distribution = \"uniform\", mean = 1, width = 0.3 }\n"
      "[[species]]\nname = \"wall\"\ncount = 5\nfixed = true\n";
  auto first = answers_to({{{"do", "create"}, {"scene", drawn}},
                           {{"do", "advance"}, {"simulation", 1}, {"collisions", 30}},
                           {{"do", "state"}, {"simulation", 1}}});
  Json& state = first[2];
  EXPECT_TRUE(state["bodies"]["mass"][1].is_null());
  const auto masses = rows_of<double>(state["mass"].get<std::string>(), "a number");
  ASSERT_EQ(masses.size(), 45u);
  EXPECT_TRUE(std::isinf(masses[44]));
  Json again{{"do", "create"}, {"scene", "needles.box = 6\n"}};
  for (const char* name :
       {"position", "orientation", "velocity", "angular_velocity", "image", "needle_id", "species",
        "bodies", "length", "diameter", "mass", "inertia"})
    again[name] = state[name];
  Json bad = again;
  std::vector<double> negative(45, 1.0);
  negative[3] = -1;
  bad["length"] = text_of(negative);
  Json few = again;
  few["inertia"] = text_of(std::vector<double>(3, 1.0));
  auto second = answers_to({again, {{"do", "state"}, {"simulation", 1}}, bad, few});
  for (const char* name :
       {"position", "species", "bodies", "length", "diameter", "mass", "inertia"})
    EXPECT_EQ(second[1][name], state[name]) << name;
  EXPECT_TRUE(test::contains(second[2]["message"].get<std::string>(), "needle 3: length = -1"));
  EXPECT_EQ(second[3]["message"], "inertia: 3 numbers: expected 45");
}

TEST(Serve, SendsBodiesThatAreAlikeWhereTheyAreAskedFor) {
  auto answers = answers_to({create(),
                             {{"do", "state"}, {"simulation", 1}},
                             {{"do", "state"}, {"simulation", 1}, {"arrays", {"mass", "inertia"}}},
                             {{"do", "create"}, {"scene", "needles.box = 5\n"}, {"mass", 2}}});
  EXPECT_FALSE(answers[1].contains("mass"));
  EXPECT_EQ(answers[2]["mass"], text_of(std::vector<double>(60, 1)));
  EXPECT_EQ(answers[2]["inertia"], text_of(std::vector<double>(60, 1.0 / 12)));
  EXPECT_EQ(answers[3]["message"], "position, orientation: expected both, where a state is given");
}

TEST(Serve, GoesOnFromAStateThatItHasGiven) {
  auto first = answers_to({create(),
                           {{"do", "advance"}, {"simulation", 1}, {"collisions", 30}},
                           {{"do", "state"}, {"simulation", 1}}});
  Json& state = first[2];
  EXPECT_EQ(bytes_of(state["position"].get<std::string>()).size(), 60u * 24);
  EXPECT_EQ(bytes_of(state["needle_id"].get<std::string>()).size(), 60u * 4);
  EXPECT_EQ(bytes_of(state["image"].get<std::string>()).size(), 60u * 12);

  Json again{{"do", "create"}, {"scene", "[needles]\nbox = 5\n"}};
  for (const char* name :
       {"position", "velocity", "orientation", "angular_velocity", "image", "needle_id"}) {
    again[name] = state[name];
  }
  std::vector<std::uint32_t> ids(60);
  std::iota(ids.rbegin(), ids.rend(), 1000);
  Json other = again;
  other["needle_id"] = text_of(ids);
  auto second = answers_to({again,
                            {{"do", "totals"}, {"simulation", 1}},
                            {{"do", "state"}, {"simulation", 1}, {"id", "kept"}},
                            other,
                            {{"do", "state"}, {"simulation", 2}}});
  EXPECT_EQ(second[0]["needles"], 60) << second[0];
  EXPECT_EQ(second[1]["energy"], first[1]["energy"]);
  for (const char* name : {"position", "velocity", "image", "needle_id"}) {
    EXPECT_EQ(second[2][name], state[name]) << name;
  }
  EXPECT_NE(state["image"], text_of(std::vector<std::array<std::int32_t, 3>>(60)));
  EXPECT_EQ(second[2]["id"], "kept");
  std::reverse(ids.begin(), ids.end());
  EXPECT_EQ(second[4]["needle_id"], text_of(ids)) << "by increasing id";
  EXPECT_NE(second[4]["position"], state["position"]);
}

TEST(Serve, CountsContacts) {
  const std::string scene =
      "needles = { count = 60, box = 4 }\ncollisions = { epsilon = 0, sliding = true }\n";
  auto answers = answers_to({{{"do", "create"}, {"scene", scene}},
                             {{"do", "advance"}, {"simulation", 1}, {"collisions", 300}},
                             create(),
                             {{"do", "totals"}, {"simulation", 2}}});
  const Json& contacts = answers[1]["contacts"];
  EXPECT_GT(contacts["entered"], 20) << answers[1];
  EXPECT_GT(contacts["ended_by_tip"], 0);
  EXPECT_GT(contacts["time"], 0);
  EXPECT_EQ(contacts["share"],
            2 * contacts["time"].get<double>() / (60 * answers[1]["time"].get<double>()));
  EXPECT_FALSE(answers[3].contains("contacts"));
}

TEST(Serve, KnowsSpecies) {
  const std::string species =
      "[[species]]\nname = 'short'\nlength = 0.5\n[[species]]\nname = 'rod'\nmass = 4\n";
  const std::string counted =
      "needles.box = 5\n[[species]]\nname = 'short'\nlength = 0.5\ncount = 40\n"
      "[[species]]\nname = 'rod'\nmass = 4\ncount = 20\n";
  auto first = answers_to({{{"do", "create"}, {"scene", counted}},
                           {{"do", "advance"}, {"simulation", 1}, {"collisions", 100}},
                           {{"do", "state"}, {"simulation", 1}}});
  EXPECT_EQ(first[0]["needles"], 60) << first[0];
  EXPECT_EQ(first[1]["species"][1]["name"], "rod");
  EXPECT_EQ(first[1]["species"][1]["count"], 20);
  const auto& by_pair = first[1]["collisions_by_pair"];
  EXPECT_EQ(by_pair["short-short"].get<int>() + by_pair["short-rod"].get<int>() +
                by_pair["rod-rod"].get<int>(),
            100);
  std::vector<std::uint8_t> indices(60, 0);
  std::fill(indices.begin() + 40, indices.end(), 1);
  EXPECT_EQ(first[2]["species"], text_of(indices));

  Json again{{"do", "create"}, {"scene", "needles.box = 5\n" + species}};
  for (const char* name : {"position", "velocity", "orientation", "angular_velocity", "species"}) {
    again[name] = first[2][name];
  }
  Json short_one = again;
  short_one["species"] = text_of(std::vector<std::uint8_t>(3));
  auto second = answers_to({again,
                            {{"do", "totals"}, {"simulation", 1}},
                            {{"do", "state"}, {"simulation", 1}, {"arrays", {"species"}}},
                            short_one});
  EXPECT_NEAR(second[1]["species"][0]["t_tr"].get<double>(),
              first[1]["species"][0]["t_tr"].get<double>(), 1e-14);
  EXPECT_EQ(second[2]["species"], text_of(indices));
  EXPECT_EQ(second[3]["message"], "species: 3 rows: expected 60");
  // A scene without [[species]] says nothing of them, but that all needles are of one.
  auto one = answers_to(
      {create(), {{"do", "totals"}, {"simulation", 1}}, {{"do", "state"}, {"simulation", 1}}});
  EXPECT_FALSE(one[1].contains("species"));
  EXPECT_EQ(one[2]["species"], text_of(std::vector<std::uint8_t>(60)));
}

TEST(Serve, ReplacesVelocities) {
  const std::vector<std::array<double, 3>> ones(60, {1, 0, 0}), zeros(60);
  auto answers = answers_to({create(),
                             {{"do", "velocities"},
                              {"simulation", 1},
                              {"velocity", text_of(ones)},
                              {"angular_velocity", text_of(zeros)}},
                             {{"do", "advance"}, {"simulation", 1}, {"collisions", 1}}});
  EXPECT_EQ(answers[1]["energy"], 0.5) << answers[1];
  EXPECT_EQ(answers[2]["stop"], "nothing_can_happen");
}

TEST(Serve, StopsAllRotationWithAWordWhereNoneIsGiven) {
  const std::vector<std::array<double, 3>> ones(60, {1, 0, 0});
  auto answers = answers_to(
      {create(), {{"do", "velocities"}, {"simulation", 1}, {"velocity", text_of(ones)}}});
  EXPECT_EQ(answers[1]["t_rot"], 0) << answers[1];
  EXPECT_EQ(answers[1]["warning"], "angular_velocity: not given: those of all needles are 0 now");
}

// Rows of an array in an answer.
template <class Row>
std::vector<Row> rows_in(Json& answer, const char* name) {
  return rows_of<Row>(answer[name].get<std::string>(), "a row");
}

TEST(Serve, SendsAllCollisionsWhereTheyAreAskedFor) {
  auto answers = answers_to(
      {create(),
       {{"do", "advance"}, {"simulation", 1}, {"collisions", 25}, {"batch", 10}, {"id", "a"}},
       {{"do", "advance"}, {"simulation", 1}, {"collisions", 5}},
       {{"do", "run_until"},
        {"simulation", 1},
        {"collisions", 33},
        {"batch", 10},
        {"fields", {"pair", "velocity"}}}});
  ASSERT_EQ(answers.size(), 8u);
  std::vector<double> times;
  for (std::size_t n = 1; n < 4; ++n) {
    EXPECT_EQ(answers[n]["id"], "a");
    EXPECT_EQ(answers[n]["batch"], n < 3 ? 10 : 5);
    for (const double time : rows_in<double>(answers[n], "time")) times.push_back(time);
    EXPECT_EQ((rows_in<std::array<std::int32_t, 3>>(answers[n], "shift").size()),
              answers[n]["batch"].get<std::size_t>());
    EXPECT_EQ(rows_in<std::uint8_t>(answers[n], "tc").size(),
              answers[n]["batch"].get<std::size_t>());
    EXPECT_FALSE(answers[n].contains("velocity"));
  }
  const Scene scene = parse_scene(scene_text, "scene");
  Simulation simulation(scene);
  std::vector<Collision> expected;
  simulation.on_collision([&](const Collision& collision) { expected.push_back(collision); });
  simulation.advance(scene.until);
  ASSERT_EQ(times.size(), 25u);
  for (std::size_t n = 0; n < 25; ++n) EXPECT_EQ(times[n], expected[n].time);
  EXPECT_EQ(answers[4]["stop"], "collisions");
  EXPECT_EQ(answers[5]["collisions"], 30);
  // The last three, with the states after them.
  EXPECT_EQ(answers[6].size(), 4u) << answers[6];
  const auto pairs = rows_in<std::array<std::uint32_t, 2>>(answers[6], "pair");
  const auto velocities = rows_in<std::array<std::array<double, 3>, 2>>(answers[6], "velocity");
  ASSERT_EQ(pairs.size(), 3u);
  for (std::size_t n = 0; n < 3; ++n) {
    EXPECT_EQ(pairs[n][1], expected[30 + n].second);
    EXPECT_EQ(velocities[n][1], expected[30 + n].after[1].velocity);
  }
}

// In a gas without walls all that happens are collisions.
TEST(Serve, SendsAllThatHappensWhereItIsAskedFor) {
  auto answers =
      answers_to({create(),
                  {{"do", "advance"}, {"simulation", 1}, {"collisions", 9}, {"batch", 9}},
                  create(),
                  {{"do", "advance"},
                   {"simulation", 2},
                   {"collisions", 9},
                   {"batch", 9},
                   {"happenings", true}}});
  ASSERT_EQ(answers.size(), 6u);
  EXPECT_FALSE(answers[1].contains("kind"));
  EXPECT_EQ(rows_in<std::uint8_t>(answers[4], "kind"), std::vector<std::uint8_t>(9, 0));
  EXPECT_EQ(answers[4]["impulse"], answers[1]["impulse"]);
  EXPECT_EQ(answers[4]["pair"], answers[1]["pair"]);
}

TEST(Serve, RefusesBatchesAndFieldsThatMeanNothing) {
  auto answers = answers_to(
      {create(),
       {{"do", "advance"}, {"simulation", 1}, {"collisions", 1}, {"batch", 0}},
       {{"do", "advance"}, {"simulation", 1}, {"collisions", 1}, {"fields", {"time"}}},
       {{"do", "advance"}, {"simulation", 1}, {"collisions", 1}, {"batch", 1}, {"fields", "time"}},
       {{"do", "state"}, {"simulation", 1}, {"arrays", {"positions"}}},
       {{"do", "advance"}, {"simulation", 1}, {"collisions", 1}, {"happenings", true}},
       {{"do", "advance"},
        {"simulation", 1},
        {"collisions", 1},
        {"batch", 1},
        {"fields", {"kind"}}},
       {{"do", "totals"}, {"simulation", 1}}});
  ASSERT_EQ(answers.size(), 8u);
  for (std::size_t n = 1; n < 7; ++n) EXPECT_EQ(answers[n]["code"], 2) << answers[n];
  EXPECT_EQ(answers[7]["collisions"], 0);
}

TEST(Serve, HandsBodiesOverWithAState) {
  const char* rods =
      "needles.box = 9\n[[species]]\nname = \"rod\"\ncount = 4\nlength = 2\nmass = 4\nk = 2\n"
      "diameter = 0.5\n[[species]]\nname = \"ball\"\ncount = 3\nlength = 0\ndiameter = 1\n";
  auto first = answers_to({{{"do", "create"}, {"scene", rods}},
                           {{"do", "totals"}, {"simulation", 1}},
                           {{"do", "state"}, {"simulation", 1}}});
  Json again = first[2];
  for (const char* field : {"ok", "time", "needles"}) again.erase(field);
  again["do"] = "create";
  again["scene"] = "needles.box = 9";
  Json needles = again, wrong = again;
  needles["scene"] = "needles = { box = 9, k = 6 }";
  wrong["bodies"] = Json{{"colour", {1}}};
  auto second = answers_to({again, {{"do", "totals"}, {"simulation", 1}}, needles, wrong});
  EXPECT_EQ(second[1]["t_rot"], first[1]["t_rot"]) << second[1];
  EXPECT_EQ(second[1]["species"][1]["name"], "ball");
  EXPECT_EQ(second[2]["code"], 3) << second[2];
  EXPECT_EQ(second[3]["code"], 2) << second[3];
}

TEST(Serve, GoesOnFromAStateOfRoughSpheres) {
  const std::string rough = "needles.box = 9\ncollisions.beta = 0.5\n";
  const std::string species =
      "species = [ { name = \"s\", count = 20, length = 0, diameter = 0.8, inertia = 0.05 } ]\n";
  auto first = answers_to({{{"do", "create"}, {"scene", rough + species}},
                           {{"do", "totals"}, {"simulation", 1}},
                           {{"do", "state"}, {"simulation", 1}},
                           {{"do", "velocities"},
                            {"simulation", 1},
                            {"velocity", text_of(std::vector<std::array<double, 3>>(20))}}});
  EXPECT_NEAR(first[2]["bodies"]["inertia"][0].get<double>(), 0.05, 1e-16);
  EXPECT_TRUE(first[3].contains("warning")) << first[3];
  Json again = first[2];
  for (const char* field : {"ok", "time", "needles"}) again.erase(field);
  again["do"] = "create";
  again["scene"] = rough;
  auto second = answers_to({again, {{"do", "totals"}, {"simulation", 1}}});
  EXPECT_NEAR(second[1]["t_rot"].get<double>() / first[1]["t_rot"].get<double>(), 1, 1e-14);
}

TEST(Serve, SendsTheArraysOfAStateThatAreChosen) {
  auto answers =
      answers_to({create(),
                  {{"do", "state"}, {"simulation", 1}},
                  {{"do", "state"}, {"simulation", 1}, {"arrays", {"image", "velocity"}}}});
  EXPECT_EQ(answers[2]["velocity"], answers[1]["velocity"]);
  EXPECT_EQ(answers[2]["image"], answers[1]["image"]);
  EXPECT_EQ(answers[2].size(), 5u) << "ok, time and needles: " << answers[2];
}

TEST(Serve, CarriesDataOfTheFrontEnd) {
  const test::TemporaryFolder folder;
  const std::string output = folder.path() / "run.h5";
  Json run = create();
  run["scene"] = scene_text + "[output]\nfile = '" + output + "'\n";
  const Json notes{{"lid", "open"}, {"n", 3}}, none;
  auto first = answers_to(
      {run,
       {{"do", "data"}, {"simulation", 1}, {"name", "notes"}, {"json", notes}},
       {{"do", "data"}, {"simulation", 1}, {"name", "none"}, {"json", none}},
       {{"do", "data"}, {"simulation", 1}, {"name", "bytes"}, {"bytes", "AP8="}},
       {{"do", "data"}, {"simulation", 1}, {"name", "gone"}, {"json", 1}},
       {{"do", "data"}, {"simulation", 1}, {"name", "gone"}, {"remove", true}},
       {{"do", "sample"}, {"simulation", 1}, {"frame", true}},
       {{"do", "data"}, {"simulation", 1}, {"name", "gone"}},
       {{"do", "data"}, {"simulation", 1}, {"name", "x"}, {"json", 1}, {"bytes", "AP8="}},
       {{"do", "close"}, {"simulation", 1}}});
  for (std::size_t n = 1; n < 7; ++n) EXPECT_EQ(first[n]["ok"], true) << first[n];
  EXPECT_EQ(first[7]["code"], 2) << first[7];
  EXPECT_EQ(first[8]["code"], 2) << first[8];
  auto second = answers_to({{{"do", "resume"}, {"file", output}},
                            {{"do", "data"}, {"simulation", 1}},
                            {{"do", "data"}, {"simulation", 1}, {"name", "bytes"}}});
  const Json expected{
      {"bytes", {{"bytes", "AP8="}}}, {"none", {{"json", none}}}, {"notes", {{"json", notes}}}};
  EXPECT_EQ(second[1]["data"], expected) << second[1];
  EXPECT_EQ(second[2]["bytes"], "AP8=");
}

// Rows of boxes have slid, and velocities are those in the laboratory.
TEST(Serve, GoesOnFromAShearedState) {
  const std::string sheared =
      "collisions = { epsilon = 0.9, tc_relative = 1e-3 }\nshear.rate = 1.5\n";
  auto first = answers_to(
      {{{"do", "create"}, {"scene", "needles = { count = 60, box = 4 }\n" + sheared}},
       {{"do", "advance"}, {"simulation", 1}, {"time", 1}},
       {{"do", "state"}, {"simulation", 1}},
       {{"do", "state"}, {"simulation", 1}, {"arrays", {"peculiar_velocity", "slide"}}}});
  Json& state = first[2];
  EXPECT_NEAR(state["slide"].get<double>(), std::fmod(1.5 * 4, 4), 1e-9);
  EXPECT_EQ(state["shear_rate"], 1.5);
  EXPECT_FALSE(state.contains("peculiar_velocity")) << "but where it is asked for";
  EXPECT_EQ(first[3]["slide"], state["slide"]);
  EXPECT_FALSE(first[3].contains("shear_rate"));
  Json again = state;
  for (const char* field : {"ok", "time", "needles"}) again.erase(field);
  again["do"] = "create";
  again["scene"] = "needles.box = 4\n" + sheared;
  Json beside = again, both = again, still = again, few = again;
  beside.erase("velocity");
  beside.erase("shear_rate");
  beside["peculiar_velocity"] = first[3]["peculiar_velocity"];
  both["peculiar_velocity"] = first[3]["peculiar_velocity"];
  still["scene"] = "needles.box = 4\n";
  few.erase("velocity");
  few["peculiar_velocity"] = text_of(std::vector<std::array<double, 3>>(3));
  auto second = answers_to({again,
                            {{"do", "state"}, {"simulation", 1}},
                            {{"do", "totals"}, {"simulation", 1}},
                            beside,
                            {{"do", "totals"}, {"simulation", 2}},
                            both,
                            still,
                            few,
                            create(),
                            {{"do", "state"}, {"simulation", 3}},
                            {{"do", "state"},
                             {"simulation", 3},
                             {"arrays", {"slide", "velocity", "peculiar_velocity"}}}});
  ASSERT_EQ(second[0]["ok"], true) << second[0];
  for (const char* field : {"slide", "shear_rate", "position", "velocity", "image"})
    EXPECT_EQ(second[1][field], state[field]) << field;
  EXPECT_NEAR(second[2]["energy"].get<double>(), first[1]["energy"].get<double>(), 1e-12);
  ASSERT_EQ(second[3]["ok"], true) << second[3];
  EXPECT_NEAR(second[4]["energy"].get<double>(), first[1]["energy"].get<double>(), 1e-12);
  EXPECT_EQ(second[5]["message"], "velocity, peculiar_velocity: expected one of them");
  EXPECT_TRUE(
      test::contains(second[6]["message"].get<std::string>(), "expected a scene with [shear]"));
  EXPECT_EQ(second[7]["message"], "peculiar_velocity: 3 rows: expected 60");
  EXPECT_FALSE(second[9].contains("slide"));
  EXPECT_EQ(second[10]["slide"], 0);
  EXPECT_EQ(second[10]["peculiar_velocity"], second[10]["velocity"]);
}

// Whoever cannot complete a file tells so once, and leaves it to others.
TEST(Serve, LetsASimulationGoWhoseFileCannotBeCompleted) {
  const test::TemporaryFolder parent;
  const std::string folder = parent.path() / "there", away = parent.path() / "away",
                    output = folder + "/run.h5";
  std::filesystem::create_directory(folder);
  Requests requests;
  const Connection connection{.interrupted = [] { return false; }, .notify = [](const Json&) {}};
  const auto ask = [&](const Json& request) { return requests.answer(request, connection); };
  Json run = create();
  run["scene"] = scene_text + "[output]\nfile = '" + output + "'\n";
  ask(run);
  ask({{"do", "advance"}, {"simulation", 1u}, {"collisions", 50u}});
  ask({{"do", "checkpoint"}, {"simulation", 1u}});
  std::filesystem::rename(folder, away);
  EXPECT_THROW(ask({{"do", "close"}, {"simulation", 1u}}), IoError);
  EXPECT_THROW(ask({{"do", "close"}, {"simulation", 1u}}), RequestError) << "it is gone";
  std::filesystem::rename(away, folder);
  EXPECT_EQ(ask({{"do", "resume"}, {"file", output}})["simulation"], 2);
  EXPECT_EQ(ask({{"do", "run_until"}, {"simulation", 2u}})["trajectory_hash"], hash_of_whole_run());
}

TEST(Serve, EndsWhereTheSceneSaysHowFarBodiesGrow) {
  const std::string growth = "driving.growth = { rate = 0.1, until_packing = 0.15 }\n";
  auto answers = answers_to(
      {{{"do", "create"},
        {"scene", "needles = { count = 60, box = 6, diameter = 0.3 }\n" + growth}},
       {{"do", "run_until"}, {"simulation", 1}},
       create_elastic(),
       {{"do", "run_until"}, {"simulation", 2}},
       {{"do", "create"}, {"scene", "needles = { count = 60, box = 6, diameter = 0.2 }\n"}},
       {{"do", "state"}, {"simulation", 3}}});
  EXPECT_EQ(answers[1]["stop"], "grown") << answers[1];
  EXPECT_EQ(answers[3]["code"], 2) << answers[3];
  // Sizes that a front end gives grow, too.
  Json own{{"do", "create"}, {"scene", "needles.box = 6\n" + growth}, {"diameter", 0.2}};
  for (const char* name : {"position", "orientation", "velocity", "angular_velocity"})
    own[name] = answers[5][name];
  auto second = answers_to({own, {{"do", "run_until"}, {"simulation", 1}}});
  ASSERT_EQ(second[0]["ok"], true) << second[0];
  EXPECT_EQ(second[1]["stop"], "grown") << second[1];
}

TEST(Serve, HasAVersionAndCapabilities) {
  auto answers = answers_to({{{"do", "version"}}, {{"do", "version"}, {"simulation", 1}}});
  EXPECT_TRUE(test::contains(answers[0].value("version", ""), ".")) << answers[0];
  for (const char* name : {"files/h5md", "isa/scalar", "effect/growth"}) {
    const Json& all = answers[0]["capabilities"];
    EXPECT_NE(std::find(all.begin(), all.end(), name), all.end()) << name;
  }
  EXPECT_EQ(answers[1]["code"], 2);
  EXPECT_EQ(answers[1]["message"], "simulation = 1: expected one of the fields do, id");
}

TEST(Serve, WritesStatesAndOutput) {
  const test::TemporaryFolder folder;
  const std::string state = folder.path() / "state.h5", output = folder.path() / "run.h5";
  Json run = create();
  run["scene"] = scene_text + "[output]\nfile = '" + output + "'\n";
  auto answers = answers_to({run,
                             {{"do", "run_until"}, {"simulation", 1}},
                             {{"do", "state"}, {"simulation", 1}, {"file", state}},
                             {{"do", "state"}, {"simulation", 1}, {"file", state}},
                             {{"do", "state"}, {"simulation", 1}, {"file", state}, {"force", true}},
                             {{"do", "close"}, {"simulation", 1}},
                             {{"do", "totals"}, {"simulation", 1}}});
  EXPECT_EQ(answers[3]["code"], 5);
  EXPECT_EQ(answers[4]["ok"], true);
  EXPECT_EQ(answers[5]["ok"], true);
  EXPECT_EQ(answers[6]["code"], 2);
  EXPECT_EQ(io::read_last_frame(state).size(), 60u);
  EXPECT_EQ(io::read_run(output).series.back().collisions, 120u);
}

TEST(Serve, ContinuesTheRunOfAFile) {
  const test::TemporaryFolder folder;
  const std::string output = folder.path() / "run.h5";
  Json run = create();
  run["scene"] = scene_text + "[output]\nfile = '" + output + "'\n";
  auto first = answers_to({run,
                           {{"do", "advance"}, {"simulation", 1}, {"collisions", 50}},
                           {{"do", "checkpoint"}, {"simulation", 1}},
                           {{"do", "advance"}, {"simulation", 1}, {"collisions", 20}},
                           {{"do", "resume"}, {"file", output}}});
  EXPECT_EQ(first[2]["ok"], true) << first[2];
  EXPECT_EQ(first[4]["code"], 5) << "it is being written: " << first[4];
  // The simulation was not closed, so that the 20 collisions are computed again.
  auto second = answers_to({{{"do", "resume"}, {"file", output}},
                            {{"do", "totals"}, {"simulation", 1}},
                            {{"do", "run_until"}, {"simulation", 1}},
                            {{"do", "close"}, {"simulation", 1}}});
  EXPECT_EQ(second[0]["simulation"], 1) << second[0];
  EXPECT_EQ(second[0]["needles"], 60);
  EXPECT_FALSE(second[0].contains("warning"));
  EXPECT_EQ(second[1]["collisions"], 50);
  EXPECT_EQ(second[2]["trajectory_hash"], hash_of_whole_run());
  EXPECT_EQ(io::read_run(output).series.back().collisions, 120u);

  std::filesystem::resize_file(output + ".checkpoint", 1000);
  auto third =
      answers_to({{{"do", "resume"}, {"file", output}}, {{"do", "run_until"}, {"simulation", 1}}});
  EXPECT_TRUE(test::contains(third[0].value("warning", ""), "damaged")) << third[0];
  EXPECT_EQ(third[1]["trajectory_hash"], hash_of_whole_run());
}

TEST(Serve, DoesNotReplaceAFileThatIsBeingWritten) {
  const test::TemporaryFolder folder;
  const std::string output = folder.path() / "run.h5";
  Json run = create();
  run["scene"] = scene_text + "[output]\nfile = '" + output + "'\n";
  run["force"] = true;
  const Json save{{"do", "state"}, {"simulation", 2}, {"file", output}, {"force", true}};
  auto answers =
      answers_to({run, run, create(), save, {{"do", "close"}, {"simulation", 1}}, save, run});
  const std::string refusal = "cannot be replaced: another program or simulation has the file open";
  for (const std::size_t refused : {1, 3}) {
    EXPECT_EQ(answers[refused]["code"], 5) << answers[refused];
    EXPECT_TRUE(test::contains(answers[refused].dump(), refusal)) << answers[refused];
  }
  for (const std::size_t done : {0, 2, 4, 5, 6})
    EXPECT_EQ(answers[done]["ok"], true) << answers[done];
}

TEST(Serve, SaysWhyARunCannotBeSavedOrContinued) {
  auto answers = answers_to({create(),
                             {{"do", "checkpoint"}, {"simulation", 1}},
                             {{"do", "checkpoint"}, {"simulation", 2}},
                             {{"do", "resume"}},
                             {{"do", "resume"}, {"file", "none.h5"}},
                             {{"do", "resume"}, {"path", "none.h5"}}});
  const auto expect = [&](int n, int code, const std::string& begin) {
    EXPECT_EQ(answers[n]["code"], code) << answers[n];
    EXPECT_EQ(answers[n].value("message", "").substr(0, begin.size()), begin);
  };
  expect(1, 2, "the simulation has no output file");
  expect(2, 2, "simulation = 2: expected ");
  expect(3, 2, "file: expected the output file of a run");
  expect(4, 5, "none.h5: cannot be read: No such file or directory");
  expect(5, 2, "path = \"none.h5\": expected one of the fields do, ");
}

// The reader sees the interruption while the advance before it waits or runs. On a busy machine
// that may take long, and a gas that cools could collapse first: this one does not.
TEST(Serve, InterruptsWhatWasSentBefore) {
  auto answers = answers_to({create_elastic(),
                             {{"do", "advance"}, {"simulation", 1}, {"time", 1e12}},
                             {{"do", "interrupt"}},
                             {{"do", "advance"}, {"simulation", 1}, {"collisions", 10}}});
  EXPECT_EQ(answers[1]["stop"], "interrupted");
  EXPECT_EQ(answers[2]["ok"], true);
  EXPECT_EQ(answers[3]["stop"], "collisions");
}

TEST(Serve, ShowsProgressBeforeTheAnswer) {
  auto answers = answers_to({create_elastic(),
                             {{"do", "advance"},
                              {"simulation", 1},
                              {"time", 1e12},
                              {"wall_s", 0.5},
                              {"progress_s", 0},
                              {"id", 5}}});
  ASSERT_GT(answers.size(), 2u);
  EXPECT_EQ(answers[1]["id"], 5);
  EXPECT_GE(answers[1]["progress"], 0.0);
  EXPECT_EQ(answers.back()["stop"], "wall_time") << answers.back();
}

TEST(Serve, AnswersEveryLineThatItDoesNotUnderstand) {
  const std::string deep(100000, '[');
  auto answers = answers_to_text("hello\n\n[1]\n{\"do\": 5}\n{\"do\": \"fly\"}\n{}\n" + deep +
                                 "\n\"\xff\"\n" + "{\"time\": 1e999}\n1e999\n{\"id\": " + deep +
                                 std::string(deep.size(), ']') + "}\n" + create().dump() + "\n");
  ASSERT_EQ(answers.size(), 12u);
  for (int n = 0; n < 11; ++n) {
    EXPECT_EQ(answers[n]["ok"], false);
    EXPECT_EQ(answers[n]["code"], 2) << answers[n];
  }
  EXPECT_EQ(answers[0]["message"], "line 1: no JSON at byte 1: expected a JSON object");
  EXPECT_EQ(answers[1]["message"], "line 2: no JSON at byte 1: expected a JSON object");
  EXPECT_EQ(answers[2]["message"], "line 3: expected a JSON object");
  EXPECT_EQ(answers[5]["message"].get<std::string>().substr(0, 13), "do is missing");
  EXPECT_EQ(answers[8]["message"], "line 9: expected numbers that a double can hold");
  EXPECT_EQ(answers[10]["message"], "line 11: expected values in at most 100 levels");
  EXPECT_EQ(answers[11]["ok"], true);
}

TEST(Serve, NamesTheFieldThatIsWrong) {
  const auto message = [](Json request) {
    if (!request.contains("simulation")) request["simulation"] = 1;
    auto answers = answers_to({create(), request});
    EXPECT_EQ(answers[1]["ok"], false) << request;
    return answers[1].value("message", "");
  };
  EXPECT_EQ(message({{"do", "advance"}, {"time", "soon"}}), "time = \"soon\": expected a number");
  EXPECT_EQ(message({{"do", "advance"}, {"collisions", -1}}),
            "collisions = -1: expected a whole number >= 0");
  EXPECT_EQ(message({{"do", "advance"}, {"time", 1}, {"progress_s", -1}}),
            "progress_s = -1: expected a number >= 0");
  EXPECT_EQ(message({{"do", "state"}, {"file", std::string("a\0b.h5", 6)}}),
            "file = \"a\\u0000b.h5\": expected text without zero bytes");
  EXPECT_EQ(message({{"do", "advance"}, {"collisons", 1}}).substr(0, 46),
            "collisons = 1: expected one of the fields do, ");
  EXPECT_TRUE(test::contains(message({{"do", "advance"}}), "no end condition"));
  EXPECT_EQ(message({{"do", "totals"}, {"simulation", 2}}),
            "simulation = 2: expected the number of a simulation that is not closed");
  EXPECT_EQ(message({{"do", "velocities"}, {"velocity", "AAA"}}),
            "velocity = \"AAA\": expected base64 with padding");
  EXPECT_EQ(message({{"do", "velocities"}, {"velocity", "AAA!"}}),
            "velocity = \"AAA!\": expected base64");
  EXPECT_EQ(message({{"do", "velocities"}, {"velocity", "AAAA"}}),
            "velocity = \"AAAA\": expected three numbers of 8 bytes for each needle, in base64");
  const std::vector<std::array<double, 3>> ones(2, {1, 0, 0});
  const Json state{{"do", "create"},
                   {"scene", "[needles]\nbox = 5\n"},
                   {"position", text_of(ones)},
                   {"orientation", text_of(ones)}};
  const auto message_with = [&](const char* field, const std::string& text) {
    Json request = state;
    request[field] = text;
    return answers_to({request})[0].value("message", "");
  };
  EXPECT_EQ(message_with("image", ""), "image: 0 rows: expected 2");
  EXPECT_EQ(message_with("image", "AAAA"),
            "image = \"AAAA\": expected three whole numbers of 4 bytes for each needle, in base64");
  EXPECT_EQ(message_with("needle_id", text_of(std::vector<std::uint32_t>{1})),
            "needle_id: 1 rows: expected 2");
  EXPECT_EQ(
      message_with("needle_id", "AAAA"),
      "needle_id = \"AAAA\": expected one whole number of 4 bytes for each needle, in base64");
  EXPECT_EQ(message_with("needle_id", text_of(std::vector<std::uint32_t>{7, 7})),
            "state: id 7 twice: expected distinct ids");
  EXPECT_EQ(message_with("image", text_of(std::vector<std::array<std::int32_t, 3>>(
                                      2, {0, std::numeric_limits<std::int32_t>::min(), 0}))),
            "state: needle 0: image = -2147483648: expected a whole number from -2147481599 to "
            "2147481599");
  auto answers = answers_to({{{"do", "create"}, {"scene", "[needles]\ncount = -5\nbox = 5"}}});
  EXPECT_EQ(answers[0]["code"], 3);
  EXPECT_EQ(answers[0]["message"].get<std::string>().substr(0, 34),
            "scene: line 2: needles.count = -5:");
}

TEST(Base64, IsThatOfRfc4648) {
  const auto text = [](std::string_view bytes) {
    return base64_of(std::as_bytes(std::span(bytes.data(), bytes.size())));
  };
  EXPECT_EQ(text(""), "");
  EXPECT_EQ(text("f"), "Zg==");
  EXPECT_EQ(text("fo"), "Zm8=");
  EXPECT_EQ(text("foo"), "Zm9v");
  EXPECT_EQ(text("foob"), "Zm9vYg==");
  EXPECT_EQ(text("foobar"), "Zm9vYmFy");
  for (const std::string word : {"", "f", "fo", "foo", "foob", "fooba", "foobar"}) {
    const std::vector<std::byte> bytes = bytes_of(text(word));
    EXPECT_EQ(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()), word);
  }
  EXPECT_THROW(bytes_of("===="), std::invalid_argument);
  EXPECT_THROW(bytes_of("A==="), std::invalid_argument);
}

}  // namespace
}  // namespace needlework::serve
