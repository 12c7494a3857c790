// Mail between threads, and how they detect that no event is left to process.
#include "src/engine/mail.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <thread>
#include <vector>

namespace needlework {
namespace {

const Backoff backoff(32);

TEST(Mail, ComesToItsThreadOnce) {
  Mail mail(3);
  mail.begin();
  EXPECT_FALSE(mail.has_some(1));
  mail.send(1, Needle(7));
  mail.send(1, Needle(5));
  EXPECT_FALSE(mail.has_some(0));
  EXPECT_TRUE(mail.has_some(1));
  EXPECT_EQ(mail.take(1), (std::vector<Needle>{Needle(7), Needle(5)}));
  EXPECT_FALSE(mail.has_some(1));
  EXPECT_TRUE(mail.take(1).empty());
}

TEST(Mail, OfAPhaseBeforeIsGone) {
  Mail mail(2);
  mail.begin();
  mail.send(0, Needle(1));
  mail.begin();
  EXPECT_FALSE(mail.has_some(0));
  EXPECT_TRUE(mail.take(0).empty());
}

TEST(Mail, KeepsThreadsFromResting) {
  Mail mail(1);
  mail.begin();
  const std::atomic<bool> given_up = false;
  mail.send(0, Needle(1));
  EXPECT_FALSE(mail.rest(0, given_up, backoff));
  (void)mail.take(0);
  EXPECT_TRUE(mail.rest(0, given_up, backoff));
}

TEST(Mail, IsNotWaitedForWhenThePhaseIsGivenUp) {
  Mail mail(2);
  mail.begin();
  const std::atomic<bool> given_up = true;
  EXPECT_TRUE(mail.rest(0, given_up, backoff));
}

// A rests first. B sends it work, which A does and then sends work back. Neither may stop before
// all work is done, in whatever order they run.
TEST(Mail, EndsWhenAllRestAndNoneIsUnderWay) {
  for (int repetition = 0; repetition < 200; ++repetition) {
    Mail mail(2);
    mail.begin();
    const std::atomic<bool> given_up = false;
    constexpr Needle last(50);
    std::array<std::vector<Needle>, 2> got;
    const auto work = [&](std::size_t me) {
      do {
        for (const Needle needle : mail.take(me)) {
          got[me].push_back(needle);
          if (needle < last) mail.send(1 - me, Needle(needle.index + 1));
        }
      } while (!mail.rest(me, given_up, backoff));
    };
    mail.send(1, Needle(0));
    std::thread other(work, 0);
    work(1);
    other.join();
    EXPECT_EQ(got[0].size() + got[1].size(), last.index + 1);
    ASSERT_FALSE(got[1].empty());
    EXPECT_EQ(got[1].back(), last);
  }
}

}  // namespace
}  // namespace needlework
