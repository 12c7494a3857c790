// What a phase that is rolled back puts back.
#include "src/engine/rollback_log.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace needlework {
namespace {

TEST(RollbackLogs, PutRecordsBackWhoseNumbersHaveWrappedAround) {
  Gas gas;
  gas.records.resize(2);
  gas.ids.resize(2);
  gas.images.resize(2);
  gas.records[0].serial = ~std::uint32_t{0};
  gas.records[0].flight.r.x = 1;
  RollbackLog log;
  log.begin({});
  log.replaced(Needle(0), gas.records[0], gas.images[0], nullptr);
  gas.records[0].serial += 1;
  gas.records[0].flight.r.x = 2;
  std::vector<Time> none;
  log.put_back(gas, none);
  EXPECT_EQ(gas.records[0].serial, ~std::uint32_t{0});
  EXPECT_EQ(gas.records[0].flight.r.x, 1);
}

// Records that the phase has made need not be put back.
TEST(RollbackLogs, HoldOnlyRecordsFromBeforeThePhase) {
  Gas gas;
  gas.records.resize(2);
  gas.ids.resize(2);
  gas.images.resize(2);
  const auto time = [](double offset) { return Time{0, offset}; };
  for (Needle i{0}; i < 2; ++i) gas.records[i].time = time(1);
  RollbackLog log;
  log.begin(time(2));
  const auto replace = [&](Needle i, double when) {
    Record& record = gas.records[i];
    log.replaced(i, record, gas.images[i], nullptr);
    ++record.serial;
    record.time = time(when);
    log.scheduled(i, record);
  };
  // Several at the instant at which the phase began, and some of them later.
  for (const double when : {2.0, 2.0, 3.0, 4.0, 5.0}) replace(Needle(0), when);
  log.scheduled(Needle(1), gas.records[1]);
  EXPECT_EQ(log.entries(), 3u);
  EXPECT_EQ(std::count(log.scheduled().begin(), log.scheduled().end(), Needle(1)), 1);
  std::vector<Time> none;
  log.put_back(gas, none);
  EXPECT_EQ(gas.records[0].serial, 0u);
  EXPECT_EQ(gas.records[0].time, time(1));
  EXPECT_NE(std::find(log.scheduled().begin(), log.scheduled().end(), Needle(0)),
            log.scheduled().end());
  log.begin(time(5));
  EXPECT_EQ(log.entries(), 0u);
  EXPECT_TRUE(log.scheduled().empty());
}

}  // namespace
}  // namespace needlework
