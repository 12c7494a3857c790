#include "src/cli/audit_state.h"

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "needlework/error.h"
#include "src/cli/json.h"
#include "src/runs/durable_file.h"

namespace needlework::cli {
namespace {

using Json = nlohmann::ordered_json;

// 64-bit keys are text: readers of JSON may hold numbers as doubles.
Json checkpoint_json(const audit::Checkpoint& checkpoint) {
  const audit::Findings& findings = checkpoint.findings;
  Json continuations = Json::array();
  for (const auto& [pair, continuation] : checkpoint.continuations) {
    continuations.push_back({{"pair", std::to_string(pair)},
                             {"r", continuation.r.components},
                             {"kind", static_cast<int>(continuation.start.kind)},
                             {"side", continuation.start.side}});
    if (continuation.start.gap) {
      continuations.back()["gap"] = {*continuation.start.gap, continuation.start.gap_error};
    }
  }
  Json listed = Json::array();
  for (const audit::Difference& difference : findings.listed) {
    listed.push_back({static_cast<int>(difference.kind), difference.time, difference.first,
                      difference.second, static_cast<int>(difference.at_wall)});
  }
  Json overlaps = nullptr;
  if (findings.overlaps) overlaps = {findings.overlaps->at_collisions, findings.overlaps->at_most};
  return {{"fingerprint", std::to_string(checkpoint.fingerprint)},
          {"collisions", findings.collisions},
          {"hits", findings.hits},
          {"draws", findings.draws},
          {"kicks", findings.kicks},
          {"coolings", findings.coolings},
          {"entered", findings.entered},
          {"ended", findings.ended},
          {"at_walls", findings.at_walls},
          {"contacts", findings.contacts},
          {"checked", findings.checked},
          {"escalated", findings.escalated},
          {"undecided", findings.undecided},
          {"overlaps", overlaps},
          {"differences", findings.differences},
          {"listed", listed},
          {"touches", continuations}};
}

audit::Checkpoint checkpoint_of(const Json& from) {
  audit::Checkpoint out;
  out.fingerprint = std::stoull(from.at("fingerprint").get<std::string>());
  audit::Findings& findings = out.findings;
  for (const char* key : {"collisions", "hits", "draws", "kicks", "coolings", "entered", "ended",
                          "at_walls", "contacts", "checked", "escalated", "undecided"}) {
    if (!from.at(key).is_number_unsigned()) throw std::out_of_range(key);
  }
  from.at("collisions").get_to(findings.collisions);
  from.at("hits").get_to(findings.hits);
  from.at("draws").get_to(findings.draws);
  from.at("kicks").get_to(findings.kicks);
  from.at("coolings").get_to(findings.coolings);
  from.at("entered").get_to(findings.entered);
  from.at("ended").get_to(findings.ended);
  from.at("at_walls").get_to(findings.at_walls);
  from.at("contacts").get_to(findings.contacts);
  from.at("checked").get_to(findings.checked);
  from.at("escalated").get_to(findings.escalated);
  from.at("undecided").get_to(findings.undecided);
  if (const Json& overlaps = from.at("overlaps"); !overlaps.is_null()) {
    findings.overlaps = {overlaps.at(0).get<double>(), overlaps.at(1).get<double>()};
  }
  from.at("differences").get_to(findings.differences);
  for (const Json& row : from.at("listed")) {
    findings.listed.push_back({static_cast<audit::Kind>(row.at(0).get<int>()),
                               row.at(1).get<double>(), row.at(2).get<std::uint32_t>(),
                               row.at(3).get<std::uint32_t>(), row.at(4).get<int>() != 0});
  }
  for (const Json& row : from.at("touches")) {
    audit::Continuation continuation;
    row.at("r").get_to(continuation.r.components);
    continuation.start.kind = static_cast<audit::Start::Kind>(row.at("kind").get<int>());
    row.at("side").get_to(continuation.start.side);
    if (row.contains("gap")) {
      continuation.start.gap = row.at("gap").at(0).get<double>();
      row.at("gap").at(1).get_to(continuation.start.gap_error);
    }
    out.continuations[std::stoull(row.at("pair").get<std::string>())] = continuation;
  }
  return out;
}

}  // namespace

void write_audit_state(const std::string& path, const AuditIdentity& identity,
                       const audit::Checkpoint& checkpoint) {
  runs::replace_durably(
      path, json_text(Json{{"audit", identity}, {"state", checkpoint_json(checkpoint)}}) + '\n');
}

std::optional<audit::Checkpoint> read_audit_state(const std::string& path,
                                                  const AuditIdentity& identity) {
  if (!std::filesystem::exists(path)) return std::nullopt;
  if (!std::filesystem::is_regular_file(path)) throw IoError(path + ": not a regular file");
  std::ifstream file(path);
  if (!file) throw IoError(path + ": cannot be read");
  try {
    const Json content = parse_json(file);
    if (content.at("audit").get<std::string>() != identity) {
      throw InputError(path +
                       ": the state of another audit: expected the same scene, engine and share");
    }
    return checkpoint_of(content.at("state"));
  } catch (const Json::exception&) {
  } catch (const std::logic_error&) {  // of numbers
  }
  throw InputError(path + ": expected the state of an interrupted audit");
}

}  // namespace needlework::cli
