// Where a run may write.
#pragma once

#include <string>

namespace needlework::cli {

/// Throws IoError, with the reason, if `file` could not be made there, or exists already and
/// `force` is false. Makes nothing. Asked before a run, so that no computing is wasted on a result
/// that cannot be kept.
void require_writable(const std::string& file, bool force);

}  // namespace needlework::cli
