// The choice between one thread and several, on machines that exist in this test alone.
#include "src/engine/team_choice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

namespace needlework {
namespace {

constexpr double alone_cost = 6e-6;  // wall time of a collision [s]

// How long a run takes, and what of it.
struct Choices {
  double seconds = 0;
  double together = 0;  // collisions
  int rolled_back = 0;
};

// A machine where one thread needs `alone(now)` for a collision and all together need
// `together(now)`, besides 50 us to start. Phases that take more than three times as long as one
// thread would are given up after 5 ms.
struct Machine {
  std::function<double(double)> alone, together;
  double longest = 0x1p15;  // stretch [collisions]

  Choices run(double collisions) const {
    Choices course;
    TeamChoice choice;
    while (collisions > 0) {
      const TeamChoice::Turn turn = choice.next();
      double done = std::min({turn.most, collisions, longest}), seconds = 0;
      if (turn.together) {
        seconds = 50e-6 + done * together(course.seconds);
        if (seconds > 5e-3 && together(course.seconds) > 3 * alone(course.seconds)) {
          done = 0;
          seconds = 5e-3;
          ++course.rolled_back;
        }
        course.together += done;
      } else {
        seconds = done * alone(course.seconds);
      }
      choice.took(turn.together, done, seconds);
      collisions -= done;
      course.seconds += seconds;
    }
    return course;
  }
};

std::function<double(double)> always(double cost) {
  return [=](double) { return cost; };
}

TEST(TeamChoice, ThreadsWorkTogetherWhereThatIsFaster) {
  const Choices course = Machine{always(alone_cost), always(alone_cost / 1.6)}.run(1e6);
  EXPECT_GT(course.together, 0.97e6);
  EXPECT_LT(course.seconds, 1.03 * 1e6 * alone_cost / 1.6);
}

TEST(TeamChoice, OneThreadWorksAloneWhereThreadsWaitForEachOther) {
  for (const double times : {1.1, 2.0, 10.0, 70.0}) {
    for (const double collisions : {2e5, 2e7}) {
      const Choices course =
          Machine{always(alone_cost), always(times * alone_cost)}.run(collisions);
      EXPECT_LT(course.seconds, 1.12 * collisions * alone_cost) << times << ' ' << collisions;
    }
  }
}

TEST(TeamChoice, NeitherIsMuchWorseWhereBothAreAboutEqual) {
  const Choices course = Machine{always(alone_cost), always(0.99 * alone_cost)}.run(1e6);
  EXPECT_LT(course.seconds, 1.02 * 1e6 * alone_cost);
}

TEST(TeamChoice, FollowsLoadThatComesAndGoes) {
  // A hundred seconds of load, a hundred without.
  const auto loaded = [](double now) { return static_cast<int>(now / 100) % 2 == 0; };
  const Machine machine{
      [=](double now) { return loaded(now) ? 1.5 * alone_cost : alone_cost; },
      [=](double now) { return loaded(now) ? 70 * alone_cost : alone_cost / 1.6; }};
  const Choices course = machine.run(3e8);
  const double best = 3e8 * alone_cost * 2 / (1 / 1.5 + 1.6);
  EXPECT_LT(course.seconds, 1.25 * best);
  EXPECT_GT(course.together, 0.5 * 3e8);
}

TEST(TeamChoice, AStretchThatWasOnceSlowIsForgotten) {
  // A pause of 5 ms in every half second, as other programs cause on any machine.
  const auto paused = [](double now) { return now - 0.5 * static_cast<int>(2 * now) < 5e-3; };
  const Machine machine{always(alone_cost), [=](double now) {
                          return paused(now) ? 70 * alone_cost : alone_cost / 1.6;
                        }};
  const Choices course = machine.run(5e6);
  EXPECT_GT(course.rolled_back, 5);
  EXPECT_LT(course.seconds, 1.25 * 5e6 * alone_cost / 1.6);
}

TEST(TeamChoice, AMachineThatBecomesSlowerSlowsBoth) {
  const auto slower = [](double now) { return now < 0.02 ? 1 : 1.8; };
  const Machine machine{[=](double now) { return slower(now) * alone_cost; },
                        [=](double now) { return slower(now) * alone_cost / 1.6; }};
  EXPECT_GT(machine.run(1e5).together, 0.95e5);
}

TEST(TeamChoice, ComparesShortStretches) {
  const Machine fast{always(alone_cost), always(alone_cost / 1.6), 100};
  const Machine slow{always(alone_cost), always(2 * alone_cost), 100};
  EXPECT_GT(fast.run(1e6).together, 0.9e6);
  EXPECT_LT(slow.run(1e6).together, 0.1e6);
}

TEST(TeamChoice, AllThreadsAreTriedAgainWithinTenSeconds) {
  TeamChoice choice;
  choice.took(false, 512, 512 * alone_cost);
  choice.took(true, 2048, 30);
  double alone = 0;
  while (!choice.next().together) {
    alone += 0.5;
    choice.took(false, 0.5 / alone_cost, 0.5);
    ASSERT_LE(alone, 10);
  }
  EXPECT_GE(alone, 9.5);
}

TEST(TeamChoice, AStretchThatWasGivenUpDoesNotLengthenTheNext) {
  TeamChoice choice;
  choice.took(false, 512, 512 * alone_cost);
  for (int n = 0; n < 4; ++n) choice.took(true, 2048, 2048 * alone_cost / 1.6);
  const double most = choice.next().most;
  choice.took(true, 0, 1e-3);
  EXPECT_TRUE(choice.next().together);
  EXPECT_EQ(choice.next().most, most);
}

}  // namespace
}  // namespace needlework
