// The file in which an interrupted audit keeps what it needs to continue.
#pragma once

#include <optional>
#include <string>

#include "src/audit/audit.h"

namespace needlework::cli {

/// Says which audit a state belongs to; any other text is another audit.
using AuditIdentity = std::string;

/// Replaces the file at once or not at all. Throws IoError.
void write_audit_state(const std::string& path, const AuditIdentity& identity,
                       const audit::Checkpoint& checkpoint);

/// None if there is no such file. Throws InputError for one that is not of this audit.
std::optional<audit::Checkpoint> read_audit_state(const std::string& path,
                                                  const AuditIdentity& identity);

}  // namespace needlework::cli
