// Contacts of needles that slide on each other in C.
#include "tests/c/c_simulation.h"

namespace needlework {
namespace {

using test::CSimulation;

TEST(CContacts, AreCounted) {
  const CSimulation gas(
      "needles = { count = 60, box = 4 }\ncollisions = { epsilon = 0, sliding = true }\n");
  gas.run_to(300);
  needlework_contacts contacts{};
  EXPECT_EQ(needlework_get_contacts(gas, &contacts), NEEDLEWORK_OK) << gas.error.message;
  EXPECT_GT(contacts.entered, 20u);
  EXPECT_GT(contacts.ended_by_tip, 0u);
  EXPECT_LE(contacts.ended_by_force + contacts.ended_by_tip + contacts.ended_by_strike,
            contacts.entered);
  EXPECT_GT(contacts.time, 0);
  needlework_totals totals{};
  EXPECT_EQ(needlework_get_totals(gas, &totals), NEEDLEWORK_OK);
  EXPECT_EQ(contacts.share, 2 * contacts.time / (60 * totals.time));
  EXPECT_EQ(needlework_get_contacts(gas, nullptr), NEEDLEWORK_USAGE);
}

TEST(CContacts, AreNoneWithoutSliding) {
  const CSimulation gas("needles = { count = 60, box = 4 }\n");
  gas.run_to(10);
  needlework_contacts contacts{};
  contacts.entered = 7;
  EXPECT_EQ(needlework_get_contacts(gas, &contacts), NEEDLEWORK_OK);
  EXPECT_EQ(contacts.entered, 0u);
}

}  // namespace
}  // namespace needlework
