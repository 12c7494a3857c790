// Where drawn bodies are placed that differ within a species, or are fixed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "needlework/initial_state.h"
#include "needlework/parse.h"
#include "needlework/simulation.h"
#include "src/composition/convex_body.h"
#include "src/engine/drawn_state.h"
#include "src/scene/drawing.h"
#include "src/scene/own_bodies.h"
#include "src/scene/rod_grid.h"
#include "tests/support/runs.h"

namespace needlework {
namespace {

Scene parse(const std::string& text) { return parse_scene(text, "scene.toml"); }

const std::string head = "needles = { box = 10, seed = 4 }\nuntil.time = 1\n";

// Spheres of diameters from 0.3 to 3 and rods as long, of which few find room at once.
const std::string grains =
    head +
    "[[species]]\nname = \"grains\"\ncount = 200\nlength = 0\n"
    "diameter = { distribution = \"powerlaw\", min = 0.3, max = 3, exponent = 1.5 }\n"
    "[[species]]\nname = \"rods\"\ncount = 60\ndiameter.aspect = 4\n"
    "length = { distribution = \"gamma\", mean = 1.5, width = 0.5 }\n";

std::string among(const std::string& moving, const std::string& fixed) {
  return head + "[[species]]\nname = \"moving\"\n" + moving +
         "[[species]]\nname = \"still\"\nfixed = true\n" + fixed;
}

// Needles among spheres whose volumes are 2.7 times that of the box, which leave exp(-2.7) of it.
const std::string among_strewn = among(
    "count = 40\nlength = 0.2\n", "count = 3000\nlength = 0\ndiameter = 1.2\noverlap = true\n");

std::vector<RodShape> shapes_of(const Members& members) {
  std::vector<RodShape> out;
  for (std::size_t i = 0; i < members.size(); ++i) {
    const BodyNumbers its = members.body(i);
    out.push_back({its.length, its.diameter, members.species[i]});
  }
  return out;
}

// Each body lies where it was tried first, unless it would have overlapped one that is larger.
TEST(Placing, PutsTheLargestFirstWhateverTheirIds) {
  const Scene scene = parse(grains);
  const Members members = drawn_members(scene);
  const std::vector<RodShape> shapes = shapes_of(members);
  const State first = draw_needles(scene), placed = draw_state(scene).state;
  ASSERT_EQ(placed.size(), 260u);
  std::vector<std::size_t> by_size(placed.size());
  for (std::size_t i = 0; i < by_size.size(); ++i) by_size[i] = i;
  std::ranges::stable_sort(by_size, std::ranges::greater(), [&](std::size_t i) {
    const Species its{.length = shapes[i].length, .diameter = shapes[i].diameter};
    return excluded_volume(its, its);
  });
  RodGrid larger(members.composition, shapes, box_of(placed));
  int elsewhere = 0, out_of_turn = 0;
  std::size_t before = 0;
  for (const std::size_t i : by_size) {
    const bool is_free = !larger.overlap(first.position[i], first.orientation[i], shapes[i], 0);
    EXPECT_EQ(placed.position[i] == first.position[i], is_free) << i;
    EXPECT_FALSE(larger.overlap(placed.position[i], placed.orientation[i], shapes[i], 0)) << i;
    larger.enter(placed.position[i], placed.orientation[i], shapes[i]);
    elsewhere += !is_free;
    out_of_turn += i < before;
    before = i;
  }
  EXPECT_GT(elsewhere, 50);
  EXPECT_GT(out_of_turn, 50);
}

// Law: a body finds a place among bodies that lie anywhere with the probability exp(-n V), V the
// mean volume from which one of them excludes its centre.
TEST(Placing, FindsRoomAmongFixedOnesThatOverlap) {
  const Scene scene = parse(among_strewn);
  const PlannedPlacement plan = plan_placement(scene);
  EXPECT_EQ(plan.way, PlannedPlacement::Way::inserted);
  const Composition composition = scene.composition();
  const double tries = std::exp(3 * excluded_volume(composition[0], composition[1]));
  EXPECT_NEAR(plan.tries, (3000 + 40 * tries) / 3040, 1e-3 * plan.tries);
  const DrawnState drawn = draw_state(scene);
  const State anywhere = draw_needles(scene);
  EXPECT_TRUE(std::equal(anywhere.position.begin() + 40, anywhere.position.end(),
                         drawn.state.position.begin() + 40));
  // 40 needles scatter by 1/sqrt(40), 16 %: within 3 of that.
  const Insertion done = insert_rods(scene, 1000000, 1000);
  EXPECT_NEAR((static_cast<double>(done.tries) - 3000) / 40, tries, 0.48 * tries);
  Simulation gas(scene, drawn.state);
  EXPECT_EQ(gas.advance(test::until_collisions(0.1)), Stop::collisions);
}

TEST(Placing, KeepsFixedOnesApartThatMayNotOverlap) {
  const std::string spheres = "length = 0\ndiameter = 1\n";
  const Scene scene = parse(among("count = 20\n", "count = 500\n" + spheres));  // packing 0.26
  const Scene moving = parse(head + "[[species]]\nname = \"a\"\ncount = 500\n" + spheres);
  // As many tries as spheres that move.
  EXPECT_NEAR(std::log(plan_placement(scene).tries / plan_placement(moving).tries), 0, 0.1);
  const Members members = drawn_members(scene);
  const State state = draw_state(scene).state;
  const std::vector<RodShape> shapes = shapes_of(members);
  RodGrid grid(members.composition, shapes, box_of(state));
  for (std::size_t i = 0; i < state.size(); ++i) {
    EXPECT_FALSE(grid.overlap(state.position[i], state.orientation[i], shapes[i], 0)) << i;
    grid.enter(state.position[i], state.orientation[i], shapes[i]);
  }
}

// Moving them from a lattice would have no end.
TEST(Placing, DoesNotWaitForBodiesThatNeverMeet) {
  for (const char* species : {"count = 1\n",
                              "count = 4\n[[pairs]]\nbetween = [\"a\", \"a\"]\n"
                              "meet = false\n"}) {
    const Scene scene = parse(head +
                              "initial.packing = \"lattice\"\n[[walls]]\naxis = \"z\"\n"
                              "side = \"both\"\n[[species]]\nname = \"a\"\nlength = 0\n"
                              "diameter = 1\n" +
                              species);
    EXPECT_NO_THROW(draw_state(scene));
  }
}

TEST(Placing, LeavesFixedOnesOnTheirLattice) {
  Scene scene = parse(among("count = 100\nlength = 0\ndiameter = 0.5\n",
                            "count = 100\nlength = 0\ndiameter = 1\n"));
  scene.initial.packing = "lattice";
  const auto lattice = place_rods_on_lattice(scene, RodOrder::parallel);
  ASSERT_TRUE(lattice);
  const State state = draw_state(scene).state;
  for (std::size_t i = 0; i < state.size(); ++i)
    EXPECT_EQ(state.position[i] == lattice->position[i], i >= 100) << i;
}

}  // namespace
}  // namespace needlework
