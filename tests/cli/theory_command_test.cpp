// The command `needlework theory`, as other people's scripts see it.
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "needlework/boltzmann.h"
#include "needlework/diffusion.h"
#include "needlework/theory.h"
#include "tests/cli/program.h"

namespace needlework {
namespace {

using TheoryCommand = ProgramTest;

TEST_F(TheoryCommand, PrintsOneJsonObjectWithAllDigits) {
  const auto json = nlohmann::ordered_json::parse(
      output_of("theory --epsilon 0.8 --k 6 --t-rot0 0 --tau 100 --tau 1 --tau 1e8 --json"));
  std::vector<std::string> keys;
  for (const auto& item : json.items()) keys.push_back(item.key());
  EXPECT_EQ(keys, (std::vector<std::string>{"epsilon", "beta", "k", "c", "k_star", "tau", "t_tr",
                                            "t_rot", "energy"}));

  const theory::Gas gas{6.0, 0.8, -1.0};
  const std::vector<double> taus = {100.0, 1.0, 1e8};
  const auto curve = theory::cooling_curve(gas, {1.0, 0.0}, taus);
  EXPECT_EQ(json["epsilon"], 0.8);
  EXPECT_EQ(json["beta"], -1.0);
  EXPECT_EQ(json["k"], 6.0);
  EXPECT_EQ(json["c"].get<double>(), theory::asymptotic_ratio(gas));
  EXPECT_EQ(json["k_star"].get<double>(), theory::equipartition_k());
  EXPECT_EQ(json["tau"].get<std::vector<double>>(), taus);
  for (std::size_t i = 0; i < taus.size(); ++i) {
    EXPECT_EQ(json["t_tr"][i].get<double>(), curve[i].t_tr);
    EXPECT_EQ(json["t_rot"][i].get<double>(), curve[i].t_rot);
    EXPECT_EQ(json["energy"][i].get<double>(), curve[i].energy());
  }
}

TEST_F(TheoryCommand, PrintsNullForWhatIsUndefined) {
  const auto elastic = run("theory --epsilon 1 --k 6 --json").json();
  EXPECT_TRUE(elastic["c"].is_null());
  EXPECT_TRUE(elastic["k_star"].is_number());
  EXPECT_EQ(elastic["tau"], nlohmann::json::array());
  EXPECT_EQ(elastic["energy"], nlohmann::json::array());

  const auto rough = run("theory --epsilon 1 --k 6 --beta -0.5 --json").json();
  EXPECT_TRUE(rough["c"].is_number());
  EXPECT_TRUE(rough["k_star"].is_null());
}

TEST_F(TheoryCommand, SaysHowElasticNeedlesDiffuse) {
  const auto expected = theory::uncorrelated_transport(8, (1.5 + 0.4) / 2.5, 6);
  const auto json = run("theory --epsilon 1 --k 6 --t-rot0 0.4 --density 8 --json").json();
  EXPECT_EQ(json["diffusion"]["d"], expected.diffusion);
  EXPECT_EQ(json["diffusion"]["d_rot"], expected.rotational_diffusion);
  EXPECT_EQ(json["diffusion"]["velocity_decay"], expected.velocity_decay);
  EXPECT_EQ(json["diffusion"]["angular_velocity_decay"], expected.angular_velocity_decay);
  EXPECT_TRUE(contains(run("theory --epsilon 1 --k 6 --density 8").out, "D_rot ="));
  EXPECT_TRUE(
      run("theory --epsilon 1 --k 6 --density 0 --json").json()["diffusion"]["d"].is_null());
  for (const char* other :
       {"--epsilon 0.9 --density 8", "--epsilon 1", "--epsilon 1 --beta 1 --density 8"}) {
    const auto without = run(std::string("theory --k 6 --json ") + other).json();
    EXPECT_FALSE(without.contains("diffusion")) << other;
  }
}

// The same needles four times as hot: everything happens in half the time, at the same tau.
TEST_F(TheoryCommand, CountsTauInTheThermalSpeed) {
  const std::string scene =
      "needles = { count = 100, box = 5 }\nuntil.time = 1\n"
      "collisions = { epsilon = 0.8, tc_relative = 1e-3 }\n";
  write("cold.toml", scene + "initial = { t_tr = 1, t_rot = 0.5 }\n");
  write("hot.toml", scene + "initial = { t_tr = 4, t_rot = 2 }\n");
  const auto cold = json_of("theory --json --time 2 cold.toml");
  const auto hot = json_of("theory --json --time 1 hot.toml");
  EXPECT_NEAR(cold["tau"][0].get<double>(), 2.0 / 3 * std::sqrt(M_PI) * 100 / 125 * 2, 1e-12);
  for (const char* same : {"tau", "collisions_per_needle"})
    EXPECT_NEAR(hot[same][0].get<double>(), cold[same][0].get<double>(), 1e-9) << same;
  EXPECT_NEAR(hot["time"][0].get<double>(), 1, 1e-12);
  EXPECT_NEAR(hot["t_tr"][0].get<double>(), 4 * cold["t_tr"][0].get<double>(), 1e-9);
  const auto at_tau = json_of("theory --json hot.toml --tau " + hot["tau"][0].dump());
  EXPECT_NEAR(at_tau["time"][0].get<double>(), 1, 1e-12);
  EXPECT_NEAR(at_tau["t_tr"][0].get<double>(), hot["t_tr"][0].get<double>(), 1e-9);
  const std::string single = " --boltzmann single --needles 640 --json --time ";
  EXPECT_NEAR(json_of("theory hot.toml" + single + "1")["tau"][0].get<double>(),
              json_of("theory cold.toml" + single + "2")["tau"][0].get<double>(), 1e-12);
}

// At the density of the partners of each sphere of a scene.
TEST_F(TheoryCommand, FollowsRoughSpheresWithoutAScene) {
  write("hollow.toml",
        "needles.box = 10\ncollisions = { epsilon = 0.9, beta = 0.5, tc_relative = 1e-3 }\n"
        "until.time = 1\n[[species]]\nname = \"hollow\"\ncount = 101\nlength = 0\n"
        "diameter = 1\ninertia = 0.16666666666666666\nt_rot = 0.5\n");
  const auto of_scene = json_of("theory --json --time 0 --time 7 hollow.toml");
  const std::string spheres = "theory --epsilon 0.9 --beta 0.5 --t-rot0 0.5";
  const auto json =
      json_of(spheres + " --q 0.6666666666666667 --density 0.1 --time 7 --time 0 --json");
  EXPECT_NEAR(json["c"].get<double>(), of_scene["c"].get<double>(), 1e-12);
  EXPECT_FALSE(json.contains("k") || json.contains("k_star"));
  EXPECT_NEAR(json["tau"][0].get<double>(), 2.0 / 3 * std::sqrt(M_PI) * 0.1 * 7, 1e-12);
  for (const char* name : {"t_tr", "t_rot", "energy"}) {
    for (const int n : {0, 1}) {
      EXPECT_NEAR(json[name][n].get<double>(), of_scene[name][1 - n].get<double>(), 1e-7) << name;
    }
  }
  EXPECT_NEAR(json["energy"][1].get<double>(), 1.5 * (1 + 0.5), 1e-12);
  const double per_time = of_scene["collisions_per_time"]["hollow-hollow"].get<double>();
  const auto soon = json_of(spheres + " --q 0.5 --density 0.1 --time 1e-6 --json");
  EXPECT_NEAR(soon["collisions_per_needle"][0].get<double>(), 2 * per_time / 101 * 1e-6, 1e-11);
  // Spins of little inertia follow the flights at once.
  EXPECT_NEAR(json_of("theory --epsilon 1 --beta 0 --q 1e-9 --json")["c"].get<double>(), 1e9, 10);
  EXPECT_TRUE(
      contains(output_of(spheres + " --q 0.4 --tau 2"),
               {"epsilon 0.9, beta 0.5, q 0.4\n", "tends to c = ", "\n               2  "}));
}

TEST_F(TheoryCommand, StartsWithEqualTemperatures) {
  const auto json = run("theory --epsilon 0.8 --k 6 --tau 0 --json").json();
  EXPECT_EQ(json["t_tr"][0], 1.0);
  EXPECT_EQ(json["t_rot"][0], 1.0);
  EXPECT_EQ(json["energy"][0], 2.5);
}

TEST_F(TheoryCommand, PrintsATable) {
  EXPECT_TRUE(contains(output_of("theory --epsilon 0.8 --k 6 --t-rot0 0 --tau 1"),
                       {"epsilon 0.8", "1.037732671", "4.360700345", "tau", "1.426099077"}));
}

TEST_F(TheoryCommand, SimulatesTheBoltzmannEquation) {
  const std::string arguments =
      "theory --epsilon 0.5 --k 6 --tau 0.5 --tau 0 --needles 640 --seed 3 --boltzmann ";
  const auto json = nlohmann::json::parse(run(arguments + "encounters --tc 0.01 --json").out);
  EXPECT_EQ(json["tau"], (std::vector<double>{0, 0.5}));
  EXPECT_EQ(json["tc"], 0.01);
  EXPECT_EQ(json["needles"], 640);
  EXPECT_NEAR(json["energy"][0].get<double>(), 2.5, 1e-12);
  const std::vector<double> taus = {0, 0.5};
  const auto curve = theory::cooling_curve({6, 0.5, -1}, {}, taus);
  EXPECT_EQ(json["theory"]["energy"][1].get<double>(), curve[1].energy());
  EXPECT_NEAR(json["energy"][1].get<double>(), curve[1].energy(), 0.2);
  EXPECT_GT(json["energy_error"][1].get<double>(), 0);
  EXPECT_GT(json["encounters"].get<int>(), 100);
  const boltzmann::Settings settings{
      .composition = boltzmann::one_species({6, 0.5, -1}), .needles = 640, .seed = 3};
  const auto single = nlohmann::json::parse(run(arguments + "single --json").out);
  EXPECT_EQ(single["t_rot"][1].get<double>(),
            boltzmann::simulate(settings, taus).samples[1].t_rot.value);
  EXPECT_FALSE(single.contains("encounters"));
  const std::string table = run(arguments + "encounters").out;
  EXPECT_TRUE(contains(table, "are not the first of their pair"));
}

TEST_F(TheoryCommand, SimulatesTheBoltzmannEquationOfMixtures) {
  const std::string species =
      "[[species]]\nname = \"long\"\ncount = 100\nlength = 2\nmass = 8\nt_tr = 3\n"
      "[[species]]\nname = \"short\"\ncount = 300\n";
  write("mixture.toml",
        "needles = { box = 10, seed = 9 }\nuntil.time = 1\n"
        "collisions = { epsilon = 0.9, tc_relative = 1e-2 }\n" +
            species);
  const std::string arguments = "theory --needles 640 --time 2 --time 0 --boltzmann ";
  const auto json = run(arguments + "single --json mixture.toml").json();
  EXPECT_EQ(json["time"], (std::vector<double>{0, 2}));
  EXPECT_EQ(json["density"], 0.4);
  EXPECT_EQ(json["seed"], 9);
  EXPECT_FALSE(json.contains("k"));
  EXPECT_NEAR(json["t_tr"][0].get<double>(), 1.5, 1e-12);
  const auto theory = run("theory --time 0 --time 2 --json mixture.toml").json();
  EXPECT_EQ(json["theory"]["energy"], theory["energy"]);
  for (const char* name : {"long", "short"}) {
    const auto& of = json["species"][name];
    EXPECT_EQ(of["theory"]["t_tr"], theory["species"][name]["t_tr"]);
    EXPECT_EQ(of["t_tr"][0], theory["species"][name]["t_tr"][0]) << name;
    EXPECT_NEAR(of["t_tr"][1].get<double>(), of["theory"]["t_tr"][1].get<double>(),
                5 * of["t_tr_error"][1].get<double>());
  }
  double collisions = 0;
  for (const char* pair : {"long-long", "long-short", "short-short"}) {
    collisions += json["collisions_between"][pair][1].get<double>();
  }
  EXPECT_NEAR(2 * collisions, json["collisions_per_needle"][1].get<double>(), 1e-12);

  // Of all needles at the start, in units of the time to fly a length of 1 at their T_tr.
  double rate = 0;
  for (const auto& each : theory["collisions_per_time"]) rate += 2 * each.get<double>() / 400;
  const auto encounters = run(arguments + "encounters --json mixture.toml").json();
  EXPECT_NEAR(encounters["tc"].get<double>(), 1e-2 / rate * std::sqrt(1.5), 1e-12);
  const std::string table = run(arguments + "encounters mixture.toml").out;
  EXPECT_TRUE(contains(table, {"2 species", "all needles", "\nlong\n", "\nshort\n", "long-short",
                               "are not the first of their pair"}));

  for (const auto& [options, message] :
       {std::pair("--boltzmann single --epsilon 0.5",
                  "--epsilon 0.5: expected none beside a scene of several species"),
        {"--needles 640", "--needles 640: expected --boltzmann beside it"},
        {"--boltzmann single --needles 200",
         "needles = 200: expected more, as 50 of them are of species long, and 64 must be"},
        {"--boltzmann single --set species.long.diameter=0.1 "
         "--set species.short.diameter=0.1",
         "--boltzmann single: expected a scene of thin needles, not of rods of finite width"}}) {
    const Outcome outcome = run(std::string("theory ") + options + " mixture.toml");
    EXPECT_EQ(outcome.exit_code, 2) << options;
    EXPECT_EQ(outcome.err, std::string("needlework: ") + message + "\n");
  }
}

// The scene's: relative to the mean free time, in units of the time to fly a length.
TEST_F(TheoryCommand, TakesTheContactTimeOfAScene) {
  write("gas.toml",
        "needles = { count = 100, box = 5, k = 2, seed = 9 }\ninitial = { t_tr = 4, t_rot = 2 }\n"
        "collisions = { epsilon = 0.9, tc_relative = 1e-2 }\nuntil.time = 1\n");
  const std::string arguments =
      "theory --needles 64 --tau 0 --boltzmann encounters --json gas.toml";
  const auto json = nlohmann::json::parse(run(arguments).out);
  EXPECT_EQ(json["seed"], 9);
  EXPECT_NEAR(json["tc"].get<double>(), 1e-2 / theory::collision_rate(100 / 125.0, {1, 0.5}, 2),
              1e-12);
  write("absolute.toml",
        "needles = { count = 100, box = 5 }\ncollisions = { epsilon = 0.9, tc = 0.1 }\n"
        "until.time = 1\n");
  EXPECT_EQ(
      run("theory --boltzmann encounters absolute.toml").err,
      "needlework: --tc is missing: expected a number, as collisions.tc = 0.1 does not follow "
      "the temperature\n");
}

// It would be the course of another gas.
TEST_F(TheoryCommand, NamesTheSpeciesOfAShortFormInItsText) {
  write("rods.toml", "needles = { count = 100, box = 9, diameter = 0.1 }\nuntil.time = 1\n");
  const std::string text = run("theory rods.toml").out;
  EXPECT_TRUE(contains(text, "\n  needles-needles "));
  EXPECT_TRUE(contains(text, "\n  needles  "));
  EXPECT_TRUE(contains(text, "T_tr needles"));
  EXPECT_TRUE(run("theory rods.toml --json").json()["collisions_per_time"].contains("-"));
}

TEST_F(TheoryCommand, RefusesWhatItDoesNotDescribe) {
  const std::string gas = "needles = { count = 20, box = 4 }\nuntil.time = 1\n";
  const std::string walls = "[[walls]]\naxis = \"z\"\nside = \"low\"\n";
  for (const auto& [more, name] :
       {std::pair(walls + "[[walls]]\naxis = \"z\"\nside = \"high\"\n", "[[walls]]"),
        {"driving.kicks = { every = 1, translational = 1, rotational = 1 }\n", "[driving]"},
        {"driving.andersen = { rate = 1, temperature = 1 }\n", "[driving]"}}) {
    write("pushed.toml", gas + more);
    EXPECT_TRUE(
        run("theory pushed.toml").fails(3, "pushed.toml: " + std::string(name) + ": expected none"))
        << more;
  }
}

TEST_F(TheoryCommand, NamesFlagValueAndExpectation) {
  struct Case {
    const char *arguments, *message;
  };
  for (const Case& bad :
       {Case{"--epsilon 1.5 --k 6", "--epsilon 1.5: expected a number in [0, 1]"},
        Case{"--epsilon nan --k 6", "--epsilon nan: expected a number in [0, 1]"},
        Case{"--epsilon 0.8 --k 0", "--k 0: expected a number in [1e-12, 1e12]"},
        Case{"--epsilon 0.8 --k six", "--k six: expected a number in [1e-12, 1e12]"},
        Case{"--epsilon 0.8 --k 6 --beta -1.5", "--beta -1.5: expected a number in [-1, 1]"},
        Case{"--epsilon 0.8 --k 6 --tau -1", "--tau -1: expected a finite number, 0 or more"},
        Case{"--epsilon 0.8 --k 6 --seed 7", "--seed 7: expected --boltzmann beside it"},
        Case{"--epsilon 0.8 --k 6 --boltzmann single --needles 63",
             "--needles 63: expected a number from 64 to 1e9"},
        Case{"--epsilon 0.8 --k 6 --boltzmann encounters --tc 0",
             "contact_time = 0: expected a number in [1e-9, 1e100], as encounters of this gas may "
             "collapse"},
        Case{"--epsilon 0.8 --beta 0 --q 0.7",
             "--q 0.7: expected a number in [1e-9, 2/3], at which all mass is at the surface"},
        Case{"--epsilon 0.8 --beta 0 --q 0.4 --k 6",
             "--q 0.4: expected either --q or --k, not both: spheres or needles"},
        Case{"--epsilon 0.8 --q 0.4",
             "--q 0.4: expected --beta above -1 beside it, as nothing turns smooth spheres"},
        Case{"--epsilon 0.8 --beta 0 --q 0.4 --boltzmann single",
             "--q 0.4: expected none beside --boltzmann, which simulates thin needles"},
        Case{"--epsilon 0.8 --beta 0 --q 0.4 small.toml",
             "--q 0.4: expected none beside a scene, which says what its bodies are"},
        Case{"--epsilon 0.8 --beta 0 --q 0.4 --density 2",
             "--density 2: expected a number in [0, 2^1/2], as spheres of diameter 1 are never "
             "denser"},
        Case{"--beta 0 --q 0.4",
             "--epsilon is missing: expected a number in [0, 1], or a scene (see needlework theory "
             "--help)"},
        Case{"--epsilon 0.8 --k 6 --t-rot0 inf",
             "--t-rot0 inf: expected a finite number, 0 or more"}}) {
    const Outcome outcome = run(std::string("theory ") + bad.arguments);
    EXPECT_EQ(outcome.exit_code, 2) << bad.arguments;
    EXPECT_EQ(outcome.err, std::string("needlework: ") + bad.message + "\n");
    EXPECT_EQ(outcome.out, "") << bad.arguments;
  }
}

}  // namespace
}  // namespace needlework
