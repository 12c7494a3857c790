// Long work can be stopped where somebody asks for it, and nowhere else.
#include "src/machine/stop_request.h"

#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <thread>

namespace needlework {
namespace {

// Until the next check asks.
void wait() { std::this_thread::sleep_for(std::chrono::milliseconds(60)); }

TEST(StopRequest, IsAskedNowAndThen) {
  EXPECT_NO_THROW(StopRequest::check());
  int asked = 0;
  std::string why;
  const StopRequest request([&] {
    ++asked;
    return why;
  });
  wait();
  StopRequest::check();
  EXPECT_EQ(asked, 1);
  why = "enough";
  wait();
  try {
    StopRequest::check();
    FAIL();
  } catch (const StoppedEarly& stop) {
    EXPECT_STREQ(stop.what(), "enough");
  }
}

TEST(StopRequest, EndsWithItsLife) {
  const StopRequest outer([] { return "outer"; });
  {
    const StopRequest inner([] { return ""; });
    wait();
    EXPECT_NO_THROW(StopRequest::check());
  }
  EXPECT_THROW(StopRequest::check(), StoppedEarly);
}

TEST(StopRequest, IsThatOfOneThread) {
  const StopRequest request([] { return "here"; });
  wait();
  std::thread([] { EXPECT_NO_THROW(StopRequest::check()); }).join();
  EXPECT_THROW(StopRequest::check(), StoppedEarly);
}

}  // namespace
}  // namespace needlework
