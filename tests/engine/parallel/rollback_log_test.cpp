// What a phase that is rolled back puts back.
#include "src/engine/rollback_log.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace needlework {
namespace {

TEST(RollbackLogs, PutRecordsBackWhoseNumbersHaveWrappedAround) {
  Gas gas;
  gas.resize(2);
  gas.records[0].serial = ~std::uint32_t{0};
  gas.records[0].flight.r.x = 1;
  RollbackLog log;
  log.begin({});
  log.replaced(Needle(0), gas);
  gas.records[0].serial += 1;
  gas.records[0].flight.r.x = 2;
  log.put_back(gas);
  EXPECT_EQ(gas.records[0].serial, ~std::uint32_t{0});
  EXPECT_EQ(gas.records[0].flight.r.x, 1);
}

// Records that the phase has made need not be put back.
TEST(RollbackLogs, HoldOnlyRecordsFromBeforeThePhase) {
  Gas gas;
  gas.resize(2);
  const auto time = [](double offset) { return Time{0, offset}; };
  for (Needle i{0}; i < 2; ++i) gas.records[i].time = time(1);
  RollbackLog log;
  log.begin(time(2));
  const auto replace = [&](Needle i, double when) {
    Record& record = gas.records[i];
    log.replaced(i, gas);
    ++record.serial;
    record.time = time(when);
    log.scheduled(i, record);
  };
  // Several at the instant at which the phase began, and some of them later.
  for (const double when : {2.0, 2.0, 3.0, 4.0, 5.0}) replace(Needle(0), when);
  log.scheduled(Needle(1), gas.records[1]);
  EXPECT_EQ(log.entries(), 3u);
  EXPECT_EQ(std::count(log.scheduled().begin(), log.scheduled().end(), Needle(1)), 1);
  log.put_back(gas);
  EXPECT_EQ(gas.records[0].serial, 0u);
  EXPECT_EQ(gas.records[0].time, time(1));
  EXPECT_NE(std::find(log.scheduled().begin(), log.scheduled().end(), Needle(0)),
            log.scheduled().end());
  log.begin(time(5));
  EXPECT_EQ(log.entries(), 0u);
  EXPECT_TRUE(log.scheduled().empty());
}

// Whatever effects keep of a needle goes with its record.
TEST(RollbackLogs, PutColumnsBack) {
  Gas gas;
  auto& times = gas.columns.add<Time>("times", {0, 7});
  auto& letters = gas.columns.add<char>("letters", 'a');
  gas.resize(3);
  EXPECT_EQ(times[Needle(2)], (Time{0, 7}));
  RollbackLog log;
  log.begin({1, 0});
  for (const Needle i : {Needle(2), Needle(0)}) {
    log.replaced(i, gas);
    ++gas.records[i].serial;
    gas.records[i].time = {2, 0};
    times[i] = {3, static_cast<double>(i.index)};
    letters[i] = 'b';
  }
  times[Needle(1)] = {4, 0};  // not in the log
  log.put_back(gas);
  for (const Needle i : {Needle(0), Needle(2)}) {
    EXPECT_EQ(times[i], (Time{0, 7}));
    EXPECT_EQ(letters[i], 'a');
  }
  EXPECT_EQ(times[Needle(1)], (Time{4, 0}));
}

}  // namespace
}  // namespace needlework
