// An interrupted audit continues from what it has saved.
#include "src/cli/audit_state.h"

#include <gtest/gtest.h>

#include <tuple>

#include "needlework/error.h"
#include "tests/support/temporary_folder.h"

namespace needlework::cli {
namespace {

audit::Checkpoint some_checkpoint() {
  audit::Checkpoint out;
  out.fingerprint = 0xfedcba9876543210;
  out.findings.collisions = 5;
  out.findings.contacts = 4;
  out.findings.checked = 300;
  out.findings.escalated = 2;
  out.findings.undecided = 1;
  out.findings.coolings = 6;
  for (std::size_t n = 0; n < out.findings.differences.size(); ++n) out.findings.differences[n] = n;
  out.findings.listed = {{audit::Kind::late, 0.1, 3, 4},
                         {audit::Kind::missed, 1e-300, 0, 4000000000}};
  using audit::Start;
  out.continuations[0xffffffff00000001] = {{{0.1, -1.0 / 3, 5e-324}}, {Start::collided, -1, {}, 0}};
  out.continuations[2] = {{{0, 1e-17, 1}}, {Start::touching, 1, -1e-31 / 3, 1e-31 / 3}};
  out.continuations[3] = {{{1, 2, 3}}, {Start::apart, 0, 0.0, 0}};
  return out;
}

TEST(AuditState, IsReadAsItWasWritten) {
  const test::TemporaryFolder folder;
  const std::string path = (folder.path() / "audit.state").string();
  const audit::Checkpoint saved = some_checkpoint();
  write_audit_state(path, "one", saved);
  const auto read = read_audit_state(path, "one");
  ASSERT_TRUE(read);
  EXPECT_EQ(read->fingerprint, saved.fingerprint);
  EXPECT_EQ(read->findings.collisions, saved.findings.collisions);
  EXPECT_EQ(read->findings.contacts, saved.findings.contacts);
  EXPECT_EQ(read->findings.checked, saved.findings.checked);
  EXPECT_EQ(read->findings.escalated, saved.findings.escalated);
  EXPECT_EQ(read->findings.undecided, saved.findings.undecided);
  EXPECT_EQ(read->findings.coolings, saved.findings.coolings);
  EXPECT_EQ(read->findings.differences, saved.findings.differences);
  ASSERT_EQ(read->findings.listed.size(), saved.findings.listed.size());
  for (std::size_t n = 0; n < saved.findings.listed.size(); ++n) {
    const audit::Difference &a = read->findings.listed[n], &b = saved.findings.listed[n];
    EXPECT_EQ(std::tuple(a.kind, a.time, a.first, a.second),
              std::tuple(b.kind, b.time, b.first, b.second));
  }
  ASSERT_EQ(read->continuations.size(), saved.continuations.size());
  for (const auto& [pair, continuation] : saved.continuations) {
    ASSERT_TRUE(read->continuations.contains(pair)) << pair;
    const audit::Continuation& other = read->continuations.at(pair);
    EXPECT_EQ(other.r.components, continuation.r.components);
    EXPECT_EQ(other.start.kind, continuation.start.kind);
    EXPECT_EQ(other.start.side, continuation.start.side);
    EXPECT_EQ(other.start.gap, continuation.start.gap);
    EXPECT_EQ(other.start.gap_error, continuation.start.gap_error);
  }
}

TEST(AuditState, IsThatOfOneAuditOnly) {
  const test::TemporaryFolder folder;
  const std::string path = (folder.path() / "audit.state").string();
  EXPECT_FALSE(read_audit_state(path, "one"));
  write_audit_state(path, "one", some_checkpoint());
  EXPECT_THROW(read_audit_state(path, "other"), InputError);
}

}  // namespace
}  // namespace needlework::cli
