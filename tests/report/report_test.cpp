// What pages hold of files with known numbers.
#include "src/report/report.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <string>

#include "needlework/error.h"
#include "needlework/h5md.h"
#include "needlework/parse.h"
#include "src/picture/needle_values.h"
#include "src/report/page.h"
#include "tests/report/page_data.h"
#include "tests/support/contains.h"
#include "tests/support/message_of.h"
#include "tests/support/temporary_folder.h"

namespace needlework {
namespace {

using nlohmann::json;

constexpr int samples = 7;

class Report : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name)) << text;
  }

  // A run of `needles` needles with samples and frames whose numbers follow from their places.
  void write_run(const std::string& name, const std::string& title = "known numbers",
                 std::uint64_t needles = 3, int frames = 2,
                 const std::string& surroundings = "") const {
    Scene scene = parse_scene("title = " + nlohmann::json(title).dump() +
                                  "\nneedles = { count = " + std::to_string(needles) +
                                  ", box = [4, 5, 6] }\nuntil.time = 1\n" + surroundings,
                              "scene", std::vector<std::string>{"collisions.epsilon=0.75"});
    scene.needles.count = needles;
    io::RunInfo info{"scalar", 2, 1.0};
    info.series = {{"pairs", "Pairs of numbers", {{"pair", "Pair", "", {{"numbers", 2}}}}}};
    io::Writer writer(path(name), true, scene, info);
    for (int n = 0; n < samples; ++n)
      writer.write_series(totals(n), std::vector{1.0 * n, -1.0 * n});
    for (int n = 0; n < frames; ++n) writer.write_frame(totals(n), state(needles, n));
    writer.close();
  }

  static Totals totals(int n) {
    Totals out;
    out.time = 0.1 * n;
    out.t_tr = 1.0 / (3 + n);
    out.t_rot = 1.0 / (7 + n);
    out.energy = 1.5 * out.t_tr + out.t_rot;
    out.momentum = {0.1 * n, -0.2 * n, 1e-17};
    out.collisions = (std::uint64_t{1} << 40) + n;
    return out;
  }

  static State state(std::uint64_t needles, int frame) {
    State state;
    state.box = {4, 5, 6};
    state.resize(needles);
    for (std::uint32_t i = 0; i < needles; ++i) {
      state.id[i] = i;
      state.position[i] = {-1.0, 2.5, 6.0 * i / static_cast<double>(needles)};
      state.orientation[i] = {0, 0.6, -0.8};
      state.velocity[i] = {0, 3.0 * frame, -4.0 * frame};
      state.angular_velocity[i] = {2.0, 0, 0};
    }
    return state;
  }

  test::PageData page_of(std::vector<std::string> files, report::PageLimits limits = {}) const {
    for (std::string& file : files) file = path(file);
    report::write_report({files, path("page.html"), "", true, limits});
    return test::PageData(path("page.html"));
  }

  test::PageData page_of_run() const {
    write_run("run.h5");
    return page_of({"run.h5"});
  }
  // What is said of this file.
  std::string complaint(const std::string& file) const {
    return test::message_of<InputError>([&] {
      report::write_report({{path(file)}, path("page.html"), "", false, {}});
    });
  }

  test::TemporaryFolder folder_;
};

TEST_F(Report, HoldsSeriesBitForBit) {
  const test::PageData page = page_of_run();
  const json& group = page.json["sections"][0]["groups"]["totals"];
  EXPECT_EQ(group["rows"], samples);
  const auto times = page.numbers<double>(group["time"]);
  const auto t_tr = page.numbers<double>(group["datasets"]["t_tr"]);
  const auto momentum = page.numbers<double>(group["datasets"]["momentum"]);
  const auto collisions = page.numbers<double>(group["datasets"]["collisions"]);
  EXPECT_EQ(group["datasets"]["momentum"]["shape"], json({samples, 3}));
  ASSERT_EQ(times.size(), samples);
  ASSERT_EQ(momentum.size(), 3 * samples);
  for (int n = 0; n < samples; ++n) {
    EXPECT_EQ(times[n], totals(n).time);
    EXPECT_EQ(t_tr[n], totals(n).t_tr);
    EXPECT_EQ(momentum[3 * n + 1], totals(n).momentum[1]);
    EXPECT_EQ(collisions[n], static_cast<double>(totals(n).collisions));
  }
}

TEST_F(Report, DrawsEachNeedleAsLongAsItIs) {
  Scene scene = parse_scene("needles = { count = 3, box = 5 }\nuntil.time = 1\n", "scene");
  io::RunInfo info{"scalar", 1, 1.0};
  info.own_bodies = {
      .length = {1, 4, 2}, .diameter = {0, 0, 0}, .mass = {1, 1, 1}, .inertia = {1, 1, 1}};
  io::Writer writer(path("own.h5"), true, scene, info);
  writer.write_series(totals(0));
  writer.write_frame(totals(0), state(3, 0));
  writer.close();
  const test::PageData page = page_of({"own.h5"});
  const json& frames = page.json["sections"][0]["frames"];
  EXPECT_EQ(frames["length"], 4);
  EXPECT_EQ(page.numbers<float>(frames["share_of_length"]), (std::vector<float>{0.25, 1, 0.5}));
}

TEST_F(Report, HoldsObservablesWithTheirDescriptions) {
  const test::PageData page = page_of_run();
  const json& pair = page.json["sections"][0]["groups"]["pairs"]["datasets"]["pair"];
  EXPECT_TRUE(pair["description"].get<std::string>().starts_with("Pair"));
  EXPECT_EQ(pair["has_rows"], true);
  const auto values = page.numbers<double>(pair);
  ASSERT_EQ(values.size(), 2 * samples);
  EXPECT_EQ(values[4], 2);
  EXPECT_EQ(values[5], -2);
}

TEST_F(Report, NamesWhatWasRunWithTheKeysSetOverTheScene) {
  const test::PageData page = page_of_run();
  const json& run = page.json["sections"][0];
  EXPECT_EQ(run["scene"]["epsilon"], 0.75);
  EXPECT_EQ(run["scene"]["until"]["time"], 1);
  EXPECT_EQ(run["parameters"]["isa"]["value"], "scalar");
  EXPECT_EQ(run["parameters"]["threads"]["value"], 2);
  EXPECT_EQ(run["parameters"]["title"]["value"], "known numbers");
}

// Not once for each species, as what is of a species.
TEST_F(Report, ShowsContactsOfAMixtureOnce) {
  const Scene scene = parse_scene(
      "needles.box = 5\ncollisions = { epsilon = 0.5, sliding = true, sliding_below = 1e-4 }\n"
      "until.time = 1\n[[species]]\nname = \"a\"\ncount = 2\n"
      "[[species]]\nname = \"b\"\ncount = 1\nmass = 2\n",
      "scene", {});
  io::RunInfo info{"scalar", 2, 1.0};
  info.series = {{"contacts", "Contacts", {{"entered", "Number", "", {}}}},
                 {"displacement", "Of each species", {{"mean", "Mean", "", {{"species", 2}}}}}};
  io::Writer writer(path("run.h5"), true, scene, info);
  for (int n = 0; n < samples; ++n) writer.write_series(totals(n), std::vector{1.0 * n, 2.0, 3.0});
  State first = state(3, 0);
  first.species = {0, 0, 1};
  writer.write_frame(totals(0), first);
  writer.close();
  const test::PageData page = page_of({"run.h5"});
  const json& run = page.json["sections"][0];
  EXPECT_EQ(run["scene"]["sliding_below"], 1e-4);
  EXPECT_EQ(run["groups"]["contacts"]["description"], "Contacts.");
  ASSERT_EQ(run["parts"].size(), 2);
  for (const json& part : run["parts"]) {
    EXPECT_TRUE(part["groups"].contains("displacement"));
    EXPECT_FALSE(part["groups"].contains("contacts")) << part["name"];
  }
}

TEST_F(Report, DrawsNeedlesWhereTheyAre) {
  const test::PageData page = page_of_run();
  const json& frames = page.json["sections"][0]["frames"];
  ASSERT_EQ(frames["frames"].size(), 2);
  const json& frame = frames["frames"][1];
  EXPECT_EQ(frame["time"], 0.1);
  EXPECT_EQ(frames["box"], json({4.0, 5.0, 6.0}));
  EXPECT_EQ(frames["periodic"], json({true, true, true}));
  EXPECT_EQ(frames["walls"], json::array());
  EXPECT_EQ(frame["low"], json({0.0, 0.0, 0.0}));
  EXPECT_EQ(frame["high"], json({4.0, 5.0, 6.0}));
  const auto position = page.numbers<std::uint16_t>(frame["position"]);
  ASSERT_EQ(position.size(), 9);
  EXPECT_EQ(position[0], 3 * 65536 / 4);  // -1 is 3 in a box of 4
  EXPECT_EQ(position[1], 65536 / 2);
  EXPECT_EQ(position[8], 65536 * 2 / 3);
  const auto orientation = page.numbers<std::int16_t>(frame["orientation"]);
  EXPECT_EQ(orientation[1], std::lround(0.6 * 32767));
  EXPECT_EQ(orientation[2], std::lround(-0.8 * 32767));
  EXPECT_EQ(page.numbers<float>(frame["speed"])[0], 5);
  EXPECT_EQ(page.numbers<float>(frame["spin"])[0], 2);
  EXPECT_FLOAT_EQ(page.numbers<float>(frame["alignment"])[0], 2);  // flies along itself
  EXPECT_EQ(frames["flow_axis"], 2);                               // all fly along (0, 3, -4)
  EXPECT_FLOAT_EQ(page.numbers<float>(frame["flow"])[0], -4 * std::sqrt(3.0F) / 5);
  EXPECT_NEAR(page.numbers<float>(frames["frames"][0]["alignment"])[0], 0, 1e-6);  // at rest
}

TEST_F(Report, SaysHowBodiesTurnAndWhetherTheyAreSheared) {
  const auto scene_of = [&](double beta) {
    const Scene scene = parse_scene(
        R"(needles.box = 5
until.time = 1
shear.rate = -0.5
species = [{ name = "balls", count = 2, length = 0, diameter = 1 },
           { name = "rods", count = 1, diameter = 1 }]
pairs = [{ between = ["balls", "balls"], beta = )" +
            std::to_string(beta) + " }]\n",
        "scene", {});
    io::Writer writer(path("run.h5"), true, scene, {"scalar", 1, 1.0});
    State in_flow = state(3, 0);
    in_flow.peculiar_velocity = in_flow.velocity;
    writer.write_frame(totals(0), in_flow);
    writer.close();
    return page_of({"run.h5"}).json["sections"][0]["scene"];
  };
  for (const auto& [beta, of_spheres] : {std::pair{-1.0, 0}, {0.5, 3}}) {
    const json scene = scene_of(beta);
    EXPECT_EQ(scene["shear_rate"], -0.5);
    EXPECT_EQ(scene["species"][0]["rotations"], of_spheres);
    EXPECT_EQ(scene["species"][1]["rotations"], 2);
  }
}

// What their state said is missing from their scenes.
TEST_F(Report, ShowsTheScenesOfRunsFromAStateOfTheCaller) {
  for (const char* bodies : {"", "species = [{ name = \"a\" }]\n"}) {
    Scene scene = parse_scene(std::string("collisions.epsilon = 0.75\nshear.rate = 2\n") + bodies,
                              "scene", {}, {.state = true, .end = true});
    scene.needles.box = {4, 5, 6};
    scene.needles.count = 3;
    if (!scene.species.empty()) scene.species[0].count = 3;
    io::Writer writer(path("run.h5"), true, scene, {"scalar", 1, 1.0});
    State in_flow = state(3, 0);
    in_flow.peculiar_velocity = in_flow.velocity;
    writer.write_frame(totals(0), in_flow);
    writer.close();
    const json facts = page_of({"run.h5"}).json["sections"][0]["scene"];
    ASSERT_TRUE(facts.is_object());
    EXPECT_EQ(facts["epsilon"], 0.75);
    EXPECT_EQ(facts["shear_rate"], 2);
  }
}

TEST_F(Report, ColoursShearedGasesByTheirPeculiarVelocities) {
  const Scene scene = parse_scene(
      "needles = { count = 3, box = [4, 5, 6] }\nuntil.time = 1\nshear.rate = -0.5", "scene", {});
  io::Writer writer(path("run.h5"), true, scene, {"scalar", 1, 1.0});
  State in_flow = state(3, 1);
  in_flow.shear_rate = -0.5;
  in_flow.peculiar_velocity = in_flow.velocity;
  for (std::size_t i = 0; i < 3; ++i) {
    in_flow.velocity[i][0] += -0.5 * in_flow.position[i][1];
    in_flow.position[i][1] += 5;  // an image
    in_flow.velocity[i][0] += -0.5 * 5;
  }
  writer.write_frame(totals(0), in_flow);
  writer.close();
  const test::PageData page = page_of({"run.h5"});
  const json& frames = page.json["sections"][0]["frames"];
  EXPECT_EQ(frames["flow_axis"], 2);
  const auto speed = page.numbers<float>(frames["frames"][0]["speed"]);
  EXPECT_EQ(speed, (std::vector<float>{5, 5, 5}));
}

TEST_F(Report, ShowsWallsWhereTheyAreAndNeedlesBeyondOpenSides) {
  write_run("run.h5", "walls", 3, 2,
            "forces.gravity = [1, 0, -2]\n"
            "driving = { kicks = { every = 0.5, translational = 2 } }\n"
            "[[walls]]\naxis = \"z\"\nside = \"low\"\nepsilon = 0.5\n"
            "motion = { amplitude = 0.25, frequency = 2.5, phase = 0 }\n"
            "[[walls]]\naxis = \"x\"\nside = \"both\"\ntemperature = 3\n");
  const test::PageData page = page_of({"run.h5"});
  const json& frames = page.json["sections"][0]["frames"];
  EXPECT_EQ(frames["periodic"], json({false, true, false}));
  EXPECT_EQ(frames["walls"], json::parse(R"([
      {"axis": 2, "high": false, "kind": "moving wall"},
      {"axis": 0, "high": false, "kind": "thermal wall"},
      {"axis": 0, "high": true, "kind": "thermal wall"}])"));
  // Centres are at x = -1, and the floor has made a quarter of a turn at the second frame.
  EXPECT_EQ(frames["frames"][0]["walls"], json({0.0, 0.0, 4.0}));
  EXPECT_EQ(frames["frames"][0]["low"], json({-1.0, 0.0, 0.0}));
  EXPECT_NEAR(frames["frames"][1]["walls"][0].get<double>(), 0.25, 1e-12);
  // The side at z high is open: the picture ends with the highest centre.
  EXPECT_EQ(frames["frames"][1]["high"], json({4.0, 5.0, 4.0}));
  // Along walled axes nothing is wrapped.
  EXPECT_EQ(page.numbers<std::uint16_t>(frames["frames"][1]["position"])[0], 0);
  const json& scene = page.json["sections"][0]["scene"];
  EXPECT_EQ(scene["gravity"], json({1.0, 0.0, -2.0}));
  EXPECT_EQ(scene["walls"][0], json::parse(R"({"axis": "z", "side": "low", "epsilon": 0.5,
      "temperature": null, "motion": {"amplitude": 0.25, "frequency": 2.5, "phase": 0.0}})"));
  EXPECT_EQ(scene["walls"][2]["side"], "high");
  EXPECT_EQ(scene["walls"][2]["temperature"], 3);
  EXPECT_EQ(scene["driving"], json::parse(R"({"andersen": null, "growth": null,
      "kicks": {"every": 0.5, "translational": 2.0, "rotational": 0.0}})"));
  EXPECT_EQ(scene["ratio_of_theory"], nullptr);
}

// A layer that rises and falls: each frame has room for those after it, and for no more.
TEST_F(Report, FitsALayerUnderAnOpenSide) {
  const std::string floor =
      "forces.gravity = [0, 0, -1]\n[[walls]]\naxis = \"z\"\nside = \"low\"\n";
  const Scene scene = parse_scene(
      "needles = { count = 1, box = [4, 5, 6] }\nuntil.time = 1\n" + floor, "scene", {});
  io::Writer writer(path("run.h5"), true, scene, {"scalar", 1, 1.0});
  const std::vector<double> heights{5, 2, 8, 3, 0};
  for (int n = 0; n < 5; ++n) {
    State only = state(1, 0);
    only.periodic[2] = false;
    only.position[0] = {1, 1, heights[n]};
    writer.write_frame(totals(n), only);
  }
  writer.close();
  const test::PageData page = page_of({"run.h5"});
  const json& frames = page.json["sections"][0]["frames"]["frames"];
  ASSERT_EQ(frames.size(), 5);
  const std::vector<double> highs{8, 8, 8, 3, 0.5};  // an eighth of the shortest edge at least
  for (std::size_t n = 0; n < 5; ++n) {
    EXPECT_EQ(frames[n]["number"], n);
    EXPECT_EQ(frames[n]["low"], json({0.0, 0.0, 0.0}));
    EXPECT_EQ(frames[n]["high"], json({4.0, 5.0, highs[n]})) << n;
    const auto place = page.numbers<std::uint16_t>(frames[n]["position"])[2];
    EXPECT_NEAR(place * highs[n] / 65536, heights[n], highs[n] / 65536) << n;
  }
}

// The samples of a caller between the others, and the last one, are not of the lags of the others.
TEST_F(Report, AveragesCorrelationsInTimeOverSamplesAtEqualLags) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Scene scene =
      parse_scene("needles = { count = 3, box = [4, 5, 6] }\nuntil.time = 1\n", "scene", {});
  const auto write_rows = [&](const std::vector<std::pair<double, std::vector<double>>>& rows) {
    io::RunInfo info{"scalar", 2, 1.0};
    info.series = {{"time_correlation",
                    "Correlation",
                    {{"samples", "Lags", "", {{"lags", 2}}, SeriesField::Kind::constant, {0, 1}},
                     {"lag", "Time", "", {{"lags", 2}}},
                     {"p1", "Cosine", "", {{"lags", 2}}}}}};
    io::Writer writer(path("run.h5"), true, scene, info);
    for (const auto& [time, row] : rows) {
      Totals sums = totals(0);
      sums.time = time;
      writer.write_series(sums, row);
    }
    writer.write_frame(totals(0), state(3, 0));
    writer.close();
    const test::PageData page = page_of({"run.h5"});
    json group = page.json["sections"][0]["groups"]["time_correlation"];
    group["p1"] = page.numbers<double>(group["datasets"]["p1"]);
    group["lag"] = page.numbers<double>(group["datasets"]["lag"]);
    return group;
  };
  json group = write_rows({{0, {0, nan, 1, nan}},
                           {0.1, {0, 0.1, 2, 5}},
                           {0.2, {0, 0.1, 3, 6}},
                           {0.3, {0, 0.1, 4, 10}},
                           {0.35, {0, 0.05, 5, 100}}});
  EXPECT_EQ(group["rows"], 1);
  EXPECT_EQ(group["rows_in_file"], 1);
  EXPECT_EQ(group["mean_of_rows"], 5);
  EXPECT_EQ(group["datasets"]["p1"]["shape"], json({1, 2}));
  EXPECT_EQ(group["p1"], json({3.0, 7.0}));
  EXPECT_NEAR(group["lag"][1].get<double>(), 0.1, 1e-12);
  // Of a gas that cools over decades the last row is shown.
  std::filesystem::remove(path("run.h5"));
  group = write_rows(
      {{0, {0, nan, 1, nan}}, {1, {0, 1, 2, 3}}, {10, {0, 9, 4, 5}}, {100, {0, 90, 6, 7}}});
  EXPECT_EQ(group["mean_of_rows"], 0);
  EXPECT_EQ(group["p1"], json({6.0, 7.0}));
  EXPECT_EQ(group["lag"], json({0.0, 90.0}));
}

// Though it is called as the times of samples are.
TEST_F(Report, HoldsAnObservableThatIsATime) {
  const Scene scene =
      parse_scene("needles = { count = 3, box = [4, 5, 6] }\nuntil.time = 1\n", "scene", {});
  io::RunInfo info{"scalar", 2, 1.0};
  info.series = {{"contacts", "Contacts", {{"time", "Time in contact", "", {}}}}};
  io::Writer writer(path("run.h5"), true, scene, info);
  for (int n = 0; n < samples; ++n) writer.write_series(totals(n), std::vector{3.0 * n});
  writer.write_frame(totals(0), state(3, 0));
  writer.close();
  const test::PageData page = page_of({"run.h5"});
  const json& group = page.json["sections"][0]["groups"]["contacts"];
  EXPECT_EQ(page.numbers<double>(group["datasets"]["time"])[2], 6);
  EXPECT_EQ(page.numbers<double>(group["time"])[2], totals(2).time);
  EXPECT_EQ(page.json["sections"][0]["groups"]["totals"]["datasets"].count("time"), 0);
}

TEST_F(Report, ThinsFramesNeedlesAndSamplesAndSaysSo) {
  write_run("run.h5", "many", 100, 9);
  report::PageLimits limits;
  limits.needles = 10;
  limits.drawn = 40;
  limits.samples = 3;
  const test::PageData page = page_of({"run.h5"}, limits);
  const json& run = page.json["sections"][0];
  EXPECT_EQ(run["frames"]["needles_in_file"], 100);
  EXPECT_EQ(run["frames"]["needles_shown"], 10);
  EXPECT_EQ(run["frames"]["frames_in_file"], 9);
  std::vector<int> shown;
  for (const json& frame : run["frames"]["frames"]) shown.push_back(frame["number"]);
  EXPECT_EQ(shown, (std::vector{0, 2, 5, 8}));  // 40 / 10, with the first and the last
  EXPECT_EQ(page.numbers<float>(run["frames"]["frames"][0]["speed"]).size(), 10);
  const auto all = picture::values_of("density", state(100, 0), true).values;
  const auto density = page.numbers<float>(run["frames"]["frames"][0]["density"]);
  const auto chosen = report::evenly(100, 10);
  ASSERT_EQ(density.size(), 10);
  for (std::size_t n = 0; n < 10; ++n) EXPECT_EQ(density[n], static_cast<float>(all[chosen[n]]));
  const json& totals_group = run["groups"]["totals"];
  EXPECT_EQ(totals_group["rows_in_file"], samples);
  EXPECT_EQ(totals_group["rows"], 3);
  EXPECT_EQ(page.numbers<double>(totals_group["time"]),
            (std::vector{0.0, totals(3).time, totals(6).time}));
}

TEST_F(Report, KeepsLargeGroupsWithinTheirBytes) {
  write_run("run.h5");
  report::PageLimits limits;
  limits.group_bytes = 2 * 2 * sizeof(double) + 1;  // two rows of a pair
  const test::PageData page = page_of({"run.h5"}, limits);
  EXPECT_EQ(page.json["sections"][0]["groups"]["pairs"]["rows"], 2);
}

TEST_F(Report, IsNotEndedByWhatATitleHolds) {
  const std::string title = "</script><script>alert(1)</script><!-- & \"é\"";
  write_run("run.h5", title);
  const test::PageData page = page_of({"run.h5"});
  EXPECT_EQ(page.json["sections"][0]["parameters"]["title"]["value"], title);
  EXPECT_EQ(page.text().find("alert(1)</script>"), page.text().npos);
}

TEST_F(Report, IsTheSameForTheSameFiles) {
  write_run("run.h5");
  const std::string once = page_of({"run.h5"}).text();
  EXPECT_EQ(page_of({"run.h5"}).text(), once);
}

TEST_F(Report, HasASectionForEachFileInTheOrderGiven) {
  write_run("a.h5");
  write("b.json", R"({"machine": "m", "cases": [{"name": "x/y", "ns_per_item": [3, 1.5]}]})");
  write_run("c.h5");
  const test::PageData page = page_of({"a.h5", "b.json", "c.h5"});
  ASSERT_EQ(page.json["sections"].size(), 3);
  const json& bench = page.json["sections"][1];
  EXPECT_EQ(bench["kind"], "bench");
  EXPECT_EQ(bench["unit"], "ns_per_item");
  EXPECT_EQ(bench["about"]["machine"], "m");
  EXPECT_EQ(bench["cases"],
            json::parse(R"([{"name": "x/y", "baseline": false, "values": [3, 1.5]}])"));
  EXPECT_EQ(page.json["sections"][2]["file"], path("c.h5"));
}

TEST_F(Report, NamesFilesThatItCannotUseAndWritesNoPage) {
  write("scene.toml", "needles.count = 3\n");
  write("empty.h5", "");
  write("list.json", "[1]");
  write("none.json", R"({"cases": []})");
  write("negative.json", R"({"cases": [{"name": "a/b", "us_per_collision": [1, -2]}]})");
  write("other.json", R"({"cases": [{"name": "a/b", "seconds": [1]}]})");
  write("cut.json", R"({"cases": [{"name": )");
  for (const auto& [file, part] :
       {std::pair{"scene.toml", "expected a run (.h5), the summary.h5 of a sweep, or results"},
        {"empty.h5", "expected a run (.h5)"},
        {"list.json", "expected a run (.h5)"},
        {"none.json", "`cases` is empty"},
        {"negative.json", "a/b: us_per_collision -2: expected a number above 0"},
        {"other.json", "a/b: expected us_per_collision or ns_per_item"},
        {"cut.json", "expected results in JSON that needlework bench --json FILE has written"},
        {".", "is a folder"}}) {
    const std::string message = complaint(file);
    EXPECT_TRUE(message.starts_with(path(file))) << file << ": " << message;
    EXPECT_TRUE(test::contains(message, part));
    EXPECT_FALSE(std::filesystem::exists(path("page.html"))) << file;
  }
  EXPECT_THROW(report::write_report({{path("absent.h5")}, path("page.html"), "", false, {}}),
               IoError);
}

TEST(ReportPage, HasOnePlaceForTheDataAndAsksForNothing) {
  const std::string page(report::page_text());
  const auto mark = page.find(report::data_mark);
  ASSERT_NE(mark, page.npos);
  EXPECT_EQ(page.find(report::data_mark, mark + 1), page.npos);
  EXPECT_TRUE(test::contains(page, "default-src 'none'"));
  for (const char* library : {"three", "@observablehq/plot", "d3-scale"}) {
    EXPECT_TRUE(test::contains(page, std::string("<h2>") + library)) << "licence of " << library;
  }
}

}  // namespace
}  // namespace needlework
